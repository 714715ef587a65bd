from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Overlay(_message.Message):
    __slots__ = ("edits", "attached")
    EDITS_FIELD_NUMBER: _ClassVar[int]
    ATTACHED_FIELD_NUMBER: _ClassVar[int]
    edits: _containers.RepeatedCompositeFieldContainer[_scene_pb2.Edit]
    attached: _containers.RepeatedCompositeFieldContainer[AttachBody]
    def __init__(self, edits: _Optional[_Iterable[_Union[_scene_pb2.Edit, _Mapping]]] = ..., attached: _Optional[_Iterable[_Union[AttachBody, _Mapping]]] = ...) -> None: ...

class AttachBody(_message.Message):
    __slots__ = ("body", "link", "body_in_link", "may_touch")
    BODY_FIELD_NUMBER: _ClassVar[int]
    LINK_FIELD_NUMBER: _ClassVar[int]
    BODY_IN_LINK_FIELD_NUMBER: _ClassVar[int]
    MAY_TOUCH_FIELD_NUMBER: _ClassVar[int]
    body: _scene_pb2.BodyRef
    link: _scene_pb2.LinkRef
    body_in_link: _geometry_pb2.Pose
    may_touch: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, body: _Optional[_Union[_scene_pb2.BodyRef, _Mapping]] = ..., link: _Optional[_Union[_scene_pb2.LinkRef, _Mapping]] = ..., body_in_link: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., may_touch: _Optional[_Iterable[str]] = ...) -> None: ...

class AddedBody(_message.Message):
    __slots__ = ("overlay", "id", "name")
    OVERLAY_FIELD_NUMBER: _ClassVar[int]
    ID_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    overlay: int
    id: int
    name: str
    def __init__(self, overlay: _Optional[int] = ..., id: _Optional[int] = ..., name: _Optional[str] = ...) -> None: ...
