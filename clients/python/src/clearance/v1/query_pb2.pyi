from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import overlay_pb2 as _overlay_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Solver(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    SOLVER_UNSPECIFIED: _ClassVar[Solver]
    SOLVER_DEFAULT: _ClassVar[Solver]
    SOLVER_FRANK_WOLFE: _ClassVar[Solver]
    SOLVER_GJK: _ClassVar[Solver]
    SOLVER_GJK_POLYAK: _ClassVar[Solver]
    SOLVER_GJK_NESTEROV: _ClassVar[Solver]
    SOLVER_GJK_NESTEROV_NORMALISED: _ClassVar[Solver]
    SOLVER_SAT: _ClassVar[Solver]
    SOLVER_QP: _ClassVar[Solver]
    SOLVER_EXACT: _ClassVar[Solver]

class DerivativeMethod(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    DERIVATIVE_METHOD_UNSPECIFIED: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_EXACT: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_EXACT_CELL: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_FINITE_DIFFERENCE: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_SMOOTHED_0: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_SMOOTHED_1_GAUSSIAN: _ClassVar[DerivativeMethod]
    DERIVATIVE_METHOD_SMOOTHED_1_GUMBEL: _ClassVar[DerivativeMethod]

class AnswerForm(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    ANSWER_FORM_UNSPECIFIED: _ClassVar[AnswerForm]
    ANSWER_FORM_ITEMS: _ClassVar[AnswerForm]
    ANSWER_FORM_BULK: _ClassVar[AnswerForm]

class Mode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    MODE_UNSPECIFIED: _ClassVar[Mode]
    MODE_ALL: _ClassVar[Mode]
    MODE_STOP_AT_FIRST: _ClassVar[Mode]

class Verdict(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    VERDICT_UNSPECIFIED: _ClassVar[Verdict]
    VERDICT_FREE: _ClassVar[Verdict]
    VERDICT_MARGIN: _ClassVar[Verdict]
    VERDICT_COLLISION: _ClassVar[Verdict]
    VERDICT_INDETERMINATE: _ClassVar[Verdict]
    VERDICT_NOT_RUN: _ClassVar[Verdict]
    VERDICT_INVALID_INPUT: _ClassVar[Verdict]

class Indeterminacy(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    INDETERMINACY_UNSPECIFIED: _ClassVar[Indeterminacy]
    INDETERMINACY_ROUNDING: _ClassVar[Indeterminacy]
    INDETERMINACY_ITERATION_LIMIT: _ClassVar[Indeterminacy]
    INDETERMINACY_TIME_LIMIT: _ClassVar[Indeterminacy]
    INDETERMINACY_RESOLUTION: _ClassVar[Indeterminacy]

class Termination(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    TERMINATION_UNSPECIFIED: _ClassVar[Termination]
    TERMINATION_CLOSED_FORM: _ClassVar[Termination]
    TERMINATION_CONVERGED: _ClassVar[Termination]
    TERMINATION_DECIDED: _ClassVar[Termination]
    TERMINATION_ROUNDING_FLOOR: _ClassVar[Termination]
    TERMINATION_ITERATION_LIMIT: _ClassVar[Termination]
    TERMINATION_TIME_LIMIT: _ClassVar[Termination]
    TERMINATION_EXACT: _ClassVar[Termination]
SOLVER_UNSPECIFIED: Solver
SOLVER_DEFAULT: Solver
SOLVER_FRANK_WOLFE: Solver
SOLVER_GJK: Solver
SOLVER_GJK_POLYAK: Solver
SOLVER_GJK_NESTEROV: Solver
SOLVER_GJK_NESTEROV_NORMALISED: Solver
SOLVER_SAT: Solver
SOLVER_QP: Solver
SOLVER_EXACT: Solver
DERIVATIVE_METHOD_UNSPECIFIED: DerivativeMethod
DERIVATIVE_METHOD_EXACT: DerivativeMethod
DERIVATIVE_METHOD_EXACT_CELL: DerivativeMethod
DERIVATIVE_METHOD_FINITE_DIFFERENCE: DerivativeMethod
DERIVATIVE_METHOD_SMOOTHED_0: DerivativeMethod
DERIVATIVE_METHOD_SMOOTHED_1_GAUSSIAN: DerivativeMethod
DERIVATIVE_METHOD_SMOOTHED_1_GUMBEL: DerivativeMethod
ANSWER_FORM_UNSPECIFIED: AnswerForm
ANSWER_FORM_ITEMS: AnswerForm
ANSWER_FORM_BULK: AnswerForm
MODE_UNSPECIFIED: Mode
MODE_ALL: Mode
MODE_STOP_AT_FIRST: Mode
VERDICT_UNSPECIFIED: Verdict
VERDICT_FREE: Verdict
VERDICT_MARGIN: Verdict
VERDICT_COLLISION: Verdict
VERDICT_INDETERMINATE: Verdict
VERDICT_NOT_RUN: Verdict
VERDICT_INVALID_INPUT: Verdict
INDETERMINACY_UNSPECIFIED: Indeterminacy
INDETERMINACY_ROUNDING: Indeterminacy
INDETERMINACY_ITERATION_LIMIT: Indeterminacy
INDETERMINACY_TIME_LIMIT: Indeterminacy
INDETERMINACY_RESOLUTION: Indeterminacy
TERMINATION_UNSPECIFIED: Termination
TERMINATION_CLOSED_FORM: Termination
TERMINATION_CONVERGED: Termination
TERMINATION_DECIDED: Termination
TERMINATION_ROUNDING_FLOOR: Termination
TERMINATION_ITERATION_LIMIT: Termination
TERMINATION_TIME_LIMIT: Termination
TERMINATION_EXACT: Termination

class RevisionRule(_message.Message):
    __slots__ = ("epoch", "latest", "exactly", "at_least")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    LATEST_FIELD_NUMBER: _ClassVar[int]
    EXACTLY_FIELD_NUMBER: _ClassVar[int]
    AT_LEAST_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    latest: Latest
    exactly: int
    at_least: int
    def __init__(self, epoch: _Optional[int] = ..., latest: _Optional[_Union[Latest, _Mapping]] = ..., exactly: _Optional[int] = ..., at_least: _Optional[int] = ...) -> None: ...

class Latest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Wants(_message.Message):
    __slots__ = ("distance", "witness", "depth", "pairs", "patch", "derivatives")
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    WITNESS_FIELD_NUMBER: _ClassVar[int]
    DEPTH_FIELD_NUMBER: _ClassVar[int]
    PAIRS_FIELD_NUMBER: _ClassVar[int]
    PATCH_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVES_FIELD_NUMBER: _ClassVar[int]
    distance: bool
    witness: bool
    depth: bool
    pairs: bool
    patch: bool
    derivatives: bool
    def __init__(self, distance: bool = ..., witness: bool = ..., depth: bool = ..., pairs: bool = ..., patch: bool = ..., derivatives: bool = ...) -> None: ...

class Accuracy(_message.Message):
    __slots__ = ("absolute", "relative")
    ABSOLUTE_FIELD_NUMBER: _ClassVar[int]
    RELATIVE_FIELD_NUMBER: _ClassVar[int]
    absolute: float
    relative: float
    def __init__(self, absolute: _Optional[float] = ..., relative: _Optional[float] = ...) -> None: ...

class Filter(_message.Message):
    __slots__ = ("groups", "ignore", "disregard_allowed_collisions", "layers", "mask")
    GROUPS_FIELD_NUMBER: _ClassVar[int]
    IGNORE_FIELD_NUMBER: _ClassVar[int]
    DISREGARD_ALLOWED_COLLISIONS_FIELD_NUMBER: _ClassVar[int]
    LAYERS_FIELD_NUMBER: _ClassVar[int]
    MASK_FIELD_NUMBER: _ClassVar[int]
    groups: _containers.RepeatedScalarFieldContainer[str]
    ignore: _containers.RepeatedCompositeFieldContainer[_scene_pb2.BodyRef]
    disregard_allowed_collisions: bool
    layers: int
    mask: int
    def __init__(self, groups: _Optional[_Iterable[str]] = ..., ignore: _Optional[_Iterable[_Union[_scene_pb2.BodyRef, _Mapping]]] = ..., disregard_allowed_collisions: bool = ..., layers: _Optional[int] = ..., mask: _Optional[int] = ...) -> None: ...

class Context(_message.Message):
    __slots__ = ("scene", "revision", "wants", "margin", "cut_off", "accuracy", "filter", "max_pairs", "time_budget", "answer_form", "solver", "overlay", "alternatives", "item_alternatives", "max_patch_points", "derivatives")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    WANTS_FIELD_NUMBER: _ClassVar[int]
    MARGIN_FIELD_NUMBER: _ClassVar[int]
    CUT_OFF_FIELD_NUMBER: _ClassVar[int]
    ACCURACY_FIELD_NUMBER: _ClassVar[int]
    FILTER_FIELD_NUMBER: _ClassVar[int]
    MAX_PAIRS_FIELD_NUMBER: _ClassVar[int]
    TIME_BUDGET_FIELD_NUMBER: _ClassVar[int]
    ANSWER_FORM_FIELD_NUMBER: _ClassVar[int]
    SOLVER_FIELD_NUMBER: _ClassVar[int]
    OVERLAY_FIELD_NUMBER: _ClassVar[int]
    ALTERNATIVES_FIELD_NUMBER: _ClassVar[int]
    ITEM_ALTERNATIVES_FIELD_NUMBER: _ClassVar[int]
    MAX_PATCH_POINTS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVES_FIELD_NUMBER: _ClassVar[int]
    scene: str
    revision: RevisionRule
    wants: Wants
    margin: float
    cut_off: float
    accuracy: Accuracy
    filter: Filter
    max_pairs: int
    time_budget: float
    answer_form: AnswerForm
    solver: Solver
    overlay: _overlay_pb2.Overlay
    alternatives: _containers.RepeatedCompositeFieldContainer[_overlay_pb2.Overlay]
    item_alternatives: _containers.RepeatedScalarFieldContainer[int]
    max_patch_points: int
    derivatives: DerivativeOptions
    def __init__(self, scene: _Optional[str] = ..., revision: _Optional[_Union[RevisionRule, _Mapping]] = ..., wants: _Optional[_Union[Wants, _Mapping]] = ..., margin: _Optional[float] = ..., cut_off: _Optional[float] = ..., accuracy: _Optional[_Union[Accuracy, _Mapping]] = ..., filter: _Optional[_Union[Filter, _Mapping]] = ..., max_pairs: _Optional[int] = ..., time_budget: _Optional[float] = ..., answer_form: _Optional[_Union[AnswerForm, str]] = ..., solver: _Optional[_Union[Solver, str]] = ..., overlay: _Optional[_Union[_overlay_pb2.Overlay, _Mapping]] = ..., alternatives: _Optional[_Iterable[_Union[_overlay_pb2.Overlay, _Mapping]]] = ..., item_alternatives: _Optional[_Iterable[int]] = ..., max_patch_points: _Optional[int] = ..., derivatives: _Optional[_Union[DerivativeOptions, _Mapping]] = ...) -> None: ...

class DerivativeOptions(_message.Message):
    __slots__ = ("method", "epsilon", "samples", "seed")
    METHOD_FIELD_NUMBER: _ClassVar[int]
    EPSILON_FIELD_NUMBER: _ClassVar[int]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    method: DerivativeMethod
    epsilon: float
    samples: int
    seed: int
    def __init__(self, method: _Optional[_Union[DerivativeMethod, str]] = ..., epsilon: _Optional[float] = ..., samples: _Optional[int] = ..., seed: _Optional[int] = ...) -> None: ...

class CheckStatesRequest(_message.Message):
    __slots__ = ("context", "robot", "positions", "mode")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    context: Context
    robot: str
    positions: _geometry_pb2.Doubles
    mode: Mode
    def __init__(self, context: _Optional[_Union[Context, _Mapping]] = ..., robot: _Optional[str] = ..., positions: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., mode: _Optional[_Union[Mode, str]] = ...) -> None: ...

class Subject(_message.Message):
    __slots__ = ("all_pairs", "body", "shape", "changed_since")
    ALL_PAIRS_FIELD_NUMBER: _ClassVar[int]
    BODY_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    CHANGED_SINCE_FIELD_NUMBER: _ClassVar[int]
    all_pairs: AllPairs
    body: _scene_pb2.BodyRef
    shape: PlacedShape
    changed_since: ChangedSince
    def __init__(self, all_pairs: _Optional[_Union[AllPairs, _Mapping]] = ..., body: _Optional[_Union[_scene_pb2.BodyRef, _Mapping]] = ..., shape: _Optional[_Union[PlacedShape, _Mapping]] = ..., changed_since: _Optional[_Union[ChangedSince, _Mapping]] = ...) -> None: ...

class AllPairs(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class ChangedSince(_message.Message):
    __slots__ = ("revision",)
    REVISION_FIELD_NUMBER: _ClassVar[int]
    revision: int
    def __init__(self, revision: _Optional[int] = ...) -> None: ...

class PlacedShape(_message.Message):
    __slots__ = ("shape", "pose")
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    shape: _geometry_pb2.Shape
    pose: _geometry_pb2.Pose
    def __init__(self, shape: _Optional[_Union[_geometry_pb2.Shape, _Mapping]] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class CollideRequest(_message.Message):
    __slots__ = ("context", "items", "mode")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    context: Context
    items: _containers.RepeatedCompositeFieldContainer[Subject]
    mode: Mode
    def __init__(self, context: _Optional[_Union[Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[Subject, _Mapping]]] = ..., mode: _Optional[_Union[Mode, str]] = ...) -> None: ...

class DistanceRequest(_message.Message):
    __slots__ = ("context", "items", "mode")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    context: Context
    items: _containers.RepeatedCompositeFieldContainer[Subject]
    mode: Mode
    def __init__(self, context: _Optional[_Union[Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[Subject, _Mapping]]] = ..., mode: _Optional[_Union[Mode, str]] = ...) -> None: ...

class Bracket(_message.Message):
    __slots__ = ("lower", "upper")
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    lower: float
    upper: float
    def __init__(self, lower: _Optional[float] = ..., upper: _Optional[float] = ...) -> None: ...

class Side(_message.Message):
    __slots__ = ("link", "query", "body")
    LINK_FIELD_NUMBER: _ClassVar[int]
    QUERY_FIELD_NUMBER: _ClassVar[int]
    BODY_FIELD_NUMBER: _ClassVar[int]
    link: LinkSide
    query: QuerySide
    body: BodySide
    def __init__(self, link: _Optional[_Union[LinkSide, _Mapping]] = ..., query: _Optional[_Union[QuerySide, _Mapping]] = ..., body: _Optional[_Union[BodySide, _Mapping]] = ...) -> None: ...

class LinkSide(_message.Message):
    __slots__ = ("link", "shape", "subshape")
    LINK_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    SUBSHAPE_FIELD_NUMBER: _ClassVar[int]
    link: int
    shape: int
    subshape: int
    def __init__(self, link: _Optional[int] = ..., shape: _Optional[int] = ..., subshape: _Optional[int] = ...) -> None: ...

class QuerySide(_message.Message):
    __slots__ = ("subshape",)
    SUBSHAPE_FIELD_NUMBER: _ClassVar[int]
    subshape: int
    def __init__(self, subshape: _Optional[int] = ...) -> None: ...

class BodySide(_message.Message):
    __slots__ = ("id", "subshape")
    ID_FIELD_NUMBER: _ClassVar[int]
    SUBSHAPE_FIELD_NUMBER: _ClassVar[int]
    id: int
    subshape: int
    def __init__(self, id: _Optional[int] = ..., subshape: _Optional[int] = ...) -> None: ...

class Witness(_message.Message):
    __slots__ = ("point_on_a", "point_on_b", "normal", "point_error", "normal_error")
    POINT_ON_A_FIELD_NUMBER: _ClassVar[int]
    POINT_ON_B_FIELD_NUMBER: _ClassVar[int]
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    POINT_ERROR_FIELD_NUMBER: _ClassVar[int]
    NORMAL_ERROR_FIELD_NUMBER: _ClassVar[int]
    point_on_a: _geometry_pb2.Vec3
    point_on_b: _geometry_pb2.Vec3
    normal: _geometry_pb2.Vec3
    point_error: float
    normal_error: float
    def __init__(self, point_on_a: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., point_on_b: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., normal: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., point_error: _Optional[float] = ..., normal_error: _Optional[float] = ...) -> None: ...

class PairAnswer(_message.Message):
    __slots__ = ("a", "b", "verdict", "indeterminacy", "bracket", "signed_distance", "witness", "termination", "patch", "derivatives")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    BRACKET_FIELD_NUMBER: _ClassVar[int]
    SIGNED_DISTANCE_FIELD_NUMBER: _ClassVar[int]
    WITNESS_FIELD_NUMBER: _ClassVar[int]
    TERMINATION_FIELD_NUMBER: _ClassVar[int]
    PATCH_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVES_FIELD_NUMBER: _ClassVar[int]
    a: Side
    b: Side
    verdict: Verdict
    indeterminacy: Indeterminacy
    bracket: Bracket
    signed_distance: float
    witness: Witness
    termination: Termination
    patch: ContactPatch
    derivatives: PairDerivatives
    def __init__(self, a: _Optional[_Union[Side, _Mapping]] = ..., b: _Optional[_Union[Side, _Mapping]] = ..., verdict: _Optional[_Union[Verdict, str]] = ..., indeterminacy: _Optional[_Union[Indeterminacy, str]] = ..., bracket: _Optional[_Union[Bracket, _Mapping]] = ..., signed_distance: _Optional[float] = ..., witness: _Optional[_Union[Witness, _Mapping]] = ..., termination: _Optional[_Union[Termination, str]] = ..., patch: _Optional[_Union[ContactPatch, _Mapping]] = ..., derivatives: _Optional[_Union[PairDerivatives, _Mapping]] = ...) -> None: ...

class ContactPatch(_message.Message):
    __slots__ = ("normal", "points", "corners", "truncated")
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    CORNERS_FIELD_NUMBER: _ClassVar[int]
    TRUNCATED_FIELD_NUMBER: _ClassVar[int]
    normal: _geometry_pb2.Vec3
    points: _containers.RepeatedCompositeFieldContainer[ContactPoint]
    corners: int
    truncated: bool
    def __init__(self, normal: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., points: _Optional[_Iterable[_Union[ContactPoint, _Mapping]]] = ..., corners: _Optional[int] = ..., truncated: bool = ...) -> None: ...

class ContactPoint(_message.Message):
    __slots__ = ("point_on_a", "point_on_b", "signed_distance")
    POINT_ON_A_FIELD_NUMBER: _ClassVar[int]
    POINT_ON_B_FIELD_NUMBER: _ClassVar[int]
    SIGNED_DISTANCE_FIELD_NUMBER: _ClassVar[int]
    point_on_a: _geometry_pb2.Vec3
    point_on_b: _geometry_pb2.Vec3
    signed_distance: float
    def __init__(self, point_on_a: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., point_on_b: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., signed_distance: _Optional[float] = ...) -> None: ...

class PairDerivatives(_message.Message):
    __slots__ = ("of_a", "of_b", "joints", "method", "conditioning", "residual", "epsilon", "samples", "seed", "is_valid", "on_border", "is_contested")
    OF_A_FIELD_NUMBER: _ClassVar[int]
    OF_B_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    CONDITIONING_FIELD_NUMBER: _ClassVar[int]
    RESIDUAL_FIELD_NUMBER: _ClassVar[int]
    EPSILON_FIELD_NUMBER: _ClassVar[int]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    IS_VALID_FIELD_NUMBER: _ClassVar[int]
    ON_BORDER_FIELD_NUMBER: _ClassVar[int]
    IS_CONTESTED_FIELD_NUMBER: _ClassVar[int]
    of_a: TwistDerivatives
    of_b: TwistDerivatives
    joints: _containers.RepeatedScalarFieldContainer[float]
    method: DerivativeMethod
    conditioning: float
    residual: float
    epsilon: float
    samples: int
    seed: int
    is_valid: bool
    on_border: bool
    is_contested: bool
    def __init__(self, of_a: _Optional[_Union[TwistDerivatives, _Mapping]] = ..., of_b: _Optional[_Union[TwistDerivatives, _Mapping]] = ..., joints: _Optional[_Iterable[float]] = ..., method: _Optional[_Union[DerivativeMethod, str]] = ..., conditioning: _Optional[float] = ..., residual: _Optional[float] = ..., epsilon: _Optional[float] = ..., samples: _Optional[int] = ..., seed: _Optional[int] = ..., is_valid: bool = ..., on_border: bool = ..., is_contested: bool = ...) -> None: ...

class TwistDerivatives(_message.Message):
    __slots__ = ("signed_distance", "normal", "point_on_a", "point_on_b")
    SIGNED_DISTANCE_FIELD_NUMBER: _ClassVar[int]
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    POINT_ON_A_FIELD_NUMBER: _ClassVar[int]
    POINT_ON_B_FIELD_NUMBER: _ClassVar[int]
    signed_distance: _containers.RepeatedScalarFieldContainer[float]
    normal: _containers.RepeatedScalarFieldContainer[float]
    point_on_a: _containers.RepeatedScalarFieldContainer[float]
    point_on_b: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, signed_distance: _Optional[_Iterable[float]] = ..., normal: _Optional[_Iterable[float]] = ..., point_on_a: _Optional[_Iterable[float]] = ..., point_on_b: _Optional[_Iterable[float]] = ...) -> None: ...

class Cost(_message.Message):
    __slots__ = ("supports", "gjk_iterations", "epa_iterations", "nodes", "pairs", "escalations", "patch_corners", "patch_cuts", "derivative_separations", "derivative_supports", "derivative_corners")
    SUPPORTS_FIELD_NUMBER: _ClassVar[int]
    GJK_ITERATIONS_FIELD_NUMBER: _ClassVar[int]
    EPA_ITERATIONS_FIELD_NUMBER: _ClassVar[int]
    NODES_FIELD_NUMBER: _ClassVar[int]
    PAIRS_FIELD_NUMBER: _ClassVar[int]
    ESCALATIONS_FIELD_NUMBER: _ClassVar[int]
    PATCH_CORNERS_FIELD_NUMBER: _ClassVar[int]
    PATCH_CUTS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_SEPARATIONS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_SUPPORTS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_CORNERS_FIELD_NUMBER: _ClassVar[int]
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
    def __init__(self, supports: _Optional[int] = ..., gjk_iterations: _Optional[int] = ..., epa_iterations: _Optional[int] = ..., nodes: _Optional[int] = ..., pairs: _Optional[int] = ..., escalations: _Optional[int] = ..., patch_corners: _Optional[int] = ..., patch_cuts: _Optional[int] = ..., derivative_separations: _Optional[int] = ..., derivative_supports: _Optional[int] = ..., derivative_corners: _Optional[int] = ...) -> None: ...

class ItemAnswer(_message.Message):
    __slots__ = ("verdict", "indeterminacy", "nearest", "nearest_self", "nearest_scene", "pairs", "truncated", "problem", "cost")
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    NEAREST_FIELD_NUMBER: _ClassVar[int]
    NEAREST_SELF_FIELD_NUMBER: _ClassVar[int]
    NEAREST_SCENE_FIELD_NUMBER: _ClassVar[int]
    PAIRS_FIELD_NUMBER: _ClassVar[int]
    TRUNCATED_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    verdict: Verdict
    indeterminacy: Indeterminacy
    nearest: PairAnswer
    nearest_self: PairAnswer
    nearest_scene: PairAnswer
    pairs: _containers.RepeatedCompositeFieldContainer[PairAnswer]
    truncated: bool
    problem: str
    cost: Cost
    def __init__(self, verdict: _Optional[_Union[Verdict, str]] = ..., indeterminacy: _Optional[_Union[Indeterminacy, str]] = ..., nearest: _Optional[_Union[PairAnswer, _Mapping]] = ..., nearest_self: _Optional[_Union[PairAnswer, _Mapping]] = ..., nearest_scene: _Optional[_Union[PairAnswer, _Mapping]] = ..., pairs: _Optional[_Iterable[_Union[PairAnswer, _Mapping]]] = ..., truncated: bool = ..., problem: _Optional[str] = ..., cost: _Optional[_Union[Cost, _Mapping]] = ...) -> None: ...

class BulkAnswer(_message.Message):
    __slots__ = ("verdicts", "indeterminacies", "nearest", "nearest_self", "nearest_scene", "problems")
    VERDICTS_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACIES_FIELD_NUMBER: _ClassVar[int]
    NEAREST_FIELD_NUMBER: _ClassVar[int]
    NEAREST_SELF_FIELD_NUMBER: _ClassVar[int]
    NEAREST_SCENE_FIELD_NUMBER: _ClassVar[int]
    PROBLEMS_FIELD_NUMBER: _ClassVar[int]
    verdicts: bytes
    indeterminacies: bytes
    nearest: BulkBrackets
    nearest_self: BulkBrackets
    nearest_scene: BulkBrackets
    problems: _containers.RepeatedCompositeFieldContainer[BulkProblem]
    def __init__(self, verdicts: _Optional[bytes] = ..., indeterminacies: _Optional[bytes] = ..., nearest: _Optional[_Union[BulkBrackets, _Mapping]] = ..., nearest_self: _Optional[_Union[BulkBrackets, _Mapping]] = ..., nearest_scene: _Optional[_Union[BulkBrackets, _Mapping]] = ..., problems: _Optional[_Iterable[_Union[BulkProblem, _Mapping]]] = ...) -> None: ...

class BulkBrackets(_message.Message):
    __slots__ = ("lower", "upper", "signed_distance")
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    SIGNED_DISTANCE_FIELD_NUMBER: _ClassVar[int]
    lower: bytes
    upper: bytes
    signed_distance: bytes
    def __init__(self, lower: _Optional[bytes] = ..., upper: _Optional[bytes] = ..., signed_distance: _Optional[bytes] = ...) -> None: ...

class BulkProblem(_message.Message):
    __slots__ = ("item", "problem")
    ITEM_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    item: int
    problem: str
    def __init__(self, item: _Optional[int] = ..., problem: _Optional[str] = ...) -> None: ...

class Answer(_message.Message):
    __slots__ = ("epoch", "revision", "items", "bulk", "stopped_at", "out_of_time", "cost", "added_bodies", "coverage")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    BULK_FIELD_NUMBER: _ClassVar[int]
    STOPPED_AT_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    ADDED_BODIES_FIELD_NUMBER: _ClassVar[int]
    COVERAGE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    items: _containers.RepeatedCompositeFieldContainer[ItemAnswer]
    bulk: BulkAnswer
    stopped_at: int
    out_of_time: bool
    cost: Cost
    added_bodies: _containers.RepeatedCompositeFieldContainer[_overlay_pb2.AddedBody]
    coverage: _scene_pb2.Coverage
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., items: _Optional[_Iterable[_Union[ItemAnswer, _Mapping]]] = ..., bulk: _Optional[_Union[BulkAnswer, _Mapping]] = ..., stopped_at: _Optional[int] = ..., out_of_time: bool = ..., cost: _Optional[_Union[Cost, _Mapping]] = ..., added_bodies: _Optional[_Iterable[_Union[_overlay_pb2.AddedBody, _Mapping]]] = ..., coverage: _Optional[_Union[_scene_pb2.Coverage, _Mapping]] = ...) -> None: ...
