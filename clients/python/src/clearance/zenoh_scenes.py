"""What zenoh tells of a scene to everybody who listens: its steps, and what became of poses."""

from __future__ import annotations

import queue
import threading
from collections import deque
from types import TracebackType
from typing import TYPE_CHECKING, Any, Optional, Union

import grpc

from .errors import ClearanceError, LimitExceeded, refused
from .inbox import Inbox
from .streams import PosesMade, SceneCopy
from .v1 import service_pb2 as service
from .v1 import stream_pb2 as messages
from .zenoh_query import CallError, Outcome, Query

if TYPE_CHECKING:
    from .zenoh_channel import ZenohChannel

#: After a daemon was not reached, it is asked again after so long, seconds.
_PAUSE = 1.0

#: What waits for the reader: a function and what it is given.
_Event = tuple[Any, ...]


class Following:
    """The messages of `Watch` that lead a copy on, made of what the daemon tells everybody and, where something is missing, of what
    the scene's log answers. Iterated by one thread; :meth:`cancel` may be called by any.

    Everything that arrives waits in one inbox; the reader takes a step if it leads on from where the copy is. The log is asked at the
    beginning, when a step does not fit, and when the daemon or the scene comes or goes. A publication that begins tells where it
    begins, so that a step made between the log's answer and the beginning is not missed.
    """

    def __init__(self, channel: ZenohChannel, scene: str, copy: Optional[SceneCopy]):
        self._channel = channel
        self._scene = scene
        #: Epoch and revision of the copy.
        self._at = None if copy is None else (copy.epoch, copy.revision)
        self._ready: deque[messages.WatchResponse] = deque()
        self._inbox: Inbox[_Event] = Inbox((self._on_loss,))
        # Of what is told: the last message's source and number, and what has come of a step.
        self._last: Optional[tuple[str, int]] = None
        self._told_step: list[messages.WatchResponse] = []
        self._skips = False
        #: Epoch and revision of the newest step that was told and did not fit.
        self._missed: Optional[tuple[int, int]] = None
        # Of the log: queries by number, of which only the last counts.
        self._lock = threading.Lock()
        self._closed = False
        self._asked = 0
        self._query: Optional[Query] = None
        self._answered_step: list[messages.WatchResponse] = []
        self._was_answered = False
        self._ask_again_in: Optional[float] = None
        #: Keys of tokens that were seen.
        self._tokens: set[str] = set()
        self._subscriptions = [
            channel.hear_numbered(scene, "changes", self._tell, self._end),
            *channel.tokens(scene, lambda key, there: self._inbox.put((self._on_token, key, there))),
        ]
        self._ask()

    def __iter__(self) -> Following:
        return self

    def __next__(self) -> messages.WatchResponse:
        while not self._ready:
            if self._closed:
                raise StopIteration
            try:
                handle, *given = self._inbox.take(self._ask_again_in)
            except queue.Empty:
                handle, given = self._ask, []
            handle(*given)
        return self._ready.popleft()

    def cancel(self) -> bool:
        """Listens no longer. True, as of gRPC's calls."""
        with self._lock:
            self._closed = True
            self._give_up()
            subscriptions, self._subscriptions = self._subscriptions, []
        for subscription in subscriptions:
            subscription.undeclare()
        return True

    def _end(self) -> None:
        self._closed = True
        self._inbox.put((lambda: None,))

    # What is told.

    def _tell(self, body: bytes, source: str, number: int) -> None:
        self._inbox.put((self._on_told, body, source, number), len(body))

    def _on_told(self, body: bytes, source: str, number: int) -> None:
        message = messages.WatchResponse.FromString(body)
        if self._last is None:
            # This may be the middle of a step; but then the log's answer leads at least as far.
            self._skips = self._query is not None
        elif (source, number) != (self._last[0], (self._last[1] + 1) % (1 << 32)):
            self._told_step.clear()
            self._skips = True
        self._last = (source, number)
        self._told_step.append(message)
        if message.more:
            return
        step, self._told_step = self._told_step, []
        skips, self._skips = self._skips, False
        if self._is_old(message) or (not skips and self._lead_on(step)):
            return
        self._missed = (message.epoch, message.revision)
        if self._query is None:
            self._ask()

    def _on_token(self, key: str, there: bool) -> None:
        if there and key not in self._tokens:
            # It was there before.
            self._tokens.add(key)
        else:
            self._ask()

    def _on_loss(self) -> None:
        """What arrived was too much for the inbox, be it told or answered."""
        self._last = None
        self._told_step.clear()
        self._ask()

    # What the log answers.

    def _ask(self) -> None:
        request = messages.WatchRequest(scene=self._scene, shapes=True)
        if self._at is not None:
            request.epoch, request.from_revision = self._at
        with self._lock:
            if self._closed:
                return
            self._give_up()
            number = self._asked

            def take(outcome: Outcome) -> None:
                self._inbox.put((self._on_answer, number, outcome), len(outcome) if isinstance(outcome, bytes) else 0)

            self._query = self._channel.ask("Scenes/Watch", request.SerializeToString(), take, steps=1)

    def _give_up(self) -> None:
        """Whatever is under way is not waited for any more. Under the lock."""
        self._asked += 1
        self._answered_step.clear()
        self._ask_again_in = None
        query, self._query = self._query, None
        if query is not None:
            query.cancel()

    def _on_answer(self, number: int, outcome: Outcome) -> None:
        if number != self._asked:
            return
        if isinstance(outcome, bytes):
            message = messages.WatchResponse.FromString(outcome)
            self._answered_step.append(message)
            if not message.more:
                step, self._answered_step = self._answered_step, []
                self._was_answered = True
                self._lead_on(step)
            return
        with self._lock:
            self._give_up()
        if isinstance(outcome, CallError):
            self._on_refusal(outcome)
        elif self._is_behind():
            self._ask()

    def _on_refusal(self, error: CallError) -> None:
        if error.told.reason == service.ERROR_REASON_WRONG_EPOCH:
            # Another life of the scene.
            self._at = None
            self._ask()
        elif self._was_answered and error.code() in (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.DEADLINE_EXCEEDED):
            # The daemon's token tells when it is back, but the way to it may come after that.
            self._ask_again_in = _PAUSE
        else:
            self.cancel()
            raise error

    # Where the copy is.

    def _lead_on(self, step: list[messages.WatchResponse]) -> bool:
        """Takes a step if it leads on from where the copy is."""
        first, last = step[0], step[-1]
        if self._is_old(last):
            return False
        if first.HasField("from_revision") and self._at != (last.epoch, first.from_revision):
            return False
        self._ready.extend(step)
        self._at = (last.epoch, last.revision)
        return True

    def _is_old(self, message: messages.WatchResponse) -> bool:
        return self._at is not None and message.epoch == self._at[0] and message.revision <= self._at[1]

    def _is_behind(self) -> bool:
        """Whether a step that did not fit is still missing."""
        if self._missed is None or self._at is None:
            return False
        return self._missed[0] == self._at[0] and self._missed[1] > self._at[1]


