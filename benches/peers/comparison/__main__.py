"""Times our narrow phase beside Coal, parry, FCL and ProxQP on the same pairs in one run, and prints the table. See README.md."""

import argparse
import shlex
import sys
from dataclasses import dataclass
from pathlib import Path

import report
from contenders import start_all
from pairs import read_sets
from race import race
from rows import rows_named

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "target/peers/comparison"
RESULTS = ROOT / "benches/results"


@dataclass
class Settings:
    command: str
    count: int
    rounds: int


def arguments():
    parser = argparse.ArgumentParser(prog="benches/peers/compare", description=__doc__)
    parser.add_argument("rows", nargs="*", help="names or patterns of rows, such as hull250 or 'hull* distance near'")
    parser.add_argument("--quick", action="store_true", help="200 pairs and 5 rounds: for use while developing")
    parser.add_argument("--rounds", type=int, help="rounds in which all make a pass in turn (11)")
    parser.add_argument("--count", type=int, help="pairs of each set (1000), of meshes a tenth")
    parser.add_argument("--cpu", type=int, default=1, help="the core that all contenders are pinned to (1)")
    parser.add_argument("--solver", help="of ours: a solver of the ladder by its name, in place of the default")
    parser.add_argument("--save", action="store_true", help="write the table to benches/results/peers.md and .csv")
    return parser.parse_args()


def main():
    chosen = arguments()
    command = shlex.join(["benches/peers/compare", *sys.argv[1:]])
    count = chosen.count or (200 if chosen.quick else 1000)
    settings = Settings(command, count, chosen.rounds or (5 if chosen.quick else 11))
    rows, sets = rows_named(chosen.rows), read_sets(FOLDER)
    contenders = start_all(FOLDER, chosen.cpu, chosen.solver)
    results = []
    for row in rows:
        pair_set = sets[row.pair_set]
        count = settings.count // 10 if pair_set.is_mesh else settings.count
        result = race(row, pair_set, contenders, count, settings.rounds)
        print(report.progress(result), file=sys.stderr, flush=True)
        results.append(result)
    for contender in contenders.values():
        contender.close()
    text = report.markdown(results, settings)
    print(text)
    if chosen.save:
        RESULTS.mkdir(exist_ok=True)
        (RESULTS / "peers.md").write_text(text)
        report.write_csv(RESULTS / "peers.csv", results)
    if any(result.missed_brackets for result in results):
        sys.exit("a bracket does not hold the reference")


main()
