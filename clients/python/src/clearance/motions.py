"""Motions of a robot: what is asked of them, and what is proved."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .answers import Cost, Verdict
from .v1 import geometry_pb2 as geometry
from .v1 import motion_pb2 as messages
from .v1 import query_pb2 as query

_Response = Union[messages.CheckMotionsResponse, messages.CheckPathResponse]


@dataclass(frozen=True)
class MotionsAnswer:
    """The answer to a batch of motions, one element a motion. Times are fractions of a motion: 0 at its start, 1 at its goal."""

    epoch: int
    #: The state of the scene that was asked.
    revision: int
    #: Numbers of `Verdict`.
    verdicts: NDArray[np.uint8]
    #: The last valid fraction: every state before this is proved farther than the margins.
    free_until: NDArray[np.float64]
    #: Of collisions, shape (n, 2): all before the first time is proved apart, and the state at the second collides. Of `MARGIN`:
    #: the same for coming within a margin. NaN elsewhere.
    reached: NDArray[np.float64]
    #: Of motions that are `INDETERMINATE`, shape (n, 2): the first stretch that nothing decides. NaN elsewhere.
    undecided: NDArray[np.float64]
    #: How many states each motion was looked at in; NaN where it was not.
    states: NDArray[np.float64]
    #: Of motions that are `INVALID_INPUT`: which field, and what is wrong with it.
    problems: dict[int, str]
    #: With stop at first: the motion that stopped the batch. Of a path: its first blocked motion, from that waypoint on.
    stopped_at: Optional[int]
    #: Time ran out; motions not looked at are `NOT_RUN`.
    out_of_time: bool
    cost: Cost = field(repr=False)

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which motions are proved to be free all along."""
        return self.verdicts == Verdict.FREE

    @classmethod
    def of(cls, response: _Response) -> MotionsAnswer:
        answer, bulk = response.answer, response.bulk

        def numbers(data: bytes) -> NDArray[np.float64]:
            return np.frombuffer(data, dtype="<f8")

        return cls(
            epoch=answer.epoch,
            revision=answer.revision,
            verdicts=np.frombuffer(answer.bulk.verdicts, dtype=np.uint8),
            free_until=numbers(bulk.free_until),
            reached=np.column_stack([numbers(bulk.reached_from), numbers(bulk.reached_to)]),
            undecided=np.column_stack([numbers(bulk.undecided_from), numbers(bulk.undecided_to)]),
            states=numbers(bulk.states),
            problems={each.item: each.problem for each in answer.bulk.problems},
            stopped_at=answer.stopped_at if answer.HasField("stopped_at") else None,
            out_of_time=answer.out_of_time,
            cost=Cost.of(answer.cost),
        )


def along(start: ArrayLike, goal: ArrayLike, time: float) -> NDArray[np.float64]:
    """Joint positions of a motion at a time between 0 and 1, the very numbers that the daemon looks at."""
    first, last = np.asarray(start, dtype=float), np.asarray(goal, dtype=float)
    return last if time == 1.0 else first + time * (last - first)


def doubles(table: ArrayLike, name: str, shape: str, dimensions: int) -> geometry.Doubles:
    """A table of joint positions as a message."""
    numbers = np.ascontiguousarray(table, dtype="<f8")
    if numbers.ndim != dimensions:
        raise ValueError(f"{name}: needs shape {shape}, has {numbers.shape}")
    return geometry.Doubles(little_endian=numbers.tobytes())


def edges(starts: ArrayLike, goals: ArrayLike) -> geometry.Doubles:
    """Starts and goals, one after the other."""
    first, last = np.asarray(starts, dtype=float), np.asarray(goals, dtype=float)
    if first.shape != last.shape or first.ndim != 2:
        raise ValueError(f"starts and goals: need one shape (n, degrees of freedom), have {first.shape} and {last.shape}")
    return doubles(np.stack([first, last], axis=1), "positions", "(n, 2, degrees of freedom)", 3)


def effort(first_contact: bool, resolution: Optional[float], max_states: Optional[int]) -> messages.MotionEffort:
    find = messages.FIND_FIRST_CONTACT if first_contact else messages.FIND_ANY_CONTACT
    return messages.MotionEffort(find=find, resolution=resolution, max_states=max_states)


def mode(stop_at_first: bool) -> query.Mode:
    return query.MODE_STOP_AT_FIRST if stop_at_first else query.MODE_ALL