class PosesTold:
    """What became of poses that were put for a scene, by anybody. Use it in a `with` statement, or close it.

    Iterates over :class:`PosesMade`, and over a :class:`ClearanceError` for each put that could not be taken at all.
    """

    def __init__(self, channel: ZenohChannel, scene: str):
        slow = LimitExceeded("RESOURCE_EXHAUSTED", "RESOURCE_EXHAUSTED: the reader is too slow; some is lost here", {})
        self._inbox: Inbox[Union[tuple[str, bytes], ClearanceError, None]] = Inbox(slow)
        self._closed = False
        self._lock = threading.Lock()
        self._subscription: Any = channel.hear(scene, "poses/*", self._take, self._end)

    def __enter__(self) -> PosesTold:
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()

    def __iter__(self) -> PosesTold:
        return self

    def __next__(self) -> Union[PosesMade, ClearanceError]:
        while not self._closed:
            told = self._inbox.take()
            if isinstance(told, ClearanceError):
                return told
            if told is None:
                continue
            kind, body = told
            if kind == "made":
                return PosesMade.of(messages.PoseStreamResponse.FromString(body))
            if kind == "refused":
                return refused(service.QueryError.FromString(body))
        raise StopIteration

    def close(self) -> None:
        """Ends the iteration; may be called by another thread while this one waits."""
        with self._lock:
            subscription, self._subscription = self._subscription, None
        if subscription is not None:
            subscription.undeclare()

    def _take(self, kind: str, body: bytes) -> None:
        self._inbox.put((kind, body), len(body))

    def _end(self) -> None:
        self._closed = True
        self._inbox.put(None)
