"""The rows of the table: a question about a set of pairs, and how much of the best peer's time ours may take."""

from dataclasses import dataclass
from fnmatch import fnmatch

MODES = ("sep", "near", "over")


@dataclass(frozen=True)
class Row:
    kind: str
    mode: str
    operation: str
    pair_set: str
    #: Greatest ratio of our time to the best peer's; None: shown only.
    target: float | None
    #: Tracks are measured against our own time without a cache, not against a peer.
    against_own_cold: bool = False

    @property
    def name(self):
        return " ".join(part for part in (self.kind, self.operation, self.mode) if part)


#: Kind of pair, its sets, and the target of each operation.
KINDS = (
    ("hull8", "seed_box8", {"distance": 0.6, "collide": None, "penetration": 0.6}),
    ("hull250", "seed_ell250", {"distance": 0.5, "collide": 0.5, "penetration": 0.5}),
    ("hull940", "seed_ell940", {"distance": 0.5, "collide": 0.5, "penetration": 0.5}),
    ("box-box", "prim_boxbox", {"distance": 0.6, "collide": 1.25, "penetration": None}),
    ("capsule-capsule", "prim_capcap", {"distance": 1.25, "collide": 1.25, "penetration": 1.25}),
    ("sphere-hull", "prim_sphmesh", {"distance": 0.6, "collide": 0.6, "penetration": 0.6}),
    ("cylinder-cone", "prim_cylcone", {"distance": 0.6, "collide": 0.6, "penetration": 0.6}),
    ("ellipsoids", "prim_ellell", {"distance": 0.6, "collide": 0.6, "penetration": 0.6}),
    ("mesh5k", "mesh5k", {"distance": 0.7, "collide": 0.7}),
    ("mesh20k", "mesh20k", {"distance": 0.7, "collide": 0.7}),
)

TRACKS = (("warm-hull8", "warm_box8"), ("warm-hull250", "warm_ell250"), ("warm-hull940", "warm_ell940"))
WARM_TARGET = 0.4


def all_rows():
    for kind, sets, targets in KINDS:
        for operation, target in targets.items():
            for mode in MODES:
                # The depth of what is apart is its distance: asked of hulls, where EPA's set-up could show.
                if operation == "penetration" and mode != "over" and not kind.startswith("hull"):
                    continue
                yield Row(kind, mode, operation, f"{sets}_{mode}", target)
    for kind, pair_set in TRACKS:
        yield Row(kind, "", "distance", pair_set, WARM_TARGET, against_own_cold=True)
        # What is apart is told so by one direction, with a cache and without.
        yield Row(kind, "", "collide", pair_set, None, against_own_cold=True)


def rows_named(patterns):
    """Those whose name (or kind) matches one of the shell patterns; all of them without patterns."""
    wanted = [row for row in all_rows() if not patterns or any(fnmatch(row.name, p) or row.kind == p for p in patterns)]
    if not wanted:
        names = ", ".join(row.name for row in all_rows())
        raise SystemExit(f"no row is named {' or '.join(patterns)}; the names: {names}")
    return wanted
