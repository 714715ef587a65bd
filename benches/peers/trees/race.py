"""Runs one size: in each round every contender and configuration does the same to its own tree, in turn.

The boxes move as the rounds go on, the same way for all. So moves are made even where no row about them was asked for:
what comes after is asked of trees that have lived.
"""

from dataclasses import dataclass, field

import numpy as np
from boxes import Boxes
from contenders import OURS, OURS_NATIVE, SINGLE
from measuring.figures import grouped_median, ratio_of_rounds
from rows import ROWS
from truth import Truth

#: Rounds of moves that no row was asked for.
FEW_ROUNDS = 3
#: A configuration whose pass takes this much longer than the fastest, and so many nanoseconds, leaves after few rounds.
HOPELESS, BEARABLE = 10, 3e8
#: How far the distance of a ray's hit may be from the truth, as a part of its length.
ROUNDING, SINGLE_ROUNDING = 1e-13, 1e-5


@dataclass
class Entry:
    """A contender with a configuration, in one race."""

    contender: object
    config: str
    #: Ticks, a row a round and a column a sample.
    ticks: list = field(default_factory=list)
    #: It left after few rounds.
    left: bool = False

    @property
    def name(self):
        return self.contender.name

    def rounds(self):
        """Nanoseconds of each round: the median over its samples."""
        medians = [grouped_median(ticks, self.contender.step) for ticks in self.ticks]
        return [median / self.contender.ticks_per_nanosecond for median in medians]

    def median(self):
        return float(np.median(self.rounds()))

    def percentile99(self):
        """Of questions: over them, each with its median over the rounds, nanoseconds."""
        samples = np.sort(np.median(self.ticks, axis=0))
        return float(samples[min(len(samples) - 1, int(0.99 * len(samples)))]) / self.contender.ticks_per_nanosecond


@dataclass
class Wrong:
    """An answer that is not the truth, or not quite."""

    contender: str
    config: str
    what: str
    #: Of how many, and how many differ.
    asked: int
    differ: int


@dataclass
class Result:
    size: object
    #: Entries of every race that was run.
    races: dict
    #: Bytes for each box by (contender, configuration): as built, and after the moves.
    memory: dict
    pairs: int
    wrong: list

    def rival(self, row, rival):
        """The fastest entry that a row is held against."""
        entries = [entry for entry in self.races.get(row.race, ()) if rival.holds(entry)]
        return min(entries, key=Entry.median, default=None)

    def ours(self, row, name=OURS):
        entries = self.races.get(row.race, ())
        return next((entry for entry in entries if entry.name == name and entry.config == row.ours), None)

    def fastest(self, row, name, without=()):
        entries = [e for e in self.races.get(row.race, ()) if e.name == name and e.config not in without]
        return min(entries, key=Entry.median, default=None)

    def ratio(self, ours, theirs):
        """(median, low, high) over the rounds of our time to theirs."""
        rounds = min(len(ours.ticks), len(theirs.ticks))
        return ratio_of_rounds(ours.ticks[:rounds], theirs.ticks[:rounds], ours.contender.step)

    @property
    def is_wrong(self):
        """Whether one of ours is: others' answers are shown."""
        return any(wrong.contender in (OURS, OURS_NATIVE) for wrong in self.wrong)


def run(size, path, contenders, rows, settings):
    """All races of one size that the rows are about."""
    for contender in contenders:
        contender.open(path)
    data, races = Boxes(path), {}
    rounds = min(settings.rounds or size.rounds, size.rounds)
    wanted = {row.race for row in rows}
    counts = {"build": size.repeats, "pairs": size.repeats, "publish": size.edits}
    for race in dict.fromkeys(row.race for row in ROWS):
        moves = race.operation == "moves"
        if race in wanted or moves:
            own = rounds if race in wanted else min(rounds, FEW_ROUNDS)
            frames = size.frames[race.percent] if moves else 0
            races[race] = entries = entries_of(race, contenders, settings.without)
            race_rounds(race, entries, own, frames, data, contenders, counts.get(race.operation, settings.questions))
            settings.report(size, race, entries)
    memory = memory_of(races, size.count)
    truth = Truth(data)
    pairs, wrong = check(truth, data, races, settings.questions)
    return Result(size, {race: races[race] for race in races if race in wanted}, memory, pairs, wrong)


def entries_of(race, contenders, without):
    pairs = [(contender, config) for contender in contenders for config in contender.configs(race.operation)]
    return [Entry(contender, config) for contender, config in pairs if config not in without]


def race_rounds(race, entries, rounds, frames, data, contenders, count):
    for turn in range(rounds):
        if frames:
            data.read_frames(race.percent, turn * frames, frames)
            for contender in contenders:
                contender.read_frames(race.percent, turn * frames, frames)
        racing = [entry for entry in entries if not entry.left]
        first = turn % len(racing)
        for entry in racing[first:] + racing[:first]:
            entry.ticks.append(entry.contender.ask(race.operation, entry.config, count).ticks)
        if turn + 1 == FEW_ROUNDS:
            fastest = min(entry.median() for entry in entries)
            for entry in entries:
                entry.left = entry.median() > max(HOPELESS * fastest, BEARABLE)


def memory_of(races, count):
    """Of what took part in moves, bytes a box."""
    moving = [entry for race, entries in races.items() if race.operation == "moves" for entry in entries]
    held = {(entry.name, entry.config): entry.contender.memory(entry.config) for entry in moving}
    return {key: (built / count, now / count) for key, (built, now) in held.items() if built}


def check(truth, data, races, questions):
    """Asks every tree once more, with no clock, and says what differs from the truth."""
    wrong = []

    def note(entry, what, asked, differ):
        if differ:
            wrong.append(Wrong(entry.name, entry.config, what, asked, int(differ)))

    pairs, pair_sum = truth.pairs()
    for race, entries in races.items():
        if race.operation == "pairs":
            for entry in entries:
                found = entry.contender.ask("pairs", entry.config, 1).answers[0]
                same = entry.contender.ask("pair_sum", entry.config).answers[0] == pair_sum
                # Where the number is right and the sum is not, at least one is missing and one too many.
                note(entry, "pairs", pairs, abs(found - pairs) or 2 * (not same))
        elif race.operation == "query":
            counts = truth.queries(questions)
            for entry in entries:
                answers = entry.contender.ask("query", entry.config, questions).answers
                note(entry, "box queries", len(counts), np.sum(answers != counts))
        elif race.operation == "ray":
            distances = truth.rays(questions)
            for entry in entries:
                answers = entry.contender.ask("ray", entry.config, questions).answers
                allowed = (SINGLE_ROUNDING if entry.name in SINGLE else ROUNDING) * data.rays[: len(answers), 6]
                with np.errstate(invalid="ignore"):
                    same = (answers == distances) | (np.abs(answers - distances) <= allowed)
                note(entry, "rays", len(distances), np.sum(~same))
    return pairs, wrong
