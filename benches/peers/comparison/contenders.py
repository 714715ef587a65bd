"""The programs under comparison: each stays alive, pinned to one core, and makes a pass over a set when told to."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from measuring.program import Program


@dataclass(frozen=True)
class Pass:
    """What came of one visit to each pair: four arrays, one entry a pair."""

    ticks: np.ndarray
    answers: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


class Contender(Program):
    def __init__(self, name, command, cpu, setting=""):
        super().__init__(name, command, cpu)
        #: A word added to every configuration.
        self.setting = setting

    @cache
    def configs(self, pair_set, operation):
        """The ways in which it can be asked this; none when it cannot."""
        self.send(f"configs {pair_set} {operation}")
        return [config + self.setting for config in self.line().split()]

    def ask(self, pair_set, operation, config, count):
        self.send(f"pass {pair_set} {operation} {config} {count}")
        data = self.read(32 * count, f"{pair_set} {operation} {config}")
        return Pass(*np.frombuffer(data).reshape(count, 4).T)


OURS, COAL, PARRY, PARRY_SINGLE = "ours", "Coal", "parry f64", "parry f32"
FCL, PROXQP = "FCL", "ProxQP"

#: The peers that a target refers to; single precision is shown only.
PEERS = (COAL, PARRY, FCL, PROXQP)


def start_all(folder, cpu, solver=None):
    """All of them; `solver` is for ours."""
    pairs = folder / "pairs.bin"
    parry = folder / "rust/parry/parry"
    commands = {
        COAL: [folder / "coal", pairs],
        PARRY: [parry, "f64", pairs],
        PARRY_SINGLE: [parry, "f32", pairs],
        FCL: [folder / "fcl", pairs],
        PROXQP: [folder / "proxqp", pairs],
        OURS: [folder / "rust/release/ours", pairs],
    }
    settings = {OURS: f"/{solver}"} if solver else {}
    return {name: Contender(name, command, cpu, settings.get(name, "")) for name, command in commands.items()}
