from clearance.v1 import query_pb2 as _query_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class ContactThreshold(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CONTACT_THRESHOLD_UNSPECIFIED: _ClassVar[ContactThreshold]
    CONTACT_THRESHOLD_TOUCHING: _ClassVar[ContactThreshold]
    CONTACT_THRESHOLD_MARGIN: _ClassVar[ContactThreshold]

class ContactEventKind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CONTACT_EVENT_KIND_UNSPECIFIED: _ClassVar[ContactEventKind]
    CONTACT_EVENT_KIND_BEGIN: _ClassVar[ContactEventKind]
    CONTACT_EVENT_KIND_STAY: _ClassVar[ContactEventKind]
    CONTACT_EVENT_KIND_END: _ClassVar[ContactEventKind]
    CONTACT_EVENT_KIND_UNDECIDED: _ClassVar[ContactEventKind]

class ContactState(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CONTACT_STATE_UNSPECIFIED: _ClassVar[ContactState]
    CONTACT_STATE_APART: _ClassVar[ContactState]
    CONTACT_STATE_UNDECIDED: _ClassVar[ContactState]
    CONTACT_STATE_CONTACT: _ClassVar[ContactState]

class ContactEndReason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CONTACT_END_REASON_UNSPECIFIED: _ClassVar[ContactEndReason]
    CONTACT_END_REASON_REMOVED: _ClassVar[ContactEndReason]
    CONTACT_END_REASON_DISABLED: _ClassVar[ContactEndReason]
    CONTACT_END_REASON_NOT_A_PAIR: _ClassVar[ContactEndReason]
    CONTACT_END_REASON_APART: _ClassVar[ContactEndReason]
CONTACT_THRESHOLD_UNSPECIFIED: ContactThreshold
CONTACT_THRESHOLD_TOUCHING: ContactThreshold
CONTACT_THRESHOLD_MARGIN: ContactThreshold
CONTACT_EVENT_KIND_UNSPECIFIED: ContactEventKind
CONTACT_EVENT_KIND_BEGIN: ContactEventKind
CONTACT_EVENT_KIND_STAY: ContactEventKind
CONTACT_EVENT_KIND_END: ContactEventKind
CONTACT_EVENT_KIND_UNDECIDED: ContactEventKind
CONTACT_STATE_UNSPECIFIED: ContactState
CONTACT_STATE_APART: ContactState
CONTACT_STATE_UNDECIDED: ContactState
CONTACT_STATE_CONTACT: ContactState
CONTACT_END_REASON_UNSPECIFIED: ContactEndReason
CONTACT_END_REASON_REMOVED: ContactEndReason
CONTACT_END_REASON_DISABLED: ContactEndReason
CONTACT_END_REASON_NOT_A_PAIR: ContactEndReason
CONTACT_END_REASON_APART: ContactEndReason

class WatchContactsRequest(_message.Message):
    __slots__ = ("context", "threshold", "stays")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    THRESHOLD_FIELD_NUMBER: _ClassVar[int]
    STAYS_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    threshold: ContactThreshold
    stays: bool
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., threshold: _Optional[_Union[ContactThreshold, str]] = ..., stays: bool = ...) -> None: ...

class WatchContactsResponse(_message.Message):
    __slots__ = ("epoch", "from_revision", "revision", "events", "more", "contacts", "undecided", "cost", "coverage")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    FROM_REVISION_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    EVENTS_FIELD_NUMBER: _ClassVar[int]
    MORE_FIELD_NUMBER: _ClassVar[int]
    CONTACTS_FIELD_NUMBER: _ClassVar[int]
    UNDECIDED_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    COVERAGE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    from_revision: int
    revision: int
    events: _containers.RepeatedCompositeFieldContainer[ContactEvent]
    more: bool
    contacts: int
    undecided: int
    cost: _query_pb2.Cost
    coverage: _scene_pb2.Coverage
    def __init__(self, epoch: _Optional[int] = ..., from_revision: _Optional[int] = ..., revision: _Optional[int] = ..., events: _Optional[_Iterable[_Union[ContactEvent, _Mapping]]] = ..., more: bool = ..., contacts: _Optional[int] = ..., undecided: _Optional[int] = ..., cost: _Optional[_Union[_query_pb2.Cost, _Mapping]] = ..., coverage: _Optional[_Union[_scene_pb2.Coverage, _Mapping]] = ...) -> None: ...

class ContactEvent(_message.Message):
    __slots__ = ("a", "b", "kind", "before", "after", "reason", "pair")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    BEFORE_FIELD_NUMBER: _ClassVar[int]
    AFTER_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    PAIR_FIELD_NUMBER: _ClassVar[int]
    a: int
    b: int
    kind: ContactEventKind
    before: ContactState
    after: ContactState
    reason: ContactEndReason
    pair: _query_pb2.PairAnswer
    def __init__(self, a: _Optional[int] = ..., b: _Optional[int] = ..., kind: _Optional[_Union[ContactEventKind, str]] = ..., before: _Optional[_Union[ContactState, str]] = ..., after: _Optional[_Union[ContactState, str]] = ..., reason: _Optional[_Union[ContactEndReason, str]] = ..., pair: _Optional[_Union[_query_pb2.PairAnswer, _Mapping]] = ...) -> None: ...
