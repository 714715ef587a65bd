"""Times our dynamic tree beside Coal, parry, obvhs and rstar on the same boxes in one run, and prints the table.

Rows: build, moves of 1, 10 and 100 % (ours published and in place), self-pairs, box queries, first-hit rays, one edit
published; each with 1e3, 1e4, 1e5 and 1e6 boxes. See README.md.
"""

import argparse
import shlex
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import report
from boxes import QUESTIONS
from contenders import start_all
from race import run
from rows import SWEEPS, rows_named
from sizes import SIZES

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "target/peers/comparison"
RESULTS = ROOT / "benches/results"


@dataclass
class Settings:
    rounds: int | None
    questions: int
    #: Configurations that take no part.
    without: tuple[str, ...]
    start: float

    def report(self, size, race, entries):
        elapsed = time.monotonic() - self.start
        print(f"{elapsed:4.0f} s  {report.progress(size, race, entries)}", file=sys.stderr, flush=True)


def arguments():
    parser = argparse.ArgumentParser(
        prog="benches/peers/compare trees",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("rows", nargs="*", help="beginnings or patterns of rows, such as build or '100 %% moved'")
    quick = "up to 1e5 boxes, 5 rounds, 500 questions, no sweep and prune: a minute"
    parser.add_argument("--quick", action="store_true", help=quick)
    parser.add_argument("--sizes", help="such as 1e3,1e5 (all four)")
    parser.add_argument("--rounds", type=int, help="at most so many rounds in which all make a pass in turn (21 to 7)")
    parser.add_argument("--cpu", type=int, default=1, help="the core that all contenders are pinned to (1)")
    parser.add_argument("--save", action="store_true", help="write the table to benches/results/trees.md and .csv")
    return parser.parse_args()


def sizes_named(chosen):
    if not chosen.sizes:
        return SIZES[:3] if chosen.quick else SIZES
    found = {size.label: size for size in SIZES}
    wanted = chosen.sizes.split(",")
    if unknown := set(wanted) - set(found):
        sys.exit(f"no such size: {', '.join(sorted(unknown))}; the sizes: {', '.join(found)}")
    return [size for label, size in found.items() if label in wanted]


def main():
    chosen = arguments()
    rows, sizes = rows_named(chosen.rows), sizes_named(chosen)
    quick = chosen.quick
    rounds, questions = chosen.rounds or (5 if quick else None), 500 if quick else QUESTIONS
    settings = Settings(rounds, questions, SWEEPS if quick else (), time.monotonic())
    contenders = start_all(FOLDER, chosen.cpu)
    results = [run(size, FOLDER / size.file, contenders, rows, settings) for size in sizes]
    for contender in contenders:
        contender.close()
    text = report.markdown(results, rows, shlex.join(["benches/peers/compare", "trees", *sys.argv[1:]]))
    print(text)
    if chosen.save:
        RESULTS.mkdir(exist_ok=True)
        (RESULTS / "trees.md").write_text(text)
        report.write_csv(RESULTS / "trees.csv", results, rows)
    if any(result.is_wrong for result in results):
        sys.exit("an answer of ours is wrong")


main()
