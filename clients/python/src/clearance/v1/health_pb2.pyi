from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class GetSceneHealthRequest(_message.Message):
    __slots__ = ("scene", "against_rebuilt")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    AGAINST_REBUILT_FIELD_NUMBER: _ClassVar[int]
    scene: str
    against_rebuilt: bool
    def __init__(self, scene: _Optional[str] = ..., against_rebuilt: bool = ...) -> None: ...

class GetSceneHealthResponse(_message.Message):
    __slots__ = ("health",)
    HEALTH_FIELD_NUMBER: _ClassVar[int]
    health: SceneHealth
    def __init__(self, health: _Optional[_Union[SceneHealth, _Mapping]] = ...) -> None: ...

class SceneHealth(_message.Message):
    __slots__ = ("name", "epoch", "revision", "bodies", "memory", "kept_bytes", "kept", "tree", "sweep_and_prune", "exhaustive")
    NAME_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    MEMORY_FIELD_NUMBER: _ClassVar[int]
    KEPT_BYTES_FIELD_NUMBER: _ClassVar[int]
    KEPT_FIELD_NUMBER: _ClassVar[int]
    TREE_FIELD_NUMBER: _ClassVar[int]
    SWEEP_AND_PRUNE_FIELD_NUMBER: _ClassVar[int]
    EXHAUSTIVE_FIELD_NUMBER: _ClassVar[int]
    name: str
    epoch: int
    revision: int
    bodies: int
    memory: SceneMemory
    kept_bytes: int
    kept: _containers.RepeatedCompositeFieldContainer[KeptRevision]
    tree: TreeHealth
    sweep_and_prune: SweepHealth
    exhaustive: ExhaustiveHealth
    def __init__(self, name: _Optional[str] = ..., epoch: _Optional[int] = ..., revision: _Optional[int] = ..., bodies: _Optional[int] = ..., memory: _Optional[_Union[SceneMemory, _Mapping]] = ..., kept_bytes: _Optional[int] = ..., kept: _Optional[_Iterable[_Union[KeptRevision, _Mapping]]] = ..., tree: _Optional[_Union[TreeHealth, _Mapping]] = ..., sweep_and_prune: _Optional[_Union[SweepHealth, _Mapping]] = ..., exhaustive: _Optional[_Union[ExhaustiveHealth, _Mapping]] = ...) -> None: ...

class SceneMemory(_message.Message):
    __slots__ = ("bodies", "names", "broad_phase", "entries")
    BODIES_FIELD_NUMBER: _ClassVar[int]
    NAMES_FIELD_NUMBER: _ClassVar[int]
    BROAD_PHASE_FIELD_NUMBER: _ClassVar[int]
    ENTRIES_FIELD_NUMBER: _ClassVar[int]
    bodies: int
    names: int
    broad_phase: int
    entries: int
    def __init__(self, bodies: _Optional[int] = ..., names: _Optional[int] = ..., broad_phase: _Optional[int] = ..., entries: _Optional[int] = ...) -> None: ...

class KeptRevision(_message.Message):
    __slots__ = ("revision", "written_bytes")
    REVISION_FIELD_NUMBER: _ClassVar[int]
    WRITTEN_BYTES_FIELD_NUMBER: _ClassVar[int]
    revision: int
    written_bytes: int
    def __init__(self, revision: _Optional[int] = ..., written_bytes: _Optional[int] = ...) -> None: ...

class TreeHealth(_message.Message):
    __slots__ = ("entries", "depth", "least_depth", "surface_cost", "rebuilt_surface_cost", "stale", "fill", "debt", "upkeep", "rounds", "bytes_per_entry")
    ENTRIES_FIELD_NUMBER: _ClassVar[int]
    DEPTH_FIELD_NUMBER: _ClassVar[int]
    LEAST_DEPTH_FIELD_NUMBER: _ClassVar[int]
    SURFACE_COST_FIELD_NUMBER: _ClassVar[int]
    REBUILT_SURFACE_COST_FIELD_NUMBER: _ClassVar[int]
    STALE_FIELD_NUMBER: _ClassVar[int]
    FILL_FIELD_NUMBER: _ClassVar[int]
    DEBT_FIELD_NUMBER: _ClassVar[int]
    UPKEEP_FIELD_NUMBER: _ClassVar[int]
    ROUNDS_FIELD_NUMBER: _ClassVar[int]
    BYTES_PER_ENTRY_FIELD_NUMBER: _ClassVar[int]
    entries: int
    depth: int
    least_depth: int
    surface_cost: float
    rebuilt_surface_cost: float
    stale: float
    fill: float
    debt: float
    upkeep: int
    rounds: int
    bytes_per_entry: float
    def __init__(self, entries: _Optional[int] = ..., depth: _Optional[int] = ..., least_depth: _Optional[int] = ..., surface_cost: _Optional[float] = ..., rebuilt_surface_cost: _Optional[float] = ..., stale: _Optional[float] = ..., fill: _Optional[float] = ..., debt: _Optional[float] = ..., upkeep: _Optional[int] = ..., rounds: _Optional[int] = ..., bytes_per_entry: _Optional[float] = ...) -> None: ...

class SweepHealth(_message.Message):
    __slots__ = ("entries", "axis", "meeting_share", "best_meeting_share", "filling", "changes_since_choice", "free_places")
    ENTRIES_FIELD_NUMBER: _ClassVar[int]
    AXIS_FIELD_NUMBER: _ClassVar[int]
    MEETING_SHARE_FIELD_NUMBER: _ClassVar[int]
    BEST_MEETING_SHARE_FIELD_NUMBER: _ClassVar[int]
    FILLING_FIELD_NUMBER: _ClassVar[int]
    CHANGES_SINCE_CHOICE_FIELD_NUMBER: _ClassVar[int]
    FREE_PLACES_FIELD_NUMBER: _ClassVar[int]
    entries: int
    axis: int
    meeting_share: float
    best_meeting_share: float
    filling: float
    changes_since_choice: int
    free_places: int
    def __init__(self, entries: _Optional[int] = ..., axis: _Optional[int] = ..., meeting_share: _Optional[float] = ..., best_meeting_share: _Optional[float] = ..., filling: _Optional[float] = ..., changes_since_choice: _Optional[int] = ..., free_places: _Optional[int] = ...) -> None: ...

class ExhaustiveHealth(_message.Message):
    __slots__ = ("entries", "free_places")
    ENTRIES_FIELD_NUMBER: _ClassVar[int]
    FREE_PLACES_FIELD_NUMBER: _ClassVar[int]
    entries: int
    free_places: int
    def __init__(self, entries: _Optional[int] = ..., free_places: _Optional[int] = ...) -> None: ...
