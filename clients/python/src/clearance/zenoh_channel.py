"""The daemon's zenoh door as a channel: generated stubs call through it as they do through gRPC's.

docs/zenoh.md says which keys there are and what is sent. A channel has one session, and may be used by any thread.
"""

from __future__ import annotations

import itertools
import json
import queue
import secrets
from pathlib import Path
from typing import Any, Callable, Iterable, Optional, Sequence
from urllib.parse import quote

import grpc
import zenoh
import zenoh.ext

from .errors import Unavailable
from .inbox import Inbox
from .robots import PathLike
from .zenoh_query import Caller, CallError, Outcome, Query
from .zenoh_questions import Questions

#: A query lasts so much longer than the daemon may work on it, seconds: what the daemon says when time is up is to arrive.
_GRACE = 0.5
#: How long a query without a timeout lasts, seconds. The daemon ends it sooner, after its `max_deadline_seconds`.
_ENDLESS = 7 * 24 * 3600.0

Metadata = Sequence[tuple[str, str]]


class ZenohChannel:
    """A session with the daemon of a prefix. It has what generated stubs need of a `grpc.Channel`, and what zenoh has beside calls."""

    def __init__(self, endpoint: str, prefix: str, config: Optional[PathLike] = None):
        """Connects, and raises :class:`Unavailable` if nobody is there. `config` is a file of zenoh's own configuration (JSON5)."""
        if not _is_plain_key(prefix):
            raise ValueError(f"zenoh_prefix: {prefix!r} is no key without wildcards")
        configuration = _configuration(endpoint, config)
        try:
            self._session = zenoh.open(configuration)
        except zenoh.ZError as error:
            raise Unavailable("UNAVAILABLE", f"UNAVAILABLE: {endpoint}: {error}", {}) from None
        self._root = f"{prefix}/v1"
        self._id = secrets.token_hex(16)
        self._callers = itertools.count()
        self._caller = Caller(self._session, self._root, self._id)
        self._unreached = f"no daemon with the prefix {prefix!r} was reached through {endpoint}"

    def close(self) -> None:
        """Ends whatever is under way."""
        self._session.close()

    # What generated stubs call.

    def unary_unary(
        self, method: str, request_serializer: Callable[[Any], bytes], response_deserializer: Callable[[bytes], Any], **_: Any
    ) -> Callable[..., Any]:
        def call(request: Any, timeout: Optional[float] = None, metadata: Metadata = (), **_: Any) -> Any:
            return response_deserializer(self._answer(_rpc(method), request_serializer(request), timeout, metadata))

        return call

    def stream_unary(
        self, method: str, request_serializer: Callable[[Any], bytes], response_deserializer: Callable[[bytes], Any], **_: Any
    ) -> Callable[..., Any]:
        def call(requests: Iterable[Any], timeout: Optional[float] = None, metadata: Metadata = (), **_: Any) -> Any:
            body = b"".join(_behind_length(request_serializer(request)) for request in requests)
            return response_deserializer(self._answer(_rpc(method), body, timeout, metadata))

        return call

    def unary_stream(
        self, method: str, request_serializer: Callable[[Any], bytes], response_deserializer: Callable[[bytes], Any], **_: Any
    ) -> Callable[..., Any]:
        def call(request: Any, timeout: Optional[float] = None, metadata: Metadata = (), **_: Any) -> Replies:
            return Replies(self, _rpc(method), request_serializer(request), response_deserializer, timeout, metadata)

        return call

    def stream_stream(self, method: str, *_: Any, **__: Any) -> Callable[..., Any]:
        rpc = _rpc(method)

        def call(requests: Iterable[Any], timeout: Optional[float] = None, metadata: Metadata = (), **_: Any) -> Questions:
            if rpc == "Queries/QueryStream":
                return Questions(self, requests, timeout, metadata)
            instead = "; Scene.put_poses and Scene.poses_told do the same" if rpc == "Scenes/PoseStream" else ""
            raise CallError.of(grpc.StatusCode.UNIMPLEMENTED, f"{rpc} has no form through zenoh{instead}")

        return call

    def _answer(self, rpc: str, body: bytes, timeout: Optional[float], metadata: Metadata) -> bytes:
        arrived: queue.SimpleQueue[Outcome] = queue.SimpleQueue()
        self.ask(rpc, body, arrived.put, timeout=timeout, metadata=metadata)
        outcome = arrived.get()
        if isinstance(outcome, CallError):
            raise outcome
        assert outcome is not None, "the end comes after a reply or an error"
        return outcome

    # What the other modules need.

    def caller(self) -> Caller:
        """A name for queries that are to end before the channel does."""
        return Caller(self._open_session(), self._root, f"{self._id}/{next(self._callers)}")

    def ask(
        self,
        rpc: str,
        body: bytes,
        take: Callable[[Outcome], None],
        *,
        timeout: Optional[float] = None,
        metadata: Metadata = (),
        caller: Optional[Caller] = None,
        steps: Optional[int] = None,
    ) -> Query:
        """Begins a call; see :class:`Query` for `take`. Without a `timeout`, in seconds, it lasts as long as the daemon lets it."""
        parameters = {"client": (caller or self._caller).name}
        if timeout is not None:
            if timeout <= 0:
                raise CallError.of(grpc.StatusCode.DEADLINE_EXCEEDED, "the time was up before anything was sent")
            parameters["timeout"] = str(float(timeout))
        if steps is not None:
            parameters["steps"] = str(steps)
        parameters.update((key, value) for key, value in metadata or () if key == "traceparent")
        selector = f"{self._root}/call/{rpc}?" + ";".join(f"{name}={value}" for name, value in parameters.items())
        lasts = _ENDLESS if timeout is None else min(timeout, _ENDLESS) + _GRACE
        return Query(self._open_session(), selector, body, lasts, self._unreached, take)

    def put(self, scene: str, what: str, body: bytes) -> None:
        """Puts a message under a key of a scene."""
        self._open_session().put(
            self._scene_key(scene, what),
            body,
            encoding=zenoh.Encoding.APPLICATION_PROTOBUF,
            congestion_control=zenoh.CongestionControl.BLOCK,
            express=True,
        )

    def hear(
        self, scene: str, what: str, take: Callable[[str, bytes], None], ended: Callable[[], None]
    ) -> zenoh.Subscriber:
        """Gives what is told under keys of a scene to `take`, with the key's last part, until it is undeclared or the channel is
        closed; then `ended` is called."""

        def taken(sample: zenoh.Sample) -> None:
            take(str(sample.key_expr).rpartition("/")[2], sample.payload.to_bytes())

        handler = zenoh.handlers.Callback(taken, ended, indirect=False)
        return self._open_session().declare_subscriber(self._scene_key(scene, what), handler)

    def hear_numbered(
        self, scene: str, what: str, take: Callable[[bytes, str, int], None], ended: Callable[[], None]
    ) -> zenoh.ext.AdvancedSubscriber:
        """As :meth:`hear`, with what got lost recovered as far as the daemon keeps it, and with each message's source and number
        (modulo 2³²): what is missing still shows."""

        def taken(sample: zenoh.Sample) -> None:
            source = sample.source_info
            assert source is not None, "advanced publishers number what they publish"
            take(sample.payload.to_bytes(), str(source.source_id), source.source_sn)

        return zenoh.ext.declare_advanced_subscriber(
            self._open_session(),
            self._scene_key(scene, what),
            zenoh.handlers.Callback(taken, ended, indirect=False),
            recovery=zenoh.ext.RecoveryConfig(heartbeat=True, periodic_queries=None),
        )

    def tokens(self, scene: str, take: Callable[[str, bool], None]) -> list[zenoh.Subscriber]:
        """Tells by their keys which of the daemon's and the scene's tokens are there, and as they come and go. To be undeclared."""

        def taken(sample: zenoh.Sample) -> None:
            take(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        liveliness = self._open_session().liveliness()
        return [
            # What was there before is told, too: of what it does not know, zenoh does not tell that it goes.
            liveliness.declare_subscriber(key, zenoh.handlers.Callback(taken, indirect=False), history=True)
            for key in (f"{self._root}/alive", self._scene_key(scene, "alive"))
        ]

    def _scene_key(self, scene: str, what: str) -> str:
        return f"{self._root}/scene/{quote(scene, safe='')}/{what}"

    def _open_session(self) -> zenoh.Session:
        if self._session.is_closed():
            raise ValueError("the client is closed")
        return self._session


class Replies:
    """What is told to one query of those that go on until there is an error: messages in the order of their arrival."""

    def __init__(
        self,
        channel: ZenohChannel,
        rpc: str,
        body: bytes,
        deserialize: Callable[[bytes], Any],
        timeout: Optional[float],
        metadata: Metadata,
    ):
        slow = CallError.of(grpc.StatusCode.RESOURCE_EXHAUSTED, "the reader is too slow for what arrives")
        arrived: Inbox[Outcome] = Inbox(slow)
        self._arrived = arrived
        self._deserialize = deserialize
        self._ended = False
        self._caller = channel.caller()

        # Knows nothing of `self`: who forgets the replies leaves.
        def take(outcome: Outcome) -> None:
            arrived.put(outcome, len(outcome) if isinstance(outcome, bytes) else 0)

        self._query = channel.ask(rpc, body, take, timeout=timeout, metadata=metadata, caller=self._caller)

    def __iter__(self) -> Replies:
        return self

    def __next__(self) -> Any:
        if self._ended:
            raise StopIteration
        outcome = self._arrived.take()
        if isinstance(outcome, bytes):
            return self._deserialize(outcome)
        self._ended = True
        self.cancel()
        raise outcome or CallError.of(grpc.StatusCode.UNAVAILABLE, "the connection to the daemon was lost")

    def cancel(self) -> bool:
        """The daemon stops, and a reader that waits is woken. True, as of gRPC's calls."""
        self._caller.leave()
        self._query.cancel()
        return True


def _rpc(method: str) -> str:
    """`/clearance.v1.Scenes/Apply` is `Scenes/Apply`."""
    service, name = method.removeprefix("/").split("/")
    return f"{service.rpartition('.')[2]}/{name}"


def _behind_length(body: bytes) -> bytes:
    """The message behind its length as a varint."""
    head = bytearray()
    rest = len(body)
    while rest > 0x7F:
        head.append(rest & 0x7F | 0x80)
        rest >>= 7
    head.append(rest)
    return bytes(head) + body


def _is_plain_key(text: str) -> bool:
    try:
        zenoh.KeyExpr(text)
    except zenoh.ZError:
        return False
    return "*" not in text


def _configuration(endpoint: str, file: Optional[PathLike]) -> zenoh.Config:
    configuration = zenoh.Config()
    if file is not None:
        try:
            configuration = zenoh.Config.from_json5(Path(file).read_text(encoding="utf-8"))
        except zenoh.ZError as error:
            raise ValueError(f"zenoh_config: {file}: {error}") from None
    if json.loads(configuration.get_json("mode")) is None:
        configuration.insert_json5("mode", '"client"')
    try:
        configuration.insert_json5("connect/endpoints", json.dumps([endpoint]))
    except zenoh.ZError:
        raise ValueError(f"{endpoint!r} is no endpoint of zenoh such as tcp/127.0.0.1:50552") from None
    # Nobody is looked for.
    configuration.insert_json5("scouting/multicast/enabled", "false")
    configuration.insert_json5("scouting/gossip/enabled", "false")
    # The daemon does without zenoh's own shared memory, which leaves files behind where a process is killed.
    configuration.insert_json5("transport/shared_memory/enabled", "false")
    return configuration
