"""What would a question cost? Prices of its outputs and tolerances, as measured on the daemon's machine just now."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Iterator, Optional, Sequence

from numpy.typing import ArrayLike

from .answers import Verdict
from .errors import translated
from .overlays import WhatIf
from .v1 import estimate_pb2 as messages
from .v1 import motion_pb2 as motion
from .v1 import query_pb2 as query

if TYPE_CHECKING:
    from .client import Scene, Subject


class EstimateEnd(IntEnum):
    """Why an estimate ended."""

    #: Every row has the whole sample.
    COMPLETE = messages.ESTIMATE_END_COMPLETE
    #: The estimate's own time, or the daemon's cap on it, was over first.
    TIME = messages.ESTIMATE_END_TIME
    #: The deadline of the call came first.
    DEADLINE = messages.ESTIMATE_END_DEADLINE


@dataclass(frozen=True)
class Price:
    """What items cost for one output at one tolerance, on one thread."""

    #: `verdict`, `pairs`, `distance`, `witness`, `depth`, `patch` or `derivatives`.
    output: str
    #: How wide a bracket might be, metres; 0: as narrow as rounding lets it be. None where it changes nothing.
    tolerance: Optional[float]
    #: How many items were measured.
    items: int
    #: They are the whole sample.
    complete: bool
    #: Seconds that an item took, in the median and for 99 of 100; None: there was no item that can be asked.
    median: Optional[float]
    p99: Optional[float]
    #: Widths of the brackets, metres, in the median and of the widest; None: there was no bracket to be narrowed.
    median_width: Optional[float]
    largest_width: Optional[float]
    #: Items whose bracket is wider than the tolerance, because rounding or the cap on iterations ended the work first.
    wider: int
    #: How many items came to what; those that were undecided under `INDETERMINATE`, whatever the reason.
    verdicts: dict[Verdict, int] = field(repr=False)
    #: Counters of an item, on the mean: names and meanings of `Cost`.
    mean_cost: dict[str, float] = field(repr=False)

    @classmethod
    def of(cls, row: messages.Price) -> Price:
        times, widths = row.HasField("times"), row.HasField("widths")
        counts = row.verdicts
        undecided = counts.rounding + counts.iteration_limit + counts.time_limit + counts.resolution
        return cls(
            output=messages.Output.Name(row.output).removeprefix("OUTPUT_").lower(),
            tolerance=row.tolerance if row.HasField("tolerance") else None,
            items=row.items,
            complete=row.complete,
            median=1e-9 * row.times.median if times else None,
            p99=1e-9 * row.times.p99 if times else None,
            median_width=row.widths.median if widths else None,
            largest_width=row.widths.largest if widths else None,
            wider=row.widths.wider,
            verdicts={
                Verdict.FREE: counts.free,
                Verdict.MARGIN: counts.margin,
                Verdict.COLLISION: counts.collision,
                Verdict.INDETERMINATE: undecided,
                Verdict.NOT_RUN: counts.not_run,
                Verdict.INVALID_INPUT: counts.invalid_input,
            },
            mean_cost={each.name: getattr(row.mean_cost, each.name) for each in row.mean_cost.DESCRIPTOR.fields}
            if row.HasField("mean_cost")
            else {},
        )


@dataclass(frozen=True)
class Estimate:
    """The price list of a question; iterating it gives its rows."""

    epoch: int
    #: The state of the scene that was asked.
    revision: int
    #: Items of the question, and how many of them were the sample.
    items: int
    sample: int
    #: How often the whole sample was measured.
    turns: int
    #: Items asked in all: what the caller is charged for.
    asked: int
    #: Wall time, seconds.
    seconds: float
    end: EstimateEnd
    #: In the order of the outputs, then of the tolerances.
    prices: tuple[Price, ...] = field(repr=False)

    def __iter__(self) -> Iterator[Price]:
        return iter(self.prices)

    @classmethod
    def of(cls, response: messages.EstimateResponse) -> Estimate:
        return cls(
            epoch=response.epoch,
            revision=response.revision,
            items=response.items,
            sample=response.sample,
            turns=response.turns,
            asked=response.asked,
            seconds=response.seconds,
            end=EstimateEnd(response.end),
            prices=tuple(Price.of(row) for row in response.rows),
        )


class Estimator:
    """Has the questions of a :class:`Scene` that can be priced. Made by :meth:`Scene.estimate`."""

    def __init__(
        self,
        scene: Scene,
        tolerances: Sequence[float],
        outputs: Sequence[str],
        sample: Optional[int],
        time: Optional[float],
        timeout: Optional[float],
    ):
        numbers = [_output(name) for name in outputs]
        self._options = {"tolerances": tolerances, "outputs": numbers, "sample": sample, "time": time}
        self._scene = scene
        self._timeout = timeout

    def check_states(
        self,
        robot: str,
        positions: ArrayLike,
        *,
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.check_states`."""
        context = self._scene._context("verdict", margin, cut_off, solver, at_least, what_if)
        asked = self._scene._states_request(context, robot, positions, stop_at_first=False)
        return self._ask(messages.EstimateRequest(check_states=asked, **self._options))

    def check_motions(
        self,
        robot: str,
        starts: ArrayLike,
        goals: ArrayLike,
        *,
        first_contact: bool = True,
        max_states: Optional[int] = None,
        margin: float = 0.0,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.check_motions`; the tolerances are resolutions."""
        context = self._scene._context("verdict", margin, None, "default", at_least, what_if)
        asked = self._scene._motions_request(context, robot, starts, goals, first_contact, None, max_states)
        return self._ask(messages.EstimateRequest(check_motions=asked, **self._options))

    def check_path(
        self,
        robot: str,
        waypoints: ArrayLike,
        *,
        first_contact: bool = True,
        max_states: Optional[int] = None,
        margin: float = 0.0,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.check_path`; the tolerances are resolutions."""
        context = self._scene._context("verdict", margin, None, "default", at_least, what_if)
        asked = self._scene._path_request(context, robot, waypoints, first_contact, None, max_states)
        return self._ask(messages.EstimateRequest(check_path=asked, **self._options))

    def distance(
        self,
        *subjects: Subject,
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.distance`."""
        context = self._scene._context("verdict", margin, cut_off, solver, at_least, what_if)
        asked = query.DistanceRequest(context=context, items=self._scene._subjects(subjects))
        return self._ask(messages.EstimateRequest(distance=asked, **self._options))

    def collide(
        self,
        *subjects: Subject,
        margin: float = 0.0,
        solver: str = "default",
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.collide`."""
        context = self._scene._context("verdict", margin, None, solver, at_least, what_if)
        asked = query.CollideRequest(context=context, items=self._scene._subjects(subjects))
        return self._ask(messages.EstimateRequest(collide=asked, **self._options))

    def clearance(
        self,
        within: float,
        *subjects: Subject,
        margin: float = 0.0,
        max_pairs: Optional[int] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
    ) -> Estimate:
        """Of :meth:`Scene.clearance`."""
        asked: motion.ClearanceRequest = self._scene._clearance_request(
            within, "distance", margin, max_pairs, at_least, what_if
        )
        asked.items.items.extend(self._scene._subjects(subjects))
        return self._ask(messages.EstimateRequest(clearance=asked, **self._options))

    def _ask(self, request: messages.EstimateRequest) -> Estimate:
        client = self._scene._client
        with translated():
            return Estimate.of(client._queries.Estimate(request, timeout=self._timeout or client._timeout))


def _output(name: str) -> messages.Output:
    """`depth` is OUTPUT_DEPTH."""
    known = {key.removeprefix("OUTPUT_").lower(): number for key, number in messages.Output.items() if number}
    if name not in known:
        raise ValueError(f"outputs: {name!r} is not known, known are {', '.join(known)}")
    return known[name]
