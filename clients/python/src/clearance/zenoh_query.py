"""One query to the daemon, and what comes of it."""

from __future__ import annotations

import threading
from typing import Callable, NamedTuple, Optional, Union

import grpc
import zenoh

from .errors import code_of, details_of
from .v1 import service_pb2 as service


class _Entry(NamedTuple):
    """Of trailing metadata."""

    key: str
    value: str


class CallError(grpc.RpcError):
    """What a call ended with; it is read as gRPC's own errors are."""

    def __init__(self, told: service.QueryError):
        super().__init__(f"{code_of(told).name}: {told.message}")
        self.told = told

    @classmethod
    def of(cls, code: grpc.StatusCode, message: str) -> CallError:
        return cls(service.QueryError(code=code.value[0], message=message))

    def code(self) -> grpc.StatusCode:
        return code_of(self.told)

    def details(self) -> str:
        return self.told.message

    def trailing_metadata(self) -> tuple[_Entry, ...]:
        return tuple(_Entry(key, value) for key, value in details_of(self.told).items())


#: A reply, why there is none, or the end of the replies.
Outcome = Union[bytes, CallError, None]


class Caller:
    """A name for queries. When it leaves, the daemon stops to work on them; one that nobody holds any more leaves, too."""

    def __init__(self, session: zenoh.Session, root: str, name: str):
        self.name = name
        self._lock = threading.Lock()
        self._token: Optional[zenoh.LivelinessToken] = session.liveliness().declare_token(f"{root}/client/{name}")

    def leave(self) -> None:
        with self._lock:
            token, self._token = self._token, None
        if token is not None:
            token.undeclare()


class Query:
    """A query that is under way. What comes of it is given to `take` by one of zenoh's threads, which must not wait; the last is
    None, after at least one reply or error."""

    def __init__(
        self, session: zenoh.Session, selector: str, body: bytes, lasts: float, unreached: str, take: Callable[[Outcome], None]
    ):
        """`lasts`: seconds after which zenoh ends it. `unreached`: what is said when nobody replied at all."""
        self._take = take
        self._unreached = unreached
        self._replied = False
        self._cancelled = False
        self._cancellation = zenoh.CancellationToken()
        session.get(
            selector,
            zenoh.handlers.Callback(self._reply, self._end, indirect=False),
            payload=body,
            encoding=zenoh.Encoding.APPLICATION_PROTOBUF,
            timeout=lasts,
            # Replies are all of one key: otherwise the last would take the place of the others.
            consolidation=zenoh.ConsolidationMode.NONE,
            congestion_control=zenoh.CongestionControl.BLOCK,
            express=True,
            cancellation_token=self._cancellation,
        )

    def cancel(self) -> None:
        """Ends it here. The daemon is not told; that is what its :class:`Caller` is for."""
        self._cancelled = True
        self._cancellation.cancel()

    def _reply(self, reply: zenoh.Reply) -> None:
        self._replied = True
        self._take(_refusal(reply.err) if reply.ok is None else reply.ok.payload.to_bytes())

    def _end(self) -> None:
        if self._cancelled:
            self._take(CallError.of(grpc.StatusCode.CANCELLED, "the caller listens no longer"))
        elif not self._replied:
            self._take(CallError.of(grpc.StatusCode.UNAVAILABLE, self._unreached))
        self._take(None)


def _refusal(error: zenoh.ReplyError) -> CallError:
    body = error.payload.to_bytes()
    if error.encoding == zenoh.Encoding.APPLICATION_PROTOBUF:
        return CallError(service.QueryError.FromString(body))
    # Zenoh's own words.
    if body == b"Timeout":
        return CallError.of(grpc.StatusCode.DEADLINE_EXCEEDED, "no answer came in time")
    return CallError.of(grpc.StatusCode.UNAVAILABLE, body.decode(errors="replace"))
