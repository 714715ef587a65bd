"""What can go wrong with a request. Geometry never does: it is a verdict."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import Iterator, Optional

import grpc

from .v1 import service_pb2 as service


class ClearanceError(Exception):
    """A request was refused or could not be delivered.

    The daemon says which part of the request it means; whatever it did not say is None.
    """

    def __init__(self, code: str, message: str, details: dict[str, str]):
        super().__init__(message)
        #: gRPC's name of the kind of error, for example `INVALID_ARGUMENT`.
        self.code = code
        #: The reason for programs, for example `INVALID_FIELD`; see `ErrorReason` in service.proto.
        self.reason: Optional[str] = details.get("clearance-reason")
        #: The field that cannot be as it is, for example `items[3].shape.box.half_extents.x`.
        self.field: Optional[str] = details.get("clearance-field")
        #: Of a list of edits, subjects or the like: which element the field is in.
        self.item: Optional[int] = _item(self.field)
        #: The cap that was hit, how much was asked, how much is allowed.
        self.limit: Optional[str] = details.get("clearance-limit")
        self.asked: Optional[int] = _number(details.get("clearance-asked"))
        self.allowed: Optional[int] = _number(details.get("clearance-allowed"))
        #: When the limit lets this client in again, seconds.
        self.retry_after: Optional[float] = _seconds(details.get("clearance-retry-after-ms"))
        #: The scope that the token lacks, `read` or `write`.
        self.scope: Optional[str] = details.get("clearance-scope")
        #: The scene as it is now, where it is not as was expected.
        self.epoch: Optional[int] = _number(details.get("clearance-epoch"))
        self.revision: Optional[int] = _number(details.get("clearance-revision"))
        self.oldest_revision: Optional[int] = _number(details.get("clearance-oldest-revision"))


class InvalidRequest(ClearanceError):
    """A field cannot be as it is; `field` and `item` say which."""


class NotFound(ClearanceError):
    """A scene, body, robot, model, asset or group is not there."""


class Conflict(ClearanceError):
    """The scene is not as the request needs it: a taken name, an edit that does not fit, another revision or epoch."""


class RevisionGone(ClearanceError):
    """The revision asked for is not kept any more; `oldest_revision` is."""


class LimitExceeded(ClearanceError):
    """A cap of the daemon; `limit`, `asked` and `allowed` say which, `retry_after` when to ask again if time helps."""


class NotAllowed(ClearanceError):
    """The daemon wants a token, does not know this one, or it lacks `scope`; `reason` says which."""


class DeadlineExceeded(ClearanceError):
    """Nothing could be answered in time."""


class Unavailable(ClearanceError):
    """No daemon there, one that shuts down, or a revision that did not come in time."""


_KINDS: dict[grpc.StatusCode, type[ClearanceError]] = {
    grpc.StatusCode.INVALID_ARGUMENT: InvalidRequest,
    grpc.StatusCode.NOT_FOUND: NotFound,
    grpc.StatusCode.ALREADY_EXISTS: Conflict,
    grpc.StatusCode.FAILED_PRECONDITION: Conflict,
    grpc.StatusCode.ABORTED: Conflict,
    grpc.StatusCode.OUT_OF_RANGE: RevisionGone,
    grpc.StatusCode.RESOURCE_EXHAUSTED: LimitExceeded,
    grpc.StatusCode.DEADLINE_EXCEEDED: DeadlineExceeded,
    grpc.StatusCode.UNAUTHENTICATED: NotAllowed,
    grpc.StatusCode.PERMISSION_DENIED: NotAllowed,
    grpc.StatusCode.UNAVAILABLE: Unavailable,
}


_BY_NUMBER: dict[int, grpc.StatusCode] = {code.value[0]: code for code in grpc.StatusCode}


def code_of(error: service.QueryError) -> grpc.StatusCode:
    """gRPC's name of the kind of error."""
    return _BY_NUMBER.get(error.code, grpc.StatusCode.UNKNOWN)


def details_of(error: service.QueryError) -> dict[str, str]:
    """What a call's trailing metadata would have had."""
    if not error.reason:
        return dict(error.details)
    reason = service.ErrorReason.Name(error.reason).removeprefix("ERROR_REASON_")
    return {**error.details, "clearance-reason": reason}


def refused(error: service.QueryError) -> ClearanceError:
    """The error of one question of a stream: as a call of its own would have raised."""
    code = code_of(error)
    return _KINDS.get(code, ClearanceError)(code.name, f"{code.name}: {error.message}", details_of(error))


@contextmanager
def translated() -> Iterator[None]:
    """Turns gRPC's errors into those of this module."""
    try:
        yield
    except grpc.RpcError as error:
        code = error.code()
        metadata = error.trailing_metadata() or ()
        details = {entry.key: entry.value for entry in metadata if isinstance(entry.value, str)}
        kind = _KINDS.get(code, ClearanceError)
        raise kind(code.name, f"{code.name}: {error.details()}", details) from None


def _item(field: Optional[str]) -> Optional[int]:
    found = re.match(r"\w+\[(\d+)\]", field or "")
    return int(found.group(1)) if found else None


def _number(text: Optional[str]) -> Optional[int]:
    return int(text) if text is not None and text.isdecimal() else None


def _seconds(milliseconds: Optional[str]) -> Optional[float]:
    number = _number(milliseconds)
    return None if number is None else number / 1000.0
