"""How many boxes, and how often what is done with them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Size:
    count: int
    #: Rounds in which all make a pass in turn; the file has frames for no more.
    rounds: int
    #: Frames of a pass, by the share of the boxes that move, percent.
    frames: dict[int, int]
    #: How often a pass builds a tree, or finds all pairs.
    repeats: int
    #: Edits that a pass publishes one by one.
    edits: int

    @property
    def file(self):
        return f"trees_{self.count}.bin"

    @property
    def label(self):
        return f"1e{len(str(self.count)) - 1}"


SIZES = (
    Size(1_000, 21, {1: 16, 10: 2, 100: 1}, 8, 64),
    Size(10_000, 21, {1: 8, 10: 1, 100: 1}, 2, 64),
    Size(100_000, 15, {1: 2, 10: 1, 100: 1}, 1, 16),
    Size(1_000_000, 7, {1: 1, 10: 1, 100: 1}, 1, 4),
)
