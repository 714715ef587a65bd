"""Times one row: every contender and configuration that can be the fastest makes its passes in turn, round after round.

A trial comes first, whose answers are judged, and which sends away what is far from the fastest. Then the rounds: in
each, every entry makes one pass, in an order that rotates, so that a machine that slows down slows all of them.
"""

from dataclasses import dataclass, field

import numpy as np
from accuracy import brackets_that_miss, errors, no_worse, percentile99
from contenders import OURS, PEERS
from measuring.figures import grouped_median, ratio_of_rounds

#: Pairs of the first look, which spares us minutes where a contender takes a second a pair.
FEW = 4
#: What takes this much longer than the fastest there, and more than this many nanoseconds, is judged and shown by the first
#: pairs alone: those, or, where a pair takes less than so many nanoseconds, some more, in a few passes.
HOPELESS, BEARABLE = 30, 200_000
SOME, SOME_PASSES, PATIENCE = 50, 3, 50_000_000
#: A configuration that takes this much longer than the fastest peer in the trial is not timed further.
SLOW = 1.3
TRIAL_PASSES = 2


@dataclass
class Entry:
    """A contender with a configuration, on one row."""

    contender: object
    config: str
    #: Metres, of each pair with a reference; a boolean's is 1 when it is wrong; infinite without an answer.
    error: np.ndarray
    #: Median ticks of the trial.
    trial: float
    hopeless: bool
    #: Ticks, a row a round and a column a pair.
    ticks: list = field(default_factory=list)

    @property
    def is_peer(self):
        return self.contender.name in PEERS

    @property
    def is_ours(self):
        return self.contender.name == OURS

    @property
    def is_absolute(self):
        """Of ours: whether its tolerance is a length."""
        return self.config.split("/")[0].endswith("m")

    @property
    def tolerance(self):
        """Of ours: relative, or metres."""
        return float(self.config.split("/")[0].removesuffix("m"))

    @property
    def error99(self):
        return percentile99(self.error)

    @property
    def wrong(self):
        """Of booleans: answers that are wrong or missing."""
        return int(np.sum(self.error > 0.5))

    @property
    def unanswered(self):
        return int(np.sum(~np.isfinite(self.error)))

    def median(self):
        """Nanoseconds: the median over the rounds of that over the pairs, which resolves what the clock rounds."""
        rounds = [grouped_median(ticks, self.contender.step) for ticks in self.ticks]
        return float(np.median(rounds)) / self.contender.ticks_per_nanosecond

    def percentile99(self):
        """Nanoseconds: over the pairs, each with its median over the rounds, so that an interruption is no tail."""
        return float(percentile99(np.median(self.ticks, axis=0))) / self.contender.ticks_per_nanosecond


def fastest_first(entries):
    return sorted(entries, key=lambda entry: entry.trial)


def fastest_of_each(entries):
    """The fastest configuration of every contender."""
    return list({entry.contender.name: entry for entry in reversed(fastest_first(entries))}.values())


@dataclass
class Result:
    row: object
    entries: list
    #: Peers that gave a wrong boolean, with the number of wrong answers.
    disqualified: list
    peer: Entry | None
    ours: Entry | None
    #: (configuration, indices of pairs) whose bracket does not hold the reference.
    missed_brackets: list

    def shown(self):
        """What the table is about: the best peer, ours, and the fastest configuration of every contender."""
        return unique([self.peer, self.ours, *fastest_of_each(self.entries)])

    def ratio(self):
        """Ratio of the medians over pairs: its median over the rounds, and an interval."""
        theirs = self.peer.ticks
        if self.ours.hopeless:
            theirs = [np.median(theirs, axis=0)[: len(self.ours.ticks[0])]]
        return ratio_of_rounds(self.ours.ticks, theirs, self.ours.contender.step)

    def ratio99(self):
        return self.ours.percentile99() / self.peer.percentile99()


