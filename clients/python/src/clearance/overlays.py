"""What if? Changes that only one question sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional, Sequence

from .edits import BodyName, body_ref
from .v1 import geometry_pb2 as geometry
from .v1 import overlay_pb2 as messages
from .v1 import query_pb2 as query
from .v1 import scene_pb2


def overlay(*edits: scene_pb2.Edit, attached: Sequence[messages.AttachBody] = ()) -> messages.Overlay:
    """Edits as for :meth:`Scene.apply`, and bodies that the robot holds once they are made (see :func:`attach`)."""
    return messages.Overlay(edits=edits, attached=attached)


def attach(
    body: BodyName, robot: str, link: str, body_in_link: geometry.Pose, *, may_touch: Sequence[str] = ()
) -> messages.AttachBody:
    """A body moves with a link of the robot that is asked about, and is not where the scene has it.

    `robot` is its name in the scene, `body_in_link` the body's frame in the link's, metres. The body is held against the
    scene and against every link but that one and those that it `may_touch`.
    """
    held_by = scene_pb2.LinkRef(robot=robot, link=link)
    return messages.AttachBody(body=body_ref(body), link=held_by, body_in_link=body_in_link, may_touch=may_touch)


@dataclass(frozen=True)
class WhatIf:
    """The overlays of one question. It is answered as if they had been applied, and nobody else is told.

    `of_items` says for each item the number of its alternative, counted from one; 0: none. Left out, no item has one.
    """

    #: Of every item.
    common: Optional[messages.Overlay] = None
    #: Each made after the common one, apart from one another.
    alternatives: Sequence[messages.Overlay] = field(default=())
    of_items: Sequence[int] = field(default=())

    def put_into(self, context: query.Context) -> None:
        if self.common is not None:
            context.overlay.CopyFrom(self.common)
        context.alternatives.extend(self.alternatives)
        context.item_alternatives.extend(self.of_items)
