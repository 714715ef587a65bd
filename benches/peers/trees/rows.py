"""The rows of the table: what is done with the trees, and against which peers ours is held."""

from dataclasses import dataclass
from fnmatch import fnmatch

from contenders import DOUBLE, OBVHS, PEERS, SINGLE


@dataclass(frozen=True)
class Race:
    """What all contenders are told to do, round after round."""

    operation: str
    #: Of moves: the share of the boxes.
    percent: int = 0


@dataclass(frozen=True)
class Rival:
    """Peers the fastest of which a row is held against."""

    title: str
    names: tuple[str, ...]
    #: Greatest ratio of our time to theirs; None: shown only.
    target: float | None
    #: Configurations that do less than the row says, and do not count.
    without: tuple[str, ...] = ()

    def holds(self, entry):
        return entry.contender.name in self.names and entry.config not in self.without


@dataclass(frozen=True)
class Row:
    name: str
    race: Race
    #: Our configuration.
    ours: str
    rivals: tuple[Rival, ...]


#: obvhs without repair; and Coal's `sap`, which has kept the pairs while boxes moved, and only lists them.
NO_REPAIR, LIST_OF_PAIRS = ("refit",), ("sap",)
#: Coal's sweep and prune: the slowest by far where boxes are many.
SWEEPS = ("sap", "ssap")
BOTH_PRECISIONS = (Rival("best f64", DOUBLE, 1.0), Rival("best f32", SINGLE, 1.3))

ROWS = (
    Row("build", Race("build"), "in_place", (Rival("best", PEERS, 1.3),)),
    Row("1 % moved, published", Race("moves", 1), "published", (Rival("best that repairs", PEERS, 1.0, NO_REPAIR),)),
    Row("1 % moved, in place", Race("moves", 1), "in_place", (Rival("obvhs, no repair", (OBVHS,), None, ("move",)),)),
    Row("10 % moved, published", Race("moves", 10), "published", (Rival("best that repairs", PEERS, None, NO_REPAIR),)),
    Row("100 % moved, in place", Race("moves", 100), "in_place", (Rival("best", PEERS, 1.5),)),
    Row("100 % moved, published", Race("moves", 100), "published", (Rival("best", PEERS, None),)),
    Row("self-pairs after moves", Race("pairs"), "published", (Rival("best", PEERS, 0.9, LIST_OF_PAIRS),)),
    Row("box query", Race("query"), "published", BOTH_PRECISIONS),
    Row("first-hit ray", Race("ray"), "published", BOTH_PRECISIONS),
    Row("one edit published", Race("publish"), "published", (Rival("whole copy", PEERS, None),)),
)


def rows_named(patterns):
    """Those whose name begins so or matches the shell pattern; all of them without patterns."""
    wanted = [row for row in ROWS if not patterns or any(fnmatch(row.name, f"{pattern}*") for pattern in patterns)]
    if not wanted:
        names = ", ".join(f"'{row.name}'" for row in ROWS)
        raise SystemExit(f"no row is named {' or '.join(patterns)}; the names: {names}")
    return wanted
