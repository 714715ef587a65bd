"""How pairs change when their bodies move: what is asked, and what is answered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
from numpy.typing import NDArray

from .v1 import query_pb2 as messages

#: What a question's `derivatives` may be: the name of a method, or :func:`derivatives` with more.
Derivatives = Union[str, messages.DerivativeOptions]


def derivatives(
    method: str = "exact",
    *,
    epsilon: Optional[float] = None,
    samples: Optional[int] = None,
    seed: Optional[int] = None,
) -> messages.DerivativeOptions:
    """How derivatives are made, to be given to a question.

    `method`: `exact`, `exact_cell`, `finite_difference`, `smoothed_0`, `smoothed_1_gaussian` or `smoothed_1_gumbel`. `epsilon` is how
    far smoothing reaches, as a part of the size of what is smoothed, by default chosen from the pair; `samples` how many pairs of samples
    the random methods take, by default 64. Equal seeds reproduce them.
    """
    known = {
        key.removeprefix("DERIVATIVE_METHOD_").lower(): number
        for key, number in messages.DerivativeMethod.items()
        if number
    }
    if method not in known:
        raise ValueError(f"derivatives: is {method!r}, known are {', '.join(known)}")
    return messages.DerivativeOptions(method=known[method], epsilon=epsilon, samples=samples, seed=seed)


def want_derivatives(context: messages.Context, wanted: Optional[Derivatives]) -> None:
    """Puts them into the context of a question."""
    if wanted is None:
        return
    context.wants.derivatives = True
    context.derivatives.CopyFrom(derivatives(wanted) if isinstance(wanted, str) else wanted)


@dataclass(frozen=True)
class TwistDerivatives:
    """With respect to the twist of one side about its own origin, in the world's axes.

    Columns: velocity along x, y, z (metres), turn about x, y, z (radians). The origin of a link is that of its frame, that of a body
    which a link holds the link's.
    """

    #: Shape (6,): metres per metre and per radian.
    signed_distance: NDArray[np.float64]
    #: Shape (3, 6): of the unit normal from A to B; per metre and per radian.
    normal: NDArray[np.float64]
    #: Shape (3, 6): of the witnesses as places in space, not as points held fast in the bodies; metres per metre and per radian.
    point_on_a: NDArray[np.float64]
    point_on_b: NDArray[np.float64]

    @classmethod
    def of(cls, side: messages.TwistDerivatives) -> TwistDerivatives:
        def rows(name: str) -> NDArray[np.float64]:
            return np.array(getattr(side, name), dtype=np.float64).reshape(3, 6)

        distance = np.array(side.signed_distance, dtype=np.float64)
        return cls(distance, rows("normal"), rows("point_on_a"), rows("point_on_b"))


@dataclass(frozen=True)
class PairDerivatives:
    """How a pair changes when its bodies move."""

    of_a: TwistDerivatives
    of_b: TwistDerivatives
    #: Of states of a robot: the gradient of the signed distance with respect to the joints' positions, shape (degrees of freedom,); metres
    #: per radian, or per metre of sliding joints. Else empty.
    joints: NDArray[np.float64]
    #: How they were made, by the names of :func:`derivatives`. Where `exact` was asked of a side that is not smooth: `exact_cell`.
    method: str
    #: Metres: by what a change of the normal is divided. Infinite where a face or two edges hold the normal, NaN where it is not known.
    conditioning: float
    #: What is wrong at most: of formulas metres that the witnesses are off the normal, of differences a factor, of random methods the
    #: standard error of the largest entry that is random.
    residual: float
    #: What was used; 0 where nothing is smoothed, or nothing is random.
    epsilon: float
    samples: int
    seed: int
    #: False where there is no one witness, or where the conditioning is not positive.
    is_valid: bool
    #: The witness is where several features meet: a move may lead to another one.
    on_border: bool
    #: Another pair of pieces may be as near: a move may make it the deciding one.
    is_contested: bool

    @classmethod
    def of(cls, pair: messages.PairDerivatives) -> PairDerivatives:
        return cls(
            of_a=TwistDerivatives.of(pair.of_a),
            of_b=TwistDerivatives.of(pair.of_b),
            joints=np.array(pair.joints, dtype=np.float64),
            method=messages.DerivativeMethod.Name(pair.method).removeprefix("DERIVATIVE_METHOD_").lower(),
            conditioning=pair.conditioning,
            residual=pair.residual,
            epsilon=pair.epsilon,
            samples=pair.samples,
            seed=pair.seed,
            is_valid=pair.is_valid,
            on_border=pair.on_border,
            is_contested=pair.is_contested,
        )
