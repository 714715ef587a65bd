"""How far answers are from the reference, and whether brackets hold it."""

import numpy as np

#: Errors below this are equal, metres: a few units in the last place of distances near 1, as the reference is rounded.
EQUAL = 1e-15


def percentile99(values):
    return np.sort(values)[min(len(values) - 1, int(0.99 * len(values)))]


def truth_of(pair_set, count, operation):
    """What is expected as an answer, and which pairs have a reference."""
    reference = pair_set.reference[:count]
    known = ~np.isnan(reference)
    if operation == "collide":
        return (reference <= 0).astype(float), known
    return (np.maximum(reference, 0) if operation == "distance" else reference), known


def errors(answers, pair_set, operation):
    """|answer - reference| in metres of each pair with a reference; infinite where there is no answer."""
    truth, known = truth_of(pair_set, len(answers), operation)
    # A negative "distance" of an overlap means no more than that it is one; -1.8e308 is how Coal says that EPA failed.
    failed = ~np.isfinite(answers) | (np.abs(answers) > 1e300)
    given = np.maximum(answers, 0) if operation == "distance" else answers
    with np.errstate(over="ignore", invalid="ignore"):
        error = np.where(failed, np.inf, np.abs(given - truth))
    return error[known]


def no_worse(error, than):
    return error <= max(than, EQUAL)


def brackets_that_miss(lower, upper, pair_set):
    """Indices of pairs whose bracket does not hold the reference, within its own gap."""
    reference, gap = pair_set.reference[: len(lower)], pair_set.gap[: len(lower)]
    least, greatest = reference - gap, reference + gap
    if pair_set.is_mesh:
        # Surfaces that touch have reference 0, which is an upper bound of the signed distance.
        least = np.where(reference == 0, -np.inf, least)
    misses = ~np.isnan(reference) & ~((lower <= greatest) & (upper >= least))
    return np.flatnonzero(misses)
