"""The programs under comparison: each keeps its trees, and changes and asks them when told to."""

from dataclasses import dataclass

import numpy as np
from measuring.program import Program

COAL, PARRY, PARRY_SINGLE, OBVHS, RSTAR = "Coal", "parry f64", "parry f32", "obvhs f32", "rstar"
OURS, OURS_NATIVE = "ours", "ours native"

PEERS = (COAL, PARRY, PARRY_SINGLE, OBVHS, RSTAR)
DOUBLE, SINGLE = (COAL, PARRY, RSTAR), (PARRY_SINGLE, OBVHS)


@dataclass(frozen=True)
class Samples:
    ticks: np.ndarray
    answers: np.ndarray


class Contender(Program):
    def open(self, path):
        self.send(f"open {path}")
        self.line()

    def configs(self, operation):
        """The ways in which it can do this with as many boxes as there are; none when it cannot."""
        self.send(f"configs {operation}")
        return self.line().split()

    def read_frames(self, percent, first, count):
        self.send(f"frames {percent} {first} {count}")
        self.line()

    def ask(self, operation, config, count=0):
        command = f"pass {operation} {config} {count}"
        self.send(command)
        head = self.line().split()
        if not head:
            raise SystemExit(f"{self.name} died at: {command}")
        count = int(head[1])
        return Samples(*np.frombuffer(self.read(16 * count, command)).reshape(count, 2).T)

    def memory(self, config):
        """Bytes of the tree that this configuration keeps: as it was built, and now."""
        self.send(f"memory {config}")
        built, now = self.line().split()
        return int(built), int(now)


def start_all(folder, cpu):
    parry, others = folder / "rust/parry/parry_trees", folder / "rust/parry/other_trees"
    commands = {
        COAL: [folder / "coal_trees"],
        PARRY: [parry, "f64"],
        PARRY_SINGLE: [parry, "f32"],
        OBVHS: [others, "obvhs"],
        RSTAR: [others, "rstar"],
        OURS: [folder / "rust/release/ours_trees"],
        OURS_NATIVE: [folder / "native/parry/ours_trees"],
    }
    return [Contender(name, command, cpu) for name, command in commands.items()]