def race(row, pair_set, contenders, count, rounds):
    count = min(count, pair_set.count)
    entries, missed = trial(row, pair_set, contenders, count)
    if row.against_own_cold:
        return race_warm(row, entries, missed, pair_set, count, rounds)
    boolean = row.operation == "collide"
    disqualified = [entry for entry in entries if entry.is_peer and boolean and entry.wrong]
    field_ = [entry for entry in entries if not entry.is_ours and entry not in disqualified]
    peers = fastest_first([entry for entry in field_ if entry.is_peer])
    if not peers:
        return Result(row, [], disqualified, None, None, missed)
    close = [entry for entry in peers if entry.trial <= SLOW * peers[0].trial]
    # The fastest of every contender is shown, however slow.
    rivals = close + [entry for entry in fastest_of_each(field_) if entry not in close]
    own = fastest_first([entry for entry in entries if entry.is_ours])
    candidates = [matching(own, peer) for peer in close]
    run_rounds(row, pair_set, rivals + unique(candidates), count, rounds)
    peer = min(close, key=Entry.median)
    return Result(row, rivals + unique(candidates), disqualified, peer, matching(own, peer), missed)


def race_warm(row, entries, missed, pair_set, count, rounds):
    """Tracks: ours from a cache against ours without, at the default tolerance; the peers' are shown."""
    shown = [entry for entry in entries if not entry.is_ours]
    own = {entry.config.split("/")[1]: entry for entry in entries if entry.is_ours}
    cold, warm = own["cold"], own["warm"]
    timed = [*shown, cold, warm]
    run_rounds(row, pair_set, timed, count, rounds)
    return Result(row, timed, [], cold, warm, missed)


def trial(row, pair_set, contenders, count):
    """Every configuration of every contender, judged; and the brackets of ours that miss the reference."""
    asked = [(c, config) for c in contenders.values() for config in c.configs(pair_set.name, row.operation)]
    few = min(FEW, count)
    look = {(c, config): c.ask(pair_set.name, row.operation, config, few) for c, config in asked}
    fastest = min(np.median(seen.ticks) for seen in look.values())
    limit = max(HOPELESS * fastest, BEARABLE * next(iter(contenders.values())).ticks_per_nanosecond)
    entries, missed = [], []
    for contender, config in asked:
        seen = look[contender, config]
        hopeless = np.median(seen.ticks) > limit
        time = np.median(seen.ticks)
        seen_passes = [seen.ticks]
        if hopeless and time < PATIENCE * contender.ticks_per_nanosecond:
            some = min(SOME, count)
            passes = [contender.ask(pair_set.name, row.operation, config, some) for _ in range(SOME_PASSES)]
            seen, seen_passes = passes[0], [one.ticks for one in passes]
        elif not hopeless:
            passes = [contender.ask(pair_set.name, row.operation, config, count) for _ in range(TRIAL_PASSES)]
            seen, time = passes[0], min(np.median(one.ticks) for one in passes)
        misses = brackets_that_miss(seen.lower, seen.upper, pair_set) if contender.name == OURS else ()
        if len(misses):
            missed.append((config, misses))
        error = errors(seen.answers, pair_set, row.operation)
        entries.append(Entry(contender, config, error, time, hopeless, seen_passes if hopeless else []))
    return entries, missed


def matching(own, peer):
    """Ours at the loosest tolerance that is no less exact than the peer, the relative or the absolute one, whichever is
    faster in the trial; at the tightest relative one where none is."""
    tightest = min((entry for entry in own if not entry.is_absolute), key=lambda entry: entry.tolerance)
    found = []
    for is_absolute in (False, True):
        loosest_first = sorted(
            (entry for entry in own if entry.is_absolute == is_absolute), key=lambda entry: -entry.tolerance
        )
        found += [entry for entry in loosest_first if no_worse(entry.error99, peer.error99)][:1]
    return min(found, key=lambda entry: entry.trial, default=tightest)


def unique(entries):
    return list({id(entry): entry for entry in entries}.values())


def run_rounds(row, pair_set, entries, count, rounds):
    racing = [entry for entry in entries if not entry.hopeless]
    for turn in range(rounds):
        first = turn % len(racing)
        for entry in racing[first:] + racing[:first]:
            seen = entry.contender.ask(pair_set.name, row.operation, entry.config, count)
            entry.ticks.append(seen.ticks)
