"""The table as markdown and as CSV, and what machine and programs it was made with."""

import csv
import os
import subprocess
from datetime import datetime, timezone
from importlib.metadata import version

from contenders import OURS, PARRY_SINGLE
from measuring.machine import commit, processor

HEAD = (
    *("row", "best peer", "its µs", "ours at", "our µs", "ratio", "target", ""),
    *("p99: its, our µs", "ratio", "", "p99 error: its, our m", "parry f32, µs"),
)


def markdown(results, settings):
    lines = [*preamble(settings), "", "| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)]
    lines += ["| " + " | ".join(cells(result)) + " |" for result in results]
    return "\n".join([*lines, "", *remarks(results)]) + "\n"


def cells(result):
    row, peer, ours = result.row, result.peer, result.ours
    if not peer or not ours:
        return [row.name, "none" if not peer else entry_name(peer), *[""] * (len(HEAD) - 2)]
    ratio, low, high = result.ratio()
    both99 = f"{microseconds(peer.percentile99())}, {microseconds(ours.percentile99())}"
    errors = "" if row.operation == "collide" else f"{peer.error99:.0e}, {ours.error99:.0e}"
    return [
        row.name,
        entry_name(peer),
        microseconds(peer.median()),
        ours.config.split("/")[0] if row.operation != "collide" else "",
        microseconds(ours.median()),
        f"{ratio:.2f} [{low:.2f}, {high:.2f}]",
        "" if row.target is None else f"{row.target:g}",
        verdict(ratio, low, high, row.target),
        both99,
        f"{result.ratio99():.2f}",
        "" if row.target is None or row.against_own_cold else ("met" if result.ratio99() <= 1 else "missed"),
        errors,
        single_precision(result),
    ]


def single_precision(result):
    return next((microseconds(e.median()) for e in result.entries if e.contender.name == PARRY_SINGLE), "")


def verdict(ratio, low, high, target):
    if target is None:
        return ""
    unclear = " (unclear)" if low <= target < high else ""
    return ("met" if ratio <= target else "**missed**") + unclear


def entry_name(entry):
    name = f"{entry.contender.name} {entry.config}".removesuffix(" default")
    return f"{name} (first pairs only)" if entry.hopeless else name


def microseconds(nanoseconds):
    value = nanoseconds / 1000
    return f"{value:.3f}" if value < 1 else f"{value:.2f}" if value < 100 else f"{value:.0f}"


def preamble(settings):
    return [
        "# Our narrow phase beside Coal, parry, FCL and ProxQP",
        "",
        f"`{settings.command}` on {datetime.now(timezone.utc):%Y-%m-%d}, commit {commit()},",
        f"{processor()}, one core of {os.cpu_count()} (load average {os.getloadavg()[0]:.1f}),",
        f"{settings.rounds} rounds, {settings.count} pairs a set (meshes: {settings.count // 10}).",
        f"Coal {version('coal')} (its wheel, any x86-64), parry 0.31.1 (target-cpu=native), ours for any x86-64 with",
        f"wider instructions chosen at run time. FCL {fcl_version()} (Debian's library and its caller, any x86-64), ProxQP",
        f"{version('proxsuite')} (its dense solver, target-cpu=native, vectorised).",
        "",
        "Cold: each pair once a pass. Times are the median over the pairs, and the 99th percentile of their medians over",
        "the rounds. Ratio: ours to the best peer's, median over the rounds of the ratio of medians, with the 95 %",
        "interval of order statistics; *unclear*: the target is in it. Best peer: the fastest",
        "configuration in f64 (of booleans, one without a wrong answer). Ours runs at the loosest tolerance whose",
        "99th percentile of the error, metres, is no worse than that peer's. Tracks (`warm`): ours from its cache",
        "against ours without.",
    ]


def fcl_version():
    command = ["pkg-config", "--modversion", "fcl"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def remarks(results):
    """What the table has no column for."""
    lines = []
    met = [r for r in results if r.peer and r.ours and r.row.target is not None]
    if met:
        good = sum(r.ratio()[0] <= r.row.target for r in met)
        tails = [r for r in met if not r.row.against_own_cold]
        good99 = sum(r.ratio99() <= 1 for r in tails)
        lines.append(f"{good} of {len(met)} targets met; p99 no worse in {good99} of {len(tails)} rows.")
    missed = sum(len(pairs) for r in results for _, pairs in r.missed_brackets)
    lines.append(f"Brackets that do not hold the reference: {missed}.")
    for result in results:
        lines += [f"- {result.row.name} {config}: pairs {list(pairs[:5])}" for config, pairs in result.missed_brackets]
    wrong = [f"{r.row.name}: {', '.join(settings_of(r.disqualified))}" for r in results if r.disqualified]
    if wrong:
        lines += ["", "Configurations with wrong booleans (how many), which cannot be the best:"]
        lines += [f"- {line}" for line in wrong]
    return lines


def settings_of(entries):
    """Each library with variant and tolerance once, however it was called, and its wrong answers."""
    return list({f"{e.contender.name} {'/'.join(e.config.split('/')[:2])} ({e.wrong})": None for e in entries})


FIELDS = (
    *("row", "target", "contender", "config", "role", "median_ns", "p99_ns"),
    *("ratio", "ratio_low", "ratio_high", "ratio_p99", "error_p99", "error_max", "unanswered"),
)


def write_csv(path, results):
    """The best peer, ours, and the fastest configuration of every contender, a line each."""
    with path.open("w", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(FIELDS)
        for result in results:
            for entry in result.shown() if result.ours else []:
                writer.writerow(csv_line(result, entry))


def csv_line(result, entry):
    row = result.row
    role = "best peer" if entry is result.peer else "ours" if entry is result.ours else ""
    ratios = [f"{r:.4f}" for r in (*result.ratio(), result.ratio99())] if role == "ours" else [""] * 4
    known = len(entry.error) > 0
    return [
        row.name,
        "" if row.target is None else row.target,
        entry.contender.name,
        entry.config,
        role,
        f"{entry.median():.1f}",
        f"{entry.percentile99():.1f}",
        *ratios,
        f"{entry.error99:.2e}" if known else "",
        f"{entry.error.max():.2e}" if known else "",
        entry.unanswered,
    ]


def progress(result):
    """One line while the rest is still running."""
    if not result.peer or not result.ours:
        return f"{result.row.name}: not comparable"
    ratio, low, high = result.ratio()
    peer, ours = result.peer, result.ours
    wanted = result.row.target
    target = "" if wanted is None else f" target {wanted:g} {verdict(ratio, low, high, wanted)}"
    return (
        f"{result.row.name:32} {ratio:6.2f} [{low:.2f}, {high:.2f}]{target}   p99 {result.ratio99():.2f}   "
        f"{OURS} {ours.config} {microseconds(ours.median())} µs, {entry_name(peer)} {microseconds(peer.median())} µs"
    )
