"""What lasts: scenes that are watched, poses that are streamed, questions on one stream."""

from __future__ import annotations

import queue
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Callable, Generic, Iterator, Mapping, Optional, TypeVar

from .edits import BodyName, body_ref
from .errors import translated
from .v1 import geometry_pb2 as geometry
from .v1 import scene_pb2
from .v1 import stream_pb2 as messages

T = TypeVar("T")


class _Stream(Generic[T]):
    """Messages of a call as they come, until it is closed. Use it in a `with` statement, or close it."""

    def __init__(self, call: Any):
        self._call = call
        self._messages = iter(call)
        self._closed = False

    def _next_message(self) -> T:
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
        """Ends the stream; may be called by another thread while this one waits for a message."""
        self._closed = True
        self._call.cancel()

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()


@dataclass
class SceneCopy:
    """A scene as far as it was told: led from revision to revision by :class:`SceneWatch`."""

    epoch: int = 0
    revision: int = 0
    #: By id.
    bodies: dict[int, scene_pb2.Body] = field(default_factory=dict)
    #: By id of the body, where they were asked for; scaled and padded already.
    shapes: dict[int, geometry.Shape] = field(default_factory=dict)
    #: By name.
    robots: dict[str, scene_pb2.RobotInScene] = field(default_factory=dict)
    #: What the scene says of pairs, by the two parties in either order.
    entries: dict[frozenset[bytes], messages.PairEntry] = field(default_factory=dict)

    def _follow(self, message: messages.WatchResponse) -> None:
        for name in message.removed_robots:
            self.robots.pop(name, None)
            self._forget(lambda party: name in (party.robot, party.link.robot))
        for id in message.removed_bodies:
            self.bodies.pop(id, None)
            self.shapes.pop(id, None)
            self._forget(lambda party: party.body.id == id and party.WhichOneof("kind") == "body")
        for watched in message.bodies:
            self.bodies[watched.body.id] = watched.body
            if watched.HasField("shape"):
                self.shapes[watched.body.id] = watched.shape
        for moved in message.moved:
            body = self.bodies[moved.id]
            body.pose.CopyFrom(moved.pose)
            body.ClearField("bounds")
            if moved.HasField("bounds"):
                body.bounds.CopyFrom(moved.bounds)
        for robot in message.robots:
            self.robots[robot.name] = robot
        for entry in message.entries:
            parties = frozenset(party.SerializeToString(deterministic=True) for party in (entry.a, entry.b))
            if entry.HasField("allowed") or entry.HasField("margin"):
                self.entries[parties] = entry
            else:
                self.entries.pop(parties, None)
        self.epoch, self.revision = message.epoch, message.revision

    def _forget(self, names: Callable[[scene_pb2.Party], bool]) -> None:
        gone = [parties for parties, entry in self.entries.items() if names(entry.a) or names(entry.b)]
        for parties in gone:
            del self.entries[parties]


@dataclass(frozen=True)
class SceneStep:
    """What led the copy from one revision to another."""

    #: None: from nothing; the copy was emptied first.
    from_revision: Optional[int]
    revision: int
    #: The reader was too far behind, so that the whole content was told anew.
    compacted: bool
    #: Ids of bodies that came or changed, and of those that left.
    changed: tuple[int, ...]
    removed: tuple[int, ...]


class SceneWatch(_Stream[messages.WatchResponse]):
    """Steps as they come; `copy` is the scene after the last one.

    A reader that is slow gets fewer steps that lead over several revisions. A scene that is deleted and a daemon that ends are
    errors.
    """

    def __init__(self, call: Any, copy: Optional[SceneCopy] = None):
        super().__init__(call)
        self.copy = copy or SceneCopy()

    def __enter__(self) -> SceneWatch:
        return self

    def __iter__(self) -> SceneWatch:
        return self

    def __next__(self) -> SceneStep:
        changed: list[int] = []
        removed: list[int] = []
        first = True
        while True:
            message = self._next_message()
            if first and not message.HasField("from_revision"):
                self.copy.__init__()  # type: ignore[misc]
            first = False
            self.copy._follow(message)
            changed.extend(watched.body.id for watched in message.bodies)
            changed.extend(moved.id for moved in message.moved)
            removed.extend(message.removed_bodies)
            if not message.more:
                break
        return SceneStep(
            from_revision=message.from_revision if message.HasField("from_revision") else None,
            revision=message.revision,
            compacted=message.compacted,
            changed=tuple(sorted(changed)),
            removed=tuple(removed),
        )


@dataclass(frozen=True)
class PosesMade:
    """What became of the poses of some messages."""

    epoch: int
    #: The first that contains them.
    revision: int
    #: How many of the messages sent so far it speaks of: each of their poses is in the revision, overtaken or refused.
    messages: int
    #: How many poses were made, and how many were overtaken by newer ones of the same body.
    poses: int
    overtaken: int
    #: Which message, from 0, which field of it, and what is wrong with it.
    refused: tuple[tuple[int, str, str], ...]

    @classmethod
    def of(cls, made: messages.PoseStreamResponse) -> PosesMade:
        refused = tuple((one.message, one.field, one.problem) for one in made.refused)
        return cls(made.epoch, made.revision, made.messages, made.poses, made.overtaken, refused)


def poses_message(
    bodies: Optional[Mapping[BodyName, geometry.Pose]], robots: Optional[Mapping[str, geometry.Pose]]
) -> messages.PoseStreamRequest:
    """Poses of bodies, by name or id, and of robots' bases, by name."""
    moved = [messages.BodyPose(body=body_ref(name), pose=pose) for name, pose in (bodies or {}).items()]
    stand = [messages.RobotPose(robot=name, base=pose) for name, pose in (robots or {}).items()]
    return messages.PoseStreamRequest(bodies=moved, robots=stand)


class PoseStream(_Stream[messages.PoseStreamResponse]):
    """Poses at a high rate: :meth:`send` them, and iterate over what became of them. :meth:`finish`, or leave the `with` block, when done."""

    def __init__(self, open_call: Callable[[Iterator[messages.PoseStreamRequest]], Any], first: messages.PoseStreamRequest):
        self._queue: queue.SimpleQueue[Optional[messages.PoseStreamRequest]] = queue.SimpleQueue()
        self._queue.put(first)
        super().__init__(open_call(iter(self._queue.get, None)))

    def send(
        self,
        bodies: Optional[Mapping[BodyName, geometry.Pose]] = None,
        robots: Optional[Mapping[str, geometry.Pose]] = None,
    ) -> None:
        """Poses of bodies, by name or id, and of robots' bases, by name: in the world, metres. Does not wait."""
        self._queue.put(poses_message(bodies, robots))

    def finish(self) -> None:
        """No more poses will be sent; the iteration ends once all that were sent are told of."""
        self._queue.put(None)

    def close(self) -> None:
        """Ends the stream at once; what waits is not made."""
        super().close()
        self._queue.put(None)

    def __enter__(self) -> PoseStream:
        return self

    def __iter__(self) -> PoseStream:
        return self

    def __next__(self) -> PosesMade:
        return PosesMade.of(self._next_message())
