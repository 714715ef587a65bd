"""Medians of times that come in steps, and ratios of interleaved rounds with an interval that takes any noise."""

from math import comb

import numpy as np


def grouped_median(values, step):
    """The median of values that a clock has rounded to steps: those of the middle step count as spread evenly over it.

    Without this a query of 80 ns could only be seen as 80 or 90 where the time stamp moves by 10 ns.
    """
    middle = np.median(values)
    low = middle - step / 2
    below, inside = np.sum(values < low), np.sum(np.abs(values - middle) <= step / 2)
    return float(low + step * (len(values) / 2 - below) / inside) if inside else float(middle)


def ratio_of_rounds(ours, theirs, step):
    """(median, low, high) over the rounds of: our median over the pairs / theirs in the same round."""
    rounds = zip(ours, theirs, strict=True)
    ratios = np.sort([grouped_median(a, step) / grouped_median(b, step) for a, b in rounds])
    low, high = order_statistics(len(ratios))
    return float(np.median(ratios)), float(ratios[low]), float(ratios[high])


def order_statistics(count, confidence=0.95):
    """Indices of the narrowest pair of symmetric order statistics between which the median lies at that confidence.

    Each of `count` values is above the median with probability 1/2, so the number of those below it is binomial.
    With too few values the interval is all of them.
    """
    best = 0
    for low in range(1, (count + 1) // 2):
        outside = 2 * sum(comb(count, k) for k in range(low + 1)) / 2**count
        if 1 - outside >= confidence:
            best = low
    return best, count - 1 - best
