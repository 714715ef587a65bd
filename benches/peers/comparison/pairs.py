"""The sets of pairs, by name, with their reference distances."""

import struct
from dataclasses import dataclass

import numpy as np

HEADER, SHAPE, SET = struct.Struct("<8s4I"), struct.Struct("<4I4d"), struct.Struct("<48s4I")


@dataclass(frozen=True)
class PairSet:
    name: str
    count: int
    #: Signed distances, metres; NaN where there is none.
    reference: np.ndarray
    #: How far from the reference the truth may be, metres.
    gap: np.ndarray

    @property
    def is_mesh(self):
        return self.name.startswith("mesh")


def read_sets(folder):
    data = (folder / "pairs.bin").read_bytes()
    distances, gaps = np.fromfile(folder / "distances.f64"), np.fromfile(folder / "gaps.f64")
    _, shapes, sets, _, _ = HEADER.unpack_from(data)
    offset = HEADER.size
    for _ in range(shapes):
        _, vertices, triangles, *_ = SHAPE.unpack_from(data, offset)
        offset += SHAPE.size + 24 * vertices + 12 * triangles + 4 * (triangles % 2)
    found = {}
    for _ in range(sets):
        name, first, count, _, _ = SET.unpack_from(data, offset)
        offset += SET.size
        name = name.rstrip(b"\0").decode()
        own = slice(first, first + count)
        # The reference is rounded to a double.
        gap = gaps[own] + np.spacing(np.abs(distances[own]))
        found[name] = PairSet(name, count, distances[own], gap)
    return found
