from clearance.v1 import geometry_pb2 as _geometry_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class JointKind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    JOINT_KIND_UNSPECIFIED: _ClassVar[JointKind]
    JOINT_KIND_REVOLUTE: _ClassVar[JointKind]
    JOINT_KIND_CONTINUOUS: _ClassVar[JointKind]
    JOINT_KIND_PRISMATIC: _ClassVar[JointKind]
    JOINT_KIND_FLOATING: _ClassVar[JointKind]
JOINT_KIND_UNSPECIFIED: JointKind
JOINT_KIND_REVOLUTE: JointKind
JOINT_KIND_CONTINUOUS: JointKind
JOINT_KIND_PRISMATIC: JointKind
JOINT_KIND_FLOATING: JointKind

class MeshBinding(_message.Message):
    __slots__ = ("filename", "sha256")
    FILENAME_FIELD_NUMBER: _ClassVar[int]
    SHA256_FIELD_NUMBER: _ClassVar[int]
    filename: str
    sha256: str
    def __init__(self, filename: _Optional[str] = ..., sha256: _Optional[str] = ...) -> None: ...

class LinkOptions(_message.Message):
    __slots__ = ("link", "mesh_mode", "scale", "padding")
    LINK_FIELD_NUMBER: _ClassVar[int]
    MESH_MODE_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    PADDING_FIELD_NUMBER: _ClassVar[int]
    link: str
    mesh_mode: _geometry_pb2.MeshMode
    scale: float
    padding: float
    def __init__(self, link: _Optional[str] = ..., mesh_mode: _Optional[_Union[_geometry_pb2.MeshMode, str]] = ..., scale: _Optional[float] = ..., padding: _Optional[float] = ...) -> None: ...

class LoadRobotRequest(_message.Message):
    __slots__ = ("urdf", "srdf", "meshes", "mesh_mode", "padding", "scale", "links")
    URDF_FIELD_NUMBER: _ClassVar[int]
    SRDF_FIELD_NUMBER: _ClassVar[int]
    MESHES_FIELD_NUMBER: _ClassVar[int]
    MESH_MODE_FIELD_NUMBER: _ClassVar[int]
    PADDING_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    LINKS_FIELD_NUMBER: _ClassVar[int]
    urdf: str
    srdf: str
    meshes: _containers.RepeatedCompositeFieldContainer[MeshBinding]
    mesh_mode: _geometry_pb2.MeshMode
    padding: float
    scale: float
    links: _containers.RepeatedCompositeFieldContainer[LinkOptions]
    def __init__(self, urdf: _Optional[str] = ..., srdf: _Optional[str] = ..., meshes: _Optional[_Iterable[_Union[MeshBinding, _Mapping]]] = ..., mesh_mode: _Optional[_Union[_geometry_pb2.MeshMode, str]] = ..., padding: _Optional[float] = ..., scale: _Optional[float] = ..., links: _Optional[_Iterable[_Union[LinkOptions, _Mapping]]] = ...) -> None: ...

class RobotModel(_message.Message):
    __slots__ = ("id", "name", "degrees_of_freedom", "joints", "links", "root", "self_pairs", "excluded_pairs", "groups")
    ID_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    DEGREES_OF_FREEDOM_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    LINKS_FIELD_NUMBER: _ClassVar[int]
    ROOT_FIELD_NUMBER: _ClassVar[int]
    SELF_PAIRS_FIELD_NUMBER: _ClassVar[int]
    EXCLUDED_PAIRS_FIELD_NUMBER: _ClassVar[int]
    GROUPS_FIELD_NUMBER: _ClassVar[int]
    id: str
    name: str
    degrees_of_freedom: int
    joints: _containers.RepeatedCompositeFieldContainer[Joint]
    links: _containers.RepeatedCompositeFieldContainer[Link]
    root: int
    self_pairs: _containers.RepeatedCompositeFieldContainer[LinkPair]
    excluded_pairs: _containers.RepeatedCompositeFieldContainer[ExcludedPair]
    groups: _containers.RepeatedCompositeFieldContainer[JointGroup]
    def __init__(self, id: _Optional[str] = ..., name: _Optional[str] = ..., degrees_of_freedom: _Optional[int] = ..., joints: _Optional[_Iterable[_Union[Joint, _Mapping]]] = ..., links: _Optional[_Iterable[_Union[Link, _Mapping]]] = ..., root: _Optional[int] = ..., self_pairs: _Optional[_Iterable[_Union[LinkPair, _Mapping]]] = ..., excluded_pairs: _Optional[_Iterable[_Union[ExcludedPair, _Mapping]]] = ..., groups: _Optional[_Iterable[_Union[JointGroup, _Mapping]]] = ...) -> None: ...

class Joint(_message.Message):
    __slots__ = ("name", "kind", "first", "width", "lower", "upper", "parent", "child")
    NAME_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    FIRST_FIELD_NUMBER: _ClassVar[int]
    WIDTH_FIELD_NUMBER: _ClassVar[int]
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    PARENT_FIELD_NUMBER: _ClassVar[int]
    CHILD_FIELD_NUMBER: _ClassVar[int]
    name: str
    kind: JointKind
    first: int
    width: int
    lower: float
    upper: float
    parent: int
    child: int
    def __init__(self, name: _Optional[str] = ..., kind: _Optional[_Union[JointKind, str]] = ..., first: _Optional[int] = ..., width: _Optional[int] = ..., lower: _Optional[float] = ..., upper: _Optional[float] = ..., parent: _Optional[int] = ..., child: _Optional[int] = ...) -> None: ...

class Link(_message.Message):
    __slots__ = ("name", "shapes")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SHAPES_FIELD_NUMBER: _ClassVar[int]
    name: str
    shapes: int
    def __init__(self, name: _Optional[str] = ..., shapes: _Optional[int] = ...) -> None: ...

class LinkPair(_message.Message):
    __slots__ = ("a", "b")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    a: int
    b: int
    def __init__(self, a: _Optional[int] = ..., b: _Optional[int] = ...) -> None: ...

class ExcludedPair(_message.Message):
    __slots__ = ("a", "b", "reason")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    a: int
    b: int
    reason: str
    def __init__(self, a: _Optional[int] = ..., b: _Optional[int] = ..., reason: _Optional[str] = ...) -> None: ...

class JointGroup(_message.Message):
    __slots__ = ("name", "joints", "links", "states")
    NAME_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    LINKS_FIELD_NUMBER: _ClassVar[int]
    STATES_FIELD_NUMBER: _ClassVar[int]
    name: str
    joints: _containers.RepeatedScalarFieldContainer[int]
    links: _containers.RepeatedScalarFieldContainer[int]
    states: _containers.RepeatedCompositeFieldContainer[NamedState]
    def __init__(self, name: _Optional[str] = ..., joints: _Optional[_Iterable[int]] = ..., links: _Optional[_Iterable[int]] = ..., states: _Optional[_Iterable[_Union[NamedState, _Mapping]]] = ...) -> None: ...

class NamedState(_message.Message):
    __slots__ = ("name", "positions")
    NAME_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    name: str
    positions: _containers.RepeatedCompositeFieldContainer[JointPositions]
    def __init__(self, name: _Optional[str] = ..., positions: _Optional[_Iterable[_Union[JointPositions, _Mapping]]] = ...) -> None: ...

class JointPositions(_message.Message):
    __slots__ = ("joint", "values")
    JOINT_FIELD_NUMBER: _ClassVar[int]
    VALUES_FIELD_NUMBER: _ClassVar[int]
    joint: int
    values: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, joint: _Optional[int] = ..., values: _Optional[_Iterable[float]] = ...) -> None: ...
