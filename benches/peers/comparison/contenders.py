"""The programs under comparison: each stays alive, pinned to one core, and makes a pass over a set when told to."""

import subprocess
from dataclasses import dataclass
from functools import cache

import numpy as np


@dataclass(frozen=True)
class Pass:
    """What came of one visit to each pair: four arrays, one entry a pair."""

    ticks: np.ndarray
    answers: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


class Contender:
    def __init__(self, name, command, cpu, setting=""):
        self.name = name
        #: A word added to every configuration.
        self.setting = setting
        words = ["taskset", "-c", str(cpu), *map(str, command)]
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        ready, ticks_per_nanosecond, step = self._line().split()
        assert ready == "ready"
        self.ticks_per_nanosecond, self.step = float(ticks_per_nanosecond), float(step)

    @cache
    def configs(self, pair_set, operation):
        """The ways in which it can be asked this; none when it cannot."""
        self._send(f"configs {pair_set} {operation}")
        return [config + self.setting for config in self._line().split()]

    def ask(self, pair_set, operation, config, count):
        self._send(f"pass {pair_set} {operation} {config} {count}")
        wanted = 32 * count
        data = self.process.stdout.read(wanted)
        if len(data) != wanted:
            raise SystemExit(f"{self.name} died at: {pair_set} {operation} {config}")
        return Pass(*np.frombuffer(data).reshape(count, 4).T)

    def _send(self, line):
        self.process.stdin.write(line.encode() + b"\n")
        self.process.stdin.flush()

    def _line(self):
        return self.process.stdout.readline().decode()

    def close(self):
        self.process.stdin.close()
        self.process.wait()


OURS, COAL, PARRY, PARRY_SINGLE = "ours", "Coal", "parry f64", "parry f32"

#: The peers that a target refers to; single precision is shown only.
PEERS = (COAL, PARRY)


def start_all(folder, cpu, solver=None):
    """All of them; `solver` is for ours."""
    pairs = folder / "pairs.bin"
    parry = folder / "rust/parry/parry"
    commands = {
        COAL: [folder / "coal", pairs],
        PARRY: [parry, "f64", pairs],
        PARRY_SINGLE: [parry, "f32", pairs],
        OURS: [folder / "rust/release/ours", pairs],
    }
    settings = {OURS: f"/{solver}"} if solver else {}
    return {name: Contender(name, command, cpu, settings.get(name, "")) for name, command in commands.items()}
