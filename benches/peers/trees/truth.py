"""The right answers, found in another way than any contender's: candidates by their centres, each then looked at."""

import numpy as np
from scipy.spatial import cKDTree


class Truth:
    def __init__(self, data):
        self.low, self.high = data.boxes[:, :3], data.boxes[:, 3:]
        self.centres = 0.5 * (self.low + self.high)
        self.widest = 0.5 * (self.high - self.low).max()
        self.tree = cKDTree(self.centres)
        self.data = data

    def pairs(self):
        """The pairs that overlap: how many, and the sum of a number for each."""
        near = self.tree.query_pairs(2.001 * self.widest, p=np.inf, output_type="ndarray")
        a, b = near[:, 0], near[:, 1]
        meet = np.all((self.low[a] <= self.high[b]) & (self.low[b] <= self.high[a]), axis=1)
        low, high = np.minimum(a, b)[meet].astype(np.uint64), np.maximum(a, b)[meet].astype(np.uint64)
        return len(low), float(np.sum(mixed(low, high), dtype=np.uint64) >> np.uint64(12))

    def queries(self, count):
        """How many boxes overlap each."""
        asked = self.data.queries[:count]
        low, high = asked[:, :3], asked[:, 3:]
        reach = 1.001 * (self.widest + 0.5 * (high - low).max())
        near = self.tree.query_ball_point(0.5 * (low + high), reach, p=np.inf)
        return np.array([self._overlapping(candidates, *ends) for candidates, *ends in zip(near, low, high)], float)

    def _overlapping(self, candidates, low, high):
        return np.all((self.low[candidates] <= high) & (low <= self.high[candidates]), axis=1).sum()

    def rays(self, count):
        """Distance to the first box along each, metres; infinite without one."""
        return np.array([self._first_hit(ray[:3], ray[3:6], ray[6]) for ray in self.data.rays[:count]])

    def _first_hit(self, origin, direction, length, stride=1.0, part=16):
        """Looks at the boxes near a part of the ray after the other, up to the part with a hit."""
        reach = 1.001 * np.sqrt(3) * self.widest + 0.5 * stride
        steps = np.arange(0.5 * stride, length + stride, stride)
        for first in range(0, len(steps), part):
            points = origin + steps[first : first + part, None] * direction
            near = np.unique(np.concatenate(self.tree.query_ball_point(points, reach)).astype(int))
            ahead = self._distances(near, origin, direction, length)
            # What is nearer than this part's end is missed by no later one.
            end = steps[min(first + part, len(steps)) - 1] + 0.5 * stride
            if len(ahead) and ahead.min() <= end:
                return ahead.min()
        return np.inf

    def _distances(self, near, origin, direction, length):
        with np.errstate(divide="ignore"):
            one, other = (self.low[near] - origin) / direction, (self.high[near] - origin) / direction
        enters = np.minimum(one, other).max(axis=1, initial=0.0)
        leaves = np.maximum(one, other).min(axis=1, initial=length)
        return enters[enters <= leaves]


def mixed(low, high):
    """A number for a pair, as the contenders have it: the finaliser of SplitMix64."""
    x = low << np.uint64(32) | high
    x = (x ^ x >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ x >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return x ^ x >> np.uint64(31)
