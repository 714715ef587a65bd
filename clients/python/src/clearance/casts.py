"""Rays, moving shapes, regions and neighbours: what is asked and what is answered. Metres, world frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .answers import Cost, PairAnswer, Verdict
from .edits import BodyName, body_ref
from .poses import Vector, vec3
from .v1 import cast_pb2 as messages
from .v1 import geometry_pb2 as geometry
from .v1 import query_pb2 as query


class CastVerdict(IntEnum):
    """What was proved of a ray or a motion."""

    CLEAR = messages.CAST_VERDICT_CLEAR
    HIT = messages.CAST_VERDICT_HIT
    INDETERMINATE = messages.CAST_VERDICT_INDETERMINATE
    NOT_RUN = messages.CAST_VERDICT_NOT_RUN
    INVALID_INPUT = messages.CAST_VERDICT_INVALID_INPUT


#: What moves, or a part of the world: a body by name or id, or a shape.
Moved = Union[BodyName, geometry.Shape]


def moving(
    moved: Moved,
    *,
    start: Optional[geometry.Pose] = None,
    to: Optional[geometry.Pose] = None,
    displacement: Optional[Vector] = None,
    turn: Optional[Vector] = None,
) -> messages.Mover:
    """A body or shape on its way over the time 0 to 1, from `start` (by default a body from where it is, a shape from the world's frame).

    Either `to` a pose, the shorter way around; or by a `displacement` in metres and a `turn`, a vector along the axis as long as the angle in
    radians. With none of them it stays.
    """
    if to is not None and (displacement is not None or turn is not None):
        raise ValueError("to: cannot be given together with displacement or turn")
    mover = messages.Mover(start=start)
    if isinstance(moved, geometry.Shape):
        mover.shape.CopyFrom(moved)
    else:
        mover.body.CopyFrom(body_ref(moved))
    if to is not None:
        mover.to.CopyFrom(to)
    elif displacement is None and turn is None:
        mover.still.SetInParent()
    else:
        mover.by.SetInParent()
        if displacement is not None:
            mover.by.displacement.CopyFrom(vec3("displacement", displacement))
        if turn is not None:
            mover.by.turn.CopyFrom(vec3("turn", turn))
    return mover


def box_region(low: Vector, high: Vector) -> messages.Region:
    """A box along the axes of the world, between two corners."""
    return messages.Region(box=geometry.Aabb(min=vec3("low", low), max=vec3("high", high)))


def ball_region(center: Vector, radius: float) -> messages.Region:
    """A ball."""
    return messages.Region(ball=messages.RegionBall(center=vec3("center", center), radius=radius))


def shape_region(shape: geometry.Shape, pose: Optional[geometry.Pose] = None) -> messages.Region:
    """Any shape at a pose."""
    return messages.Region(shape=query.PlacedShape(shape=shape, pose=pose))


def cast_mode(mode: str) -> messages.CastMode:
    known = {"first": messages.CAST_MODE_FIRST, "all": messages.CAST_MODE_ALL, "any": messages.CAST_MODE_ANY}
    if mode not in known:
        raise ValueError(f"mode: is {mode!r}, known are {', '.join(known)}")
    return known[mode]


def rays_request(
    context: query.Context, origins: ArrayLike, directions: ArrayLike, length: ArrayLike, mode: str
) -> messages.CastRaysRequest:
    def table(name: str, values: ArrayLike) -> NDArray[np.float64]:
        array = np.ascontiguousarray(values, dtype="<f8")
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"{name}: needs shape (n, 3), has {array.shape}")
        return array

    starts, ways = table("origins", origins), table("directions", directions)
    if len(starts) == 1 and len(ways) != 1:
        starts = np.ascontiguousarray(np.broadcast_to(starts, ways.shape))
    lengths = np.ascontiguousarray(np.atleast_1d(length), dtype="<f8")
    return messages.CastRaysRequest(
        context=context,
        origins=geometry.Doubles(little_endian=starts.tobytes()),
        directions=geometry.Doubles(little_endian=ways.tobytes()),
        lengths=geometry.Doubles(little_endian=lengths.tobytes()),
        mode=cast_mode(mode),
    )


@dataclass(frozen=True)
class RaysAnswer:
    """The answers to a batch of rays. Arrays over rays; those of hits hold ray after ray, `hit_counts` of them each."""

    epoch: int
    #: The state of the scene that was asked.
    revision: int
    #: Numbers of `CastVerdict`.
    verdicts: NDArray[np.uint8]
    #: Metres: nothing is met before, proved; the length of a clear ray.
    free_until: NDArray[np.float64]
    #: There were more hits or grazed bodies than the limit lets through.
    truncated: NDArray[np.bool_]
    hit_counts: NDArray[np.uint32]
    #: Of each hit: the body's id, its triangle or part, and between which distances along the ray it is met.
    bodies: NDArray[np.uint64]
    subshapes: NDArray[np.uint32]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    #: A solid holds the origin of the ray.
    at_start: NDArray[np.bool_]
    #: Shape (hits, 3): the best estimate of where it is met, and the unit vector out of the body to where the ray comes from.
    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    #: Bodies that may be met, or passed by a hair: how many a ray, their ids, and between which distances.
    grazed_counts: NDArray[np.uint32]
    grazed_bodies: NDArray[np.uint64]
    grazed_lower: NDArray[np.float64]
    grazed_upper: NDArray[np.float64]
    #: Of rays that are `INVALID_INPUT`: which field, and what is wrong with it.
    problems: dict[int, str]
    #: Time ran out; rays not looked at are `NOT_RUN`.
    out_of_time: bool
    cost: Cost = field(repr=False)

    @property
    def distances(self) -> NDArray[np.float64]:
        """One number a ray: the middle of the bracket of its first hit told, NaN without one."""
        result = np.full(len(self.verdicts), np.nan)
        is_hit = self.hit_counts > 0
        first = (np.cumsum(self.hit_counts) - self.hit_counts)[is_hit]
        result[is_hit] = 0.5 * (self.lower[first] + self.upper[first])
        return result

    @classmethod
    def of(cls, answer: messages.CastRaysResponse) -> RaysAnswer:
        def doubles(data: bytes) -> NDArray[np.float64]:
            return np.frombuffer(data, dtype="<f8")

        hits, grazed = answer.hits, answer.grazed
        return cls(
            epoch=answer.epoch,
            revision=answer.revision,
            verdicts=np.frombuffer(answer.verdicts, dtype=np.uint8),
            free_until=doubles(answer.free_until),
            truncated=np.frombuffer(answer.truncated, dtype=np.uint8) != 0,
            hit_counts=np.frombuffer(answer.hit_counts, dtype="<u4"),
            bodies=np.frombuffer(hits.bodies, dtype="<u8"),
            subshapes=np.frombuffer(hits.subshapes, dtype="<u4"),
            lower=doubles(hits.lower),
            upper=doubles(hits.upper),
            at_start=np.frombuffer(hits.at_start, dtype=np.uint8) != 0,
            points=doubles(hits.points).reshape(-1, 3),
            normals=doubles(hits.normals).reshape(-1, 3),
            grazed_counts=np.frombuffer(answer.grazed_counts, dtype="<u4"),
            grazed_bodies=np.frombuffer(grazed.bodies, dtype="<u8"),
            grazed_lower=doubles(grazed.lower),
            grazed_upper=doubles(grazed.upper),
            problems={each.item: each.problem for each in answer.problems},
            out_of_time=answer.out_of_time,
            cost=Cost.of(answer.cost),
        )


@dataclass(frozen=True)
class CastHit:
    """A body that is met; `lower` and `upper` are parts of the motion."""

    body: int
    subshape: int
    own_subshape: int
    lower: float
    upper: float
    at_start: bool
    point: NDArray[np.float64]
    normal: NDArray[np.float64]


@dataclass(frozen=True)
class Grazed:
    """A body that may be met, or passed by a hair, between two parts of the motion."""

    body: int
    lower: float
    upper: float


@dataclass(frozen=True)
class CastItem:
    """The answer to one motion."""

    verdict: CastVerdict
    #: A part of the motion: nothing is met before, proved; 1 when clear.
    free_until: float
    hits: tuple[CastHit, ...]
    grazed: tuple[Grazed, ...]
    truncated: bool
    #: Of `INVALID_INPUT`: which field, and what is wrong with it.
    problem: str
    cost: Cost

    @classmethod
    def of(cls, item: messages.CastItem) -> CastItem:
        def array(v: geometry.Vec3) -> NDArray[np.float64]:
            return np.array([v.x, v.y, v.z])

        hits = (
            CastHit(
                hit.body,
                hit.subshape,
                hit.own_subshape,
                hit.lower,
                hit.upper,
                hit.at_start,
                array(hit.point),
                array(hit.normal),
            )
            for hit in item.hits
        )
        return cls(
            verdict=CastVerdict(item.verdict),
            free_until=item.free_until,
            hits=tuple(hits),
            grazed=tuple(Grazed(one.body, one.lower, one.upper) for one in item.grazed),
            truncated=item.truncated,
            problem=item.problem,
            cost=Cost.of(item.cost),
        )


@dataclass(frozen=True)
class OverlapItem:
    """The answer to one region: bodies by their ids, each with its verdict (by bounds alone `NOT_RUN`)."""

    verdict: Verdict
    bodies: dict[int, Verdict]
    truncated: bool
    problem: str
    cost: Cost

    @classmethod
    def of(cls, item: messages.OverlapItem) -> OverlapItem:
        return cls(
            verdict=Verdict(item.verdict),
            bodies={body: Verdict(verdict) for body, verdict in zip(item.bodies, item.verdicts)},
            truncated=item.truncated,
            problem=item.problem,
            cost=Cost.of(item.cost),
        )


@dataclass(frozen=True)
class NearestItem:
    """The nearest bodies of one body or shape, in the order of their signed distances; side `a` is what was asked about."""

    verdict: Verdict
    nearest: tuple[PairAnswer, ...]
    #: Every body that is not told is proved to be no nearer than any that is.
    set_is_proved: bool
    #: No two of those told could change places.
    order_is_proved: bool
    problem: str
    cost: Cost

    @classmethod
    def of(cls, item: messages.NearestItem) -> NearestItem:
        return cls(
            verdict=Verdict(item.verdict),
            nearest=tuple(PairAnswer.of(pair) for pair in item.nearest),
            set_is_proved=item.set_is_proved,
            order_is_proved=item.order_is_proved,
            problem=item.problem,
            cost=Cost.of(item.cost),
        )
