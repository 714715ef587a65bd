"""Writes `pairs.bin`, the pairs of shapes that all contenders are asked about, from one seed. README.md has the layout.

    python generate FILE
"""

import struct
import sys

import numpy as np
from placing import MODES, Placer
from shapes import Shapes

SEED = 20240607
PAIRS = 1000
MESH_PAIRS = 100
TRACKS, STEPS = 100, 50


def hull_pools(shapes):
    return {
        "box8": [shapes.box_hull() for _ in range(64)],
        "ell250": [shapes.ellipsoid_hull(250) for _ in range(32)],
        "ell940": [shapes.ellipsoid_hull(940) for _ in range(16)],
    }


def primitive_pools(shapes, hulls):
    """The two sides of each set."""

    def pool(make):
        return [make() for _ in range(32)]

    boxes, capsules, spheres = pool(shapes.box), pool(shapes.capsule), pool(shapes.sphere)
    cylinders, cones, ellipsoids = pool(shapes.cylinder), pool(shapes.cone), pool(shapes.ellipsoid)
    return {
        "boxbox": (boxes, boxes),
        "capcap": (capsules, capsules),
        "sphmesh": (spheres, hulls["ell250"]),
        "cylcone": (cylinders, cones),
        "ellell": (ellipsoids, ellipsoids),
    }


def all_sets(shapes, random):
    """(name, pairs, track length) of every set; the order decides the numbers drawn."""
    placer = Placer(shapes, random)
    hulls = hull_pools(shapes)
    for name, pool in hulls.items():
        for mode in MODES:
            yield f"seed_{name}_{mode}", [placer.pair_of(pool, pool, mode) for _ in range(PAIRS)], 0
    for name, (side_a, side_b) in primitive_pools(shapes, hulls).items():
        for mode in MODES:
            yield f"prim_{name}_{mode}", [placer.pair_of(side_a, side_b, mode) for _ in range(PAIRS)], 0
    for name, pool in hulls.items():
        tracks = [placer.track(pool, STEPS) for _ in range(TRACKS)]
        yield f"warm_{name}", [pair for track in tracks for pair in track], STEPS
    small = [shapes.bumpy_sphere(50, 51, seed) for seed in (1, 2)]
    large = [shapes.bumpy_sphere(100, 101, seed) for seed in (3, 4)]
    for name, (a, b) in {"mesh5k": small, "mesh20k": large}.items():
        for mode in MODES:
            yield f"{name}_{mode}", [placer.meshes(a, b, mode) for _ in range(MESH_PAIRS)], 0


def write(path, shapes, sets):
    with open(path, "wb") as out:
        out.write(b"CQPAIRS1" + struct.pack("<4I", len(shapes), len(sets), sum(len(pairs) for _, pairs, _ in sets), 0))
        for kind, params, vertices, triangles in shapes:
            out.write(struct.pack("<4I4d", kind, len(vertices), len(triangles), 0, *params))
            out.write(vertices.tobytes() + triangles.tobytes())
            out.write(b"\0" * (4 if len(triangles) % 2 else 0))
        first = 0
        for name, pairs, track_length in sets:
            out.write(struct.pack("<48s4I", name.encode(), first, len(pairs), track_length, 0))
            first += len(pairs)
        for _, pairs, _ in sets:
            for pair in pairs:
                out.write(struct.pack("<2I14d", *pair))


def main():
    random = np.random.default_rng(SEED)
    shapes = Shapes(random)
    sets = []
    for name, pairs, track_length in all_sets(shapes, random):
        print(f"{name:24} {len(pairs)} pairs", file=sys.stderr, flush=True)
        sets.append((name, pairs, track_length))
    write(sys.argv[1], shapes.records, sets)


main()
