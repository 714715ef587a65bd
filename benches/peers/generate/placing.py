"""Puts pairs of shapes at a wanted distance of each other. A placed pair: (a, b, pose of a, pose of b).

A pose is a quaternion x y z w and a translation. `Mode` says how far apart: "sep" 0.5 to 2 m, "near" 1 to 10 mm, "over"
1 to 20 cm deep.
"""

import coal
import numpy as np

MODES = ("sep", "near", "over")


def unit(random, size=3):
    vector = random.normal(size=size)
    return vector / np.linalg.norm(vector)


def rotation(quaternion):
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def times(p, q):
    """The rotation `q`, then `p`."""
    (px, py, pz, pw), (qx, qy, qz, qw) = p, q
    return np.array(
        [
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
            pw * qw - px * qx - py * qy - pz * qz,
        ]
    )


def gap(random, mode):
    """The signed distance to aim at. All are drawn, so that the mode does not change what is drawn later."""
    gaps = {"sep": random.uniform(0.5, 2.0), "near": 10 ** random.uniform(-3, -2), "over": -random.uniform(0.01, 0.2)}
    return gaps[mode]


def mesh_gap(random, mode):
    """How far apart the support planes of two meshes are to be. Behind them the surfaces need not touch."""
    gaps = {"sep": random.uniform(0.5, 2), "near": random.uniform(0.001, 0.01), "over": -random.uniform(0.1, 0.5)}
    return gaps[mode]


class Placer:
    def __init__(self, shapes, random):
        self.shapes, self.random = shapes, random
        self.request = coal.DistanceRequest()
        self.request.enable_signed_distance = True

    def pair_of(self, pool_a, pool_b, mode):
        a = pool_a[self.random.integers(len(pool_a))]
        b = pool_b[self.random.integers(len(pool_b))]
        return self.place(a, b, mode)

    def place(self, a, b, mode):
        """Slides b away along a random direction until the signed distance is about what the mode wants."""
        random = self.random
        turn_a, turn_b, along = unit(random, 4), unit(random, 4), unit(random)
        at_a = random.uniform(-1, 1, 3)
        target = gap(random, mode)

        def distance(slide):
            frame_a = coal.Transform3s(rotation(turn_a), at_a)
            frame_b = coal.Transform3s(rotation(turn_b), at_a + slide * along)
            a_in_coal, b_in_coal = self.shapes.in_coal[a], self.shapes.in_coal[b]
            return coal.distance(a_in_coal, frame_a, b_in_coal, frame_b, self.request, coal.DistanceResult())

        low, high = 0.0, 6.0
        for _ in range(22):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if distance(middle) < target else (low, middle)
            if high - low < 1e-4 * max(abs(target), 1e-2):
                break
        slide = low if mode == "over" and high <= 1e-3 else high
        if mode == "near" and distance(slide) <= 0:
            slide = high + target
        return (a, b, *turn_a, *at_a, *turn_b, *(at_a + slide * along))

    def track(self, pool, steps):
        """A pair 0.1 m farther apart than near, whose b turns by 0.6 degrees and moves by 5 mm a step."""
        random = self.random
        start = self.pair_of(pool, pool, "near")
        at_a, turn, at = np.array(start[6:9]), np.array(start[9:13]), np.array(start[13:16])
        away = at - at_a
        at = at + 0.1 * away / np.linalg.norm(away)
        axis, velocity = unit(random), unit(random) * 0.005
        step = np.array([*(axis * np.sin(0.005)), np.cos(0.005)])
        pairs = []
        for _ in range(steps):
            pairs.append((*start[:9], *turn, *at))
            turn = times(step, turn)
            turn /= np.linalg.norm(turn)
            at = at + velocity
        return pairs

    def meshes(self, a, b, mode):
        """b beyond a's support plane along a random direction."""
        random = self.random
        turn_a, turn_b, along = unit(random, 4), unit(random, 4), unit(random)
        vertices_a, vertices_b = self.shapes.records[a][2], self.shapes.records[b][2]
        slide = (vertices_a @ rotation(turn_a).T @ along).max() + (vertices_b @ rotation(turn_b).T @ -along).max()
        slide += mesh_gap(random, mode)
        return (a, b, *turn_a, 0, 0, 0, *turn_b, *(slide * along))
