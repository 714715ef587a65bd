"""Answers as plain objects and numpy arrays. Metres, world frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Optional

import numpy as np
from numpy.typing import NDArray

from .pair_derivatives import PairDerivatives
from .v1 import geometry_pb2 as geometry
from .v1 import query_pb2 as messages
from .v1 import scene_pb2 as scene
from .v1 import service_pb2 as service


class Verdict(IntEnum):
    """What a bracket decides."""

    FREE = messages.VERDICT_FREE
    MARGIN = messages.VERDICT_MARGIN
    COLLISION = messages.VERDICT_COLLISION
    INDETERMINATE = messages.VERDICT_INDETERMINATE
    NOT_RUN = messages.VERDICT_NOT_RUN
    INVALID_INPUT = messages.VERDICT_INVALID_INPUT


@dataclass(frozen=True)
class Applied:
    """What became of some edits."""

    epoch: int
    #: The revision that contains them.
    revision: int
    #: Ids of the bodies that were added, in the order of their edits.
    added: tuple[int, ...]


@dataclass(frozen=True)
class MeshCard:
    """What the convex pieces of a mesh cost. Metres."""

    pieces: int
    #: Of memory.
    bytes: int
    build_seconds: float
    #: How far a point of a piece may be from the mesh, and from what it encloses if it is `closed`.
    inflation: Bracket
    #: How far a point of the mesh's surface may be from all pieces.
    loss: Bracket
    #: Whether the mesh is closed and faces outwards; if not, the inside of pieces counts as inflation.
    closed: bool

    @classmethod
    def of(cls, card: service.MeshCard) -> MeshCard:
        inflation = Bracket(card.inflation.lower, card.inflation.upper)
        loss = Bracket(card.loss.lower, card.loss.upper)
        return cls(card.pieces, card.bytes, card.build_seconds, inflation, loss, card.closed)


@dataclass(frozen=True)
class Cost:
    """What the work cost, as counters."""

    supports: int
    gjk_iterations: int
    epa_iterations: int
    nodes: int
    pairs: int
    escalations: int
    patch_corners: int
    patch_cuts: int
    derivative_separations: int
    derivative_supports: int
    derivative_corners: int

    @classmethod
    def of(cls, cost: messages.Cost) -> Cost:
        return cls(
            cost.supports,
            cost.gjk_iterations,
            cost.epa_iterations,
            cost.nodes,
            cost.pairs,
            cost.escalations,
            cost.patch_corners,
            cost.patch_cuts,
            cost.derivative_separations,
            cost.derivative_supports,
            cost.derivative_corners,
        )


@dataclass(frozen=True)
class Side:
    """One side of a pair: a link of the robot, a body of the scene, or the bare shape of the question."""

    #: `link`, `body` or `query`.
    kind: str
    #: Index of the link in `Robot.links`, or id of the body.
    id: Optional[int]
    #: Triangle of a mesh or part of a compound; 0 for a single convex shape.
    subshape: int

    @classmethod
    def of(cls, side: messages.Side) -> Side:
        kind = side.WhichOneof("kind")
        if kind == "link":
            return cls("link", side.link.link, side.link.subshape)
        if kind == "body":
            return cls("body", side.body.id, side.body.subshape)
        return cls("query", None, side.query.subshape)


@dataclass(frozen=True)
class Bracket:
    """A proved interval: the signed distance is, in the truth, in `lower..upper`."""

    lower: float
    upper: float


@dataclass(frozen=True)
class ContactPatch:
    """Where the faces of a pair touch, or are nearest. n points, world frame, metres."""

    #: Unit vector from A to B.
    normal: NDArray[np.float64]
    #: Shape (n, 3): on the face of A, and across from it on that of B.
    points_on_a: NDArray[np.float64]
    points_on_b: NDArray[np.float64]
    #: Shape (n,): along the normal; negative: how far the faces overlap at that point.
    signed_distances: NDArray[np.float64]
    #: The first so many points are the corners of a convex polygon, counter-clockwise as seen from the normal's tip.
    corners: int
    #: There are fewer corners than there should be.
    truncated: bool

    @classmethod
    def of(cls, patch: messages.ContactPatch) -> ContactPatch:
        def table(side: str) -> NDArray[np.float64]:
            return np.array([_array(getattr(point, side)) for point in patch.points]).reshape(-1, 3)

        distances = np.array([point.signed_distance for point in patch.points])
        return cls(
            _array(patch.normal), table("point_on_a"), table("point_on_b"), distances, patch.corners, patch.truncated
        )


@dataclass(frozen=True)
class PairAnswer:
    """What is known about one pair."""

    a: Side
    b: Side
    verdict: Verdict
    bracket: Bracket
    #: Best estimate inside the bracket; negative: minus the depth.
    signed_distance: float
    #: `point_on_b - point_on_a = signed_distance * normal`; None where no witness was wanted.
    point_on_a: Optional[NDArray[np.float64]]
    point_on_b: Optional[NDArray[np.float64]]
    #: Unit vector from A to B.
    normal: Optional[NDArray[np.float64]]
    #: How far at most either point is from its shape, and, apart, the vector between them from the true nearest vector.
    point_error: Optional[float]
    #: By how much at most the normal is turned from the true nearest vector, radians; pi where nothing is known.
    normal_error: Optional[float]
    #: How the work stopped, for example `CONVERGED`.
    termination: str
    #: Where the faces touch; None unless wanted, and of a pair that is proved apart by more than its margin.
    patch: Optional[ContactPatch]
    #: How the pair changes when its bodies move; None unless wanted, and of a piece that is not a single convex one.
    derivatives: Optional[PairDerivatives]

    @classmethod
    def of(cls, pair: messages.PairAnswer) -> PairAnswer:
        witness = pair.witness if pair.HasField("witness") else None
        return cls(
            a=Side.of(pair.a),
            b=Side.of(pair.b),
            verdict=Verdict(pair.verdict),
            bracket=Bracket(pair.bracket.lower, pair.bracket.upper),
            signed_distance=pair.signed_distance,
            point_on_a=_array(witness.point_on_a) if witness else None,
            point_on_b=_array(witness.point_on_b) if witness else None,
            normal=_array(witness.normal) if witness else None,
            point_error=witness.point_error if witness else None,
            normal_error=witness.normal_error if witness else None,
            termination=messages.Termination.Name(pair.termination).removeprefix("TERMINATION_"),
            patch=ContactPatch.of(pair.patch) if pair.HasField("patch") else None,
            derivatives=PairDerivatives.of(pair.derivatives) if pair.HasField("derivatives") else None,
        )


@dataclass(frozen=True)
class ItemAnswer:
    """The answer to one state or subject."""

    verdict: Verdict
    #: The pair of least signed distance, or of a verdict alone the pair that decided.
    nearest: Optional[PairAnswer]
    #: Of states: the nearest pair of two links, and of a link and a body.
    nearest_self: Optional[PairAnswer]
    nearest_scene: Optional[PairAnswer]
    #: Pairs that collide, cannot be decided or are within the margin.
    pairs: tuple[PairAnswer, ...]
    #: There were more pairs than the limit lets through.
    truncated: bool
    #: Of `INVALID_INPUT`: which field, and what is wrong with it.
    problem: str
    cost: Cost

    @classmethod
    def of(cls, item: messages.ItemAnswer) -> ItemAnswer:
        def pair(name: str) -> Optional[PairAnswer]:
            return PairAnswer.of(getattr(item, name)) if item.HasField(name) else None

        return cls(
            verdict=Verdict(item.verdict),
            nearest=pair("nearest"),
            nearest_self=pair("nearest_self"),
            nearest_scene=pair("nearest_scene"),
            pairs=tuple(PairAnswer.of(each) for each in item.pairs),
            truncated=item.truncated,
            problem=item.problem,
            cost=Cost.of(item.cost),
        )


class ItemAnswers(list[ItemAnswer]):
    """The answers to all items of a question, in their order."""

    #: Names of the bodies that overlays added, by the number of the overlay (0: the common one) and the body's id.
    added: dict[tuple[int, int], str]
    #: Pairs that the scene declares empty: no item says anything of them.
    declared_empty: tuple[scene.PartyPair, ...]
    #: How many more such pairs there are than are listed.
    declared_empty_not_listed: int

    @classmethod
    def of(cls, answer: messages.Answer) -> ItemAnswers:
        answers = cls(ItemAnswer.of(item) for item in answer.items)
        answers.declared_empty = tuple(answer.coverage.declared_empty)
        answers.declared_empty_not_listed = answer.coverage.not_listed
        answers.added = {(body.overlay, body.id): body.name for body in answer.added_bodies}
        return answers


@dataclass(frozen=True)
class Brackets:
    """Brackets of all items of a batch as arrays; NaN where an item has no such pair."""

    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    signed_distance: NDArray[np.float64]

    @classmethod
    def of(cls, brackets: messages.BulkBrackets, count: int) -> Brackets:
        def numbers(data: bytes) -> NDArray[np.float64]:
            return np.frombuffer(data, dtype="<f8") if data else np.full(count, np.nan)

        return cls(numbers(brackets.lower), numbers(brackets.upper), numbers(brackets.signed_distance))


@dataclass(frozen=True)
class StatesAnswer:
    """The answer to a batch of a robot's states, one element a state."""

    epoch: int
    #: The state of the scene that was asked.
    revision: int
    #: Numbers of `Verdict`.
    verdicts: NDArray[np.uint8]
    #: Of the nearest pair at all, of two links, of a link and a body; NaN unless distances were wanted.
    nearest: Brackets
    nearest_self: Brackets
    nearest_scene: Brackets
    #: Of states that are `INVALID_INPUT`: which field, and what is wrong with it.
    problems: dict[int, str]
    #: With stop at first: the state that stopped the batch.
    stopped_at: Optional[int]
    #: Time ran out; states not looked at are `NOT_RUN`.
    out_of_time: bool
    #: Pairs that the scene declares empty: no verdict says anything of them.
    declared_empty: tuple[scene.PartyPair, ...]
    #: How many more such pairs there are than are listed.
    declared_empty_not_listed: int
    cost: Cost = field(repr=False)

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which states are proved to be free."""
        return self.verdicts == Verdict.FREE

    @property
    def lower(self) -> NDArray[np.float64]:
        """Lower ends of the brackets of the nearest pairs."""
        return self.nearest.lower

    @property
    def upper(self) -> NDArray[np.float64]:
        """Upper ends of the brackets of the nearest pairs."""
        return self.nearest.upper

    @property
    def signed_distance(self) -> NDArray[np.float64]:
        """Best estimates inside the brackets of the nearest pairs."""
        return self.nearest.signed_distance

    @classmethod
    def of(cls, answer: messages.Answer) -> StatesAnswer:
        bulk = answer.bulk
        count = len(bulk.verdicts)
        return cls(
            epoch=answer.epoch,
            revision=answer.revision,
            verdicts=np.frombuffer(bulk.verdicts, dtype=np.uint8),
            nearest=Brackets.of(bulk.nearest, count),
            nearest_self=Brackets.of(bulk.nearest_self, count),
            nearest_scene=Brackets.of(bulk.nearest_scene, count),
            problems={each.item: each.problem for each in bulk.problems},
            stopped_at=answer.stopped_at if answer.HasField("stopped_at") else None,
            out_of_time=answer.out_of_time,
            declared_empty=tuple(answer.coverage.declared_empty),
            declared_empty_not_listed=answer.coverage.not_listed,
            cost=Cost.of(answer.cost),
        )


def _array(v: geometry.Vec3) -> NDArray[np.float64]:
    return np.array([v.x, v.y, v.z])
