"""The boxes, how they move, and what is asked of them: `trees_N.bin`. README.md has the layout.

    python boxes.py FOLDER      writes the file of every size, the same bytes each time
"""

import struct
import sys
from pathlib import Path

import numpy as np
from sizes import SIZES

MAGIC = b"CQTREES1"
QUESTIONS = 2000
#: Standard deviation of a move along an axis, metres.
STEP = 0.05
MOVE = np.dtype([("index", "<u4"), ("by", "<f4", 3)])


def write(path, size):
    """Boxes with sides of 0.5 to 1.5 m, about half an overlap a box; half lengths and centres are uniform."""
    random = np.random.default_rng(size.count)
    side = 2.0 * size.count ** (1 / 3)
    with open(path, "wb") as out:
        out.write(MAGIC + struct.pack("<4I", size.count, QUESTIONS, QUESTIONS, len(size.frames)))
        for percent, frames in size.frames.items():
            out.write(struct.pack("<2I", percent, frames * size.rounds))
        out.write(corners(random, size.count, side, 0.25, 0.75))
        out.write(corners(random, QUESTIONS, side, 0.5, 2.0))
        directions = random.normal(size=(QUESTIONS, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        origins, lengths = random.uniform(0, side, (QUESTIONS, 3)), np.full((QUESTIONS, 1), side)
        out.write(np.hstack([origins, directions, lengths]).tobytes())
        for percent, frames in size.frames.items():
            for _ in range(frames * size.rounds):
                moves = np.empty(size.count * percent // 100, MOVE)
                moves["index"] = np.sort(random.choice(size.count, len(moves), replace=False))
                moves["by"] = random.normal(0, STEP, (len(moves), 3))
                out.write(moves.tobytes())


def corners(random, count, side, least, greatest):
    centres, halves = random.uniform(0, side, (count, 3)), random.uniform(least, greatest, (count, 3))
    return np.hstack([centres - halves, centres + halves]).tobytes()


class Boxes:
    """The boxes as they are after the frames that have been read."""

    def __init__(self, path):
        with open(path, "rb") as data:
            magic, count, queries, rays, streams = struct.unpack("<8s4I", data.read(24))
            assert magic == MAGIC
            heads = [struct.unpack("<2I", data.read(8)) for _ in range(streams)]
            self.boxes = np.fromfile(data, "<f8", 6 * count).reshape(-1, 6)
            self.queries = np.fromfile(data, "<f8", 6 * queries).reshape(-1, 6)
            self.rays = np.fromfile(data, "<f8", 7 * rays).reshape(-1, 7)
            offset = data.tell()
        self.path, self.streams = path, {}
        for percent, frames in heads:
            moves = count * percent // 100
            self.streams[percent] = offset, moves
            offset += frames * moves * MOVE.itemsize

    def read_frames(self, percent, first, count):
        offset, moves = self.streams[percent]
        for frame in range(first, first + count):
            place = offset + frame * moves * MOVE.itemsize
            read = np.fromfile(self.path, MOVE, moves, offset=place)
            self.boxes[read["index"]] += np.tile(read["by"].astype(float), 2)


if __name__ == "__main__":
    for one in SIZES:
        write(Path(sys.argv[1]) / one.file, one)
