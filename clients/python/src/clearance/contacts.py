"""Contacts of a moving scene, as they begin, stay and end."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from types import TracebackType
from typing import Iterator, Optional, Protocol

from .answers import Cost, PairAnswer
from .errors import translated
from .v1 import contact_pb2 as messages


class ContactKind(IntEnum):
    """What became of a pair."""

    BEGIN = messages.CONTACT_EVENT_KIND_BEGIN
    STAY = messages.CONTACT_EVENT_KIND_STAY
    END = messages.CONTACT_EVENT_KIND_END
    UNDECIDED = messages.CONTACT_EVENT_KIND_UNDECIDED


class ContactState(IntEnum):
    """What is known of a pair."""

    APART = messages.CONTACT_STATE_APART
    UNDECIDED = messages.CONTACT_STATE_UNDECIDED
    CONTACT = messages.CONTACT_STATE_CONTACT


@dataclass(frozen=True)
class ContactEvent:
    """One pair from one revision to another."""

    #: Ids of the two bodies, the lower first.
    a: int
    b: int
    kind: ContactKind
    before: ContactState
    after: ContactState
    #: Of `END`: `REMOVED`, `DISABLED`, `NOT_A_PAIR` or `APART`.
    reason: Optional[str]
    #: Of everything but `END`: what is known of the pair.
    pair: Optional[PairAnswer]

    @classmethod
    def of(cls, event: messages.ContactEvent) -> ContactEvent:
        reason = messages.ContactEndReason.Name(event.reason).removeprefix("CONTACT_END_REASON_")
        return cls(
            a=event.a,
            b=event.b,
            kind=ContactKind(event.kind),
            before=ContactState(event.before),
            after=ContactState(event.after),
            reason=reason if event.reason else None,
            pair=PairAnswer.of(event.pair) if event.HasField("pair") else None,
        )


@dataclass(frozen=True)
class ContactStep:
    """What became of the contacts from one revision to another."""

    epoch: int
    #: The revision that the events lead on from; None: from nothing, so that every contact begins.
    from_revision: Optional[int]
    #: The revision that they lead to.
    revision: int
    #: In the order of the pairs.
    events: tuple[ContactEvent, ...]
    #: Pairs in contact, and undecided pairs, at the new revision.
    contacts: int
    undecided: int
    cost: Cost


class _Call(Protocol):
    def __iter__(self) -> Iterator[messages.WatchContactsResponse]: ...

    def cancel(self) -> bool: ...


class ContactWatch:
    """Steps as they come, for as long as it is iterated. Use it in a `with` statement, or close it.

    A reader that is slow gets fewer steps that lead over several revisions. The iteration ends when the watch is closed; a
    scene that is deleted and a daemon that ends are errors.
    """

    def __init__(self, call: _Call):
        self._call = call
        self._messages = iter(call)
        self._closed = False

    def __iter__(self) -> ContactWatch:
        return self

    def __next__(self) -> ContactStep:
        events: list[ContactEvent] = []
        while True:
            message = self._next_message()
            events.extend(ContactEvent.of(event) for event in message.events)
            if not message.more:
                break
        return ContactStep(
            epoch=message.epoch,
            from_revision=message.from_revision if message.HasField("from_revision") else None,
            revision=message.revision,
            events=tuple(events),
            contacts=message.contacts,
            undecided=message.undecided,
            cost=Cost.of(message.cost),
        )

    def _next_message(self) -> messages.WatchContactsResponse:
        if self._closed:
            raise StopIteration
        try:
            with translated():
                return next(self._messages)
        except Exception:
            if self._closed:
                raise StopIteration from None
            raise

    def close(self) -> None:
        """Ends the watch; may be called by another thread while this one waits for a step."""
        self._closed = True
        self._call.cancel()

    def __enter__(self) -> ContactWatch:
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()
