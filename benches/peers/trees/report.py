"""The table as markdown and as CSV, and what machine and programs it was made with."""

import csv
import os
from datetime import datetime, timezone
from importlib.metadata import version

from contenders import OURS, OURS_NATIVE, PEERS
from measuring.machine import commit, processor

HEAD = ("row", "peer", "its", "ours", "ratio", "target", "", "ours native", "ratio", *PEERS)


def markdown(results, rows, command):
    lines = [*preamble(results, command)]
    for result in results:
        lines += ["", f"## {result.size.count} boxes, {len_of_rounds(result)} rounds, {result.pairs} pairs", ""]
        lines += ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)]
        lines += ["| " + " | ".join(cells) + " |" for row in rows for cells in row_cells(result, row)]
    if len(results) > 1:
        lines += ["", "## Growth from size to size", "", *growth(results, rows)]
    lines += ["", "## Memory", "", *memory(results), "", "## Answers", "", *answers(results)]
    return "\n".join(lines) + "\n"


def len_of_rounds(result):
    return max(len(entry.ticks) for entries in result.races.values() for entry in entries)


def row_cells(result, row):
    for rival in row.rivals:
        theirs, ours, native = result.rival(row, rival), result.ours(row), result.ours(row, OURS_NATIVE)
        if not ours:
            continue
        name = f"{row.name}, against {rival.title}"
        cells = [name, *[""] * (len(HEAD) - 1)]
        cells[3] = duration(ours.median())
        if theirs:
            cells[1:3] = entry_name(theirs), duration(theirs.median())
            target = "" if rival.target is None else f"{rival.target:g}"
            cells[4:7] = ratio(result, ours, theirs), target, verdict(result.ratio(ours, theirs), rival.target)
        if native:
            cells[7] = duration(native.median())
            cells[8] = ratio(result, native, theirs) if theirs else ""
        for place, peer in enumerate(PEERS, len(HEAD) - len(PEERS)):
            fastest = result.fastest(row, peer, rival.without)
            cells[place] = f"{duration(fastest.median())} {fastest.config}" if fastest else ""
        yield cells


def ratio(result, ours, theirs):
    middle, low, high = result.ratio(ours, theirs)
    return f"{middle:.2f} [{low:.2f}, {high:.2f}]"


def verdict(interval, target):
    if target is None:
        return ""
    middle, low, high = interval
    unclear = " (unclear)" if low <= target < high else ""
    return ("met" if middle <= target else "**missed**") + unclear


def entry_name(entry):
    return f"{entry.name} {entry.config}".removesuffix(" default") + (" (first rounds only)" if entry.left else "")


def duration(nanoseconds):
    for unit, length in (("ns", 1), ("µs", 1e3), ("ms", 1e6), ("s", 1e9)):
        if nanoseconds < 1000 * length or unit == "s":
            break
    value = nanoseconds / length
    return f"{value:.2f} {unit}" if value < 10 else f"{value:.1f} {unit}" if value < 100 else f"{value:.0f} {unit}"


def growth(results, rows):
    """How many times as long it takes with ten times as many boxes: ours, and the best peer of the smaller size's row."""
    steps = list(zip(results, results[1:]))
    titles = [f"{a.size.label} to {b.size.label}: ours, peer" for a, b in steps]
    yield "| " + " | ".join(["row", *titles]) + " |"
    yield "|" + " --- |" * (1 + len(titles))
    for row in rows:
        rival = row.rivals[0]
        cells = [row.name]
        for small, large in steps:
            one, other = small.ours(row), large.ours(row)
            two = [result.rival(row, rival) for result in (small, large)]
            own = f"{other.median() / one.median():.2f}" if one and other else ""
            cells.append(own + (f", {two[1].median() / two[0].median():.2f}" if all(two) else ""))
        yield "| " + " | ".join(cells) + " |"


def memory(results):
    """Bytes a box of what took part in moves: as built, and after all moves."""
    names = sorted({key for result in results for key in result.memory}, key=lambda key: (key[0] != OURS, key))
    sizes = [result.size.label for result in results]
    yield "Bytes a box that the tree holds, as built and after all moves (`published`: with the version readers have)."
    yield "Not in it: boxes a user keeps beside the tree, and Coal's objects; rstar's are, for it removes by box."
    yield ""
    yield "| contender | " + " | ".join(sizes) + " |"
    yield "|" + " --- |" * (1 + len(sizes))
    for key in names:
        if key[0] == OURS_NATIVE:
            continue
        held = [result.memory.get(key) for result in results]
        cells = ["{:.0f}, {:.0f}".format(*pair) if pair else "" for pair in held]
        yield f"| {' '.join(key)} | " + " | ".join(cells) + " |"


