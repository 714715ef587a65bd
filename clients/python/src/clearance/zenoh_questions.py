"""`QueryStream` through zenoh: every question is a query of its own, several at a time."""

from __future__ import annotations

import queue
import threading
import time
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Optional, Union

import grpc

from .v1 import service_pb2 as service
from .zenoh_query import CallError, Outcome

if TYPE_CHECKING:
    from .zenoh_channel import Metadata, ZenohChannel

#: Questions that are under way at a time unless the options say otherwise; `max_stream_in_flight` of a daemon that is told nothing.
_IN_FLIGHT = 16

#: The method that asks a question of its own, by the question's name.
_METHODS = {
    field.name: field.message_type.name.removesuffix("Request")
    for field in service.QueryStreamRequest.DESCRIPTOR.oneofs_by_name["question"].fields
    if field.name != "options"
}


class _Answer(NamedTuple):
    """What came of a question."""

    number: int
    id: int
    kind: str
    outcome: Union[bytes, CallError]

    def message(self) -> service.QueryStreamResponse:
        response = service.QueryStreamResponse(id=self.id)
        if isinstance(self.outcome, CallError):
            response.error.CopyFrom(self.outcome.told)
        else:
            part = getattr(response, self.kind)
            part.SetInParent()
            part.MergeFromString(self.outcome)
        return response


class Questions:
    """Answers, in the order in which they come or, if the options say so, in that of the questions.

    A thread reads the questions on while there is room: an answer that was not read yet counts among those under way.
    """

    def __init__(self, channel: ZenohChannel, requests: Iterable[Any], timeout: Optional[float], metadata: Metadata):
        self._channel = channel
        self._metadata = metadata
        self._until = None if timeout is None else time.monotonic() + timeout
        self._caller = channel.caller()
        self._closed = False
        self._in_order = False
        self._room = threading.Semaphore(_IN_FLIGHT)
        #: Answers, how many there will have been at the end, and what ends the stream before that.
        self._arrived: queue.SimpleQueue[Union[_Answer, int, Exception]] = queue.SimpleQueue()
        self._count: Optional[int] = None
        #: Answers by the place they are told at.
        self._waiting: dict[int, _Answer] = {}
        self._came = 0
        self._told = 0
        threading.Thread(target=self._ask_all, args=(requests,), name="clearance-questions", daemon=True).start()

    def __iter__(self) -> Questions:
        return self

    def __next__(self) -> service.QueryStreamResponse:
        while self._told not in self._waiting:
            if self._told == self._count:
                self._caller.leave()
                raise StopIteration
            self._wait()
        answer = self._waiting.pop(self._told)
        self._told += 1
        self._room.release()
        return answer.message()

    def cancel(self) -> bool:
        """Asks no more, and the daemon stops. True, as of gRPC's calls."""
        self._closed = True
        self._caller.leave()
        self._room.release()
        self._arrived.put(CallError.of(grpc.StatusCode.CANCELLED, "the caller listens no longer"))
        return True

    def _wait(self) -> None:
        left = None if self._until is None else max(self._until - time.monotonic(), 0.0)
        try:
            thing = self._arrived.get(timeout=left)
        except queue.Empty:
            thing = CallError.of(grpc.StatusCode.DEADLINE_EXCEEDED, "time is up")
        if isinstance(thing, _Answer):
            self._waiting[thing.number if self._in_order else self._came] = thing
            self._came += 1
        elif isinstance(thing, int):
            self._count = thing
        else:
            self.cancel()
            raise thing

    def _ask_all(self, requests: Iterable[Any]) -> None:
        """Runs in a thread of its own."""
        asked = 0
        try:
            questions = iter(requests)
            is_first = True
            while True:
                self._room.acquire()
                if self._closed:
                    return
                request = next(questions, None)
                if request is None:
                    break
                if request.WhichOneof("question") != "options":
                    self._ask(asked, request)
                    asked += 1
                elif is_first:
                    self._in_order = request.options.in_order
                    self._room = threading.Semaphore(request.options.max_in_flight or _IN_FLIGHT)
                else:
                    raise _invalid("options", "is for the first message")
                is_first = False
            self._arrived.put(asked)
        except Exception as error:
            # Those who read hear of it, whether it is of a call or of what the caller iterates over.
            self._arrived.put(error)

    def _ask(self, number: int, request: service.QueryStreamRequest) -> None:
        kind = request.WhichOneof("question")

        def take(outcome: Outcome) -> None:
            if outcome is not None:
                self._arrived.put(_Answer(number, request.id, kind, outcome))

        if kind is None:
            take(_invalid("question", "is missing"))
            return
        self._channel.ask(
            f"Queries/{_METHODS[kind]}",
            getattr(request, kind).SerializeToString(),
            take,
            timeout=None if self._until is None else self._until - time.monotonic(),
            metadata=self._metadata,
            caller=self._caller,
        )


def _invalid(field: str, problem: str) -> CallError:
    return CallError(
        service.QueryError(
            code=grpc.StatusCode.INVALID_ARGUMENT.value[0],
            reason=service.ERROR_REASON_INVALID_FIELD,
            message=f"{field}: {problem}",
            details={"clearance-field": field},
        )
    )