def answers(results):
    """What differs from the truth."""
    found = [(result, wrong) for result in results for wrong in result.wrong]
    yield "Every tree is asked for all pairs (number, and a sum over them), the count of every query and the distance of"
    yield "every ray's hit, after the moves; the truth is found with a k-d tree of centres and all candidates by hand."
    own = sum(wrong.contender in (OURS, OURS_NATIVE) for _, wrong in found)
    yield f"Ours differs in {own} of these lists; of the others:" if found else "No answer differs."
    if found:
        yield ""
    for result, wrong in found:
        what = f"{wrong.differ} of {wrong.asked} {wrong.what}"
        yield f"- {result.size.label} {wrong.contender} {wrong.config}: {what}"


def preamble(results, command):
    return [
        "# Our dynamic tree beside other libraries'",
        "",
        f"`{command}` on {datetime.now(timezone.utc):%Y-%m-%d}, commit {commit()},",
        f"{processor()}, one core of {os.cpu_count()} (load average {os.getloadavg()[0]:.1f}).",
        f"Coal {version('coal')} (its wheel, any x86-64), parry 0.31.1, obvhs 0.4.0 and rstar 0.14.0 (target-cpu=native);",
        "ours as shipped (any x86-64, wider instructions chosen at run time), and `native` built as the peers are.",
        "",
        "In each round all make a pass in turn on one core, in an order that rotates. A time is the median over the",
        "rounds; a pass is the whole operation, or the median over its queries or rays. Ratio: ours to the peer's, median",
        "over the rounds, with the 95 % interval of order statistics; *unclear*: the target is in it. `published`: a",
        "reader holds the version before while the next is made, and what it takes to publish and to drop is timed, too;",
        "no peer publishes anything. `refit` of obvhs does not repair its tree. Coal's `sap` lists pairs that it has kept",
        "while boxes moved, and is no best of the self-pairs. obvhs and rstar have no walk of a tree against itself: a",
        "query for each box. *One edit published*: peers copy the whole tree. The last columns are the fastest",
        "configuration of every peer (of those that do what the row says).",
    ]


FIELDS = (
    *("boxes", "row", "contender", "config", "role", "median_ns", "p99_ns", "rounds"),
    *("ratio", "ratio_low", "ratio_high", "target"),
)


def write_csv(path, results, rows):
    """Every contender and configuration of every row, and the ratios of ours."""
    with path.open("w", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(FIELDS)
        for result in results:
            for row in rows:
                for entry in result.races.get(row.race, ()):
                    writer.writerows(csv_lines(result, row, entry))


def csv_lines(result, row, entry):
    questions = row.race.operation in ("query", "ray")
    p99 = f"{entry.percentile99():.1f}" if questions else ""
    start = [result.size.count, row.name, entry.name, entry.config]
    figures = [f"{entry.median():.1f}", p99, len(entry.ticks)]
    if entry.name not in (OURS, OURS_NATIVE) or entry.config != row.ours:
        rivals = [rival.title for rival in row.rivals if result.rival(row, rival) is entry]
        yield [*start, "; ".join(rivals), *figures, "", "", "", ""]
        return
    for rival in row.rivals:
        theirs = result.rival(row, rival)
        ratios = [f"{value:.4f}" for value in result.ratio(entry, theirs)] if theirs else [""] * 3
        target = "" if rival.target is None else rival.target
        yield [*start, f"ours against {rival.title}", *figures, *ratios, target]


def progress(size, race, entries):
    """One line while the rest is still running."""
    what = f"{race.operation} {race.percent} %" if race.percent else race.operation
    fastest = {}
    for entry in sorted(entries, key=lambda entry: entry.median()):
        fastest.setdefault(entry.name, entry)
    times = ", ".join(f"{entry_name(entry)} {duration(entry.median())}" for entry in fastest.values())
    return f"{size.label} {what}: {times}"
