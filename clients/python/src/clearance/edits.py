"""Edits of a scene, to be given to :meth:`Scene.apply`. They are made in order, all or none."""

from __future__ import annotations

from typing import Iterable, Optional, Sequence, Union

from numpy.typing import ArrayLike

from .poses import Vector, vec3
from .poses import pose as make_pose
from .robots import Robot
from .shapes import points_message
from .v1 import geometry_pb2 as geometry
from .v1 import scene_pb2 as messages
from .v1.scene_pb2 import Edit, Party

#: A body, by its name or by the id the scene gave it.
BodyName = Union[str, int]


def body_ref(name: BodyName) -> messages.BodyRef:
    return messages.BodyRef(name=name) if isinstance(name, str) else messages.BodyRef(id=name)


def add_body(
    name: str,
    shape: geometry.Shape,
    pose: Optional[geometry.Pose] = None,
    *,
    groups: Sequence[str] = (),
    layers: Optional[int] = None,
    mask: Optional[int] = None,
    padding: float = 0.0,
    scale: float = 1.0,
) -> Edit:
    """A rigid body enters the scene: scaled about its origin, then grown by `padding` metres.

    `layers` are those it is in and `mask` those it collides with, one bit each; None: all of them.
    """
    message = messages.AddBody(
        name=name,
        shape=shape,
        pose=pose or make_pose(),
        groups=groups,
        layers=layers,
        mask=mask,
        padding=padding,
        scale=scale,
    )
    return Edit(add_body=message)


def move_body(name: BodyName, pose: geometry.Pose) -> Edit:
    return Edit(move_body=messages.MoveBody(body=body_ref(name), pose=pose))


def remove_body(name: BodyName) -> Edit:
    return Edit(remove_body=messages.RemoveBody(body=body_ref(name)))


def replace_shape(name: BodyName, shape: geometry.Shape, *, padding: float = 0.0, scale: float = 1.0) -> Edit:
    message = messages.ReplaceShape(body=body_ref(name), shape=shape, padding=padding, scale=scale)
    return Edit(replace_shape=message)


def insert_points(name: BodyName, points: ArrayLike) -> Edit:
    """A body of voxels gets the cells of these points too, shape (n, 3), metres, in the body's frame."""
    message = messages.InsertPoints(body=body_ref(name), points=points_message("points", points))
    return Edit(insert_points=message)


def clear_box(name: BodyName, least: Vector, greatest: Vector) -> Edit:
    """A body of voxels loses every cell that a point of the box belongs to; corners in metres, in the body's frame."""
    box = geometry.Aabb(min=vec3("least", least), max=vec3("greatest", greatest))
    return Edit(clear_box=messages.ClearBox(body=body_ref(name), box=box))


def add_robot(name: str, model: Robot, base: Optional[geometry.Pose] = None) -> Edit:
    """A loaded robot stands in the scene under `name`; `base` is the pose of its root link."""
    return Edit(add_robot=messages.AddRobot(name=name, model=model.id, base=base or make_pose()))


def move_robot(name: str, base: geometry.Pose) -> Edit:
    return Edit(move_robot=messages.MoveRobot(robot=name, base=base))


def remove_robot(name: str) -> Edit:
    return Edit(remove_robot=messages.RemoveRobot(robot=name))


def body(name: BodyName) -> Party:
    """A single body as one side of an entry for pairs."""
    return Party(body=body_ref(name))


def link(robot_name: str, link_name: str) -> Party:
    """One link of a robot as one side of an entry for pairs."""
    return Party(link=messages.LinkRef(robot=robot_name, link=link_name))


def group(name: str) -> Party:
    """All bodies of a group as one side of an entry for pairs."""
    return Party(group=name)


def robot(name: str) -> Party:
    """All links of a robot as one side of an entry for pairs."""
    return Party(robot=name)


def allow_collision(a: Party, b: Party, allowed: Optional[bool] = True) -> Edit:
    """True: the pair is not looked at. False: it is, whatever less specific entries say. None: no entry any more."""
    message = messages.SetAllowedCollision(a=a, b=b)
    if allowed is not None:
        message.allowed = allowed
    return Edit(set_allowed_collision=message)


def set_pair_margin(a: Party, b: Party, margin: Optional[float]) -> Edit:
    """The margin of this pair in metres, in place of the question's. None: no entry any more."""
    return Edit(set_pair_margin=messages.SetPairMargin(a=a, b=b, margin=margin))


def declare_effects(a: Party, b: Party, effects: Optional[Iterable[str]]) -> Edit:
    """What may be asked of this pair: `verdict`, `margin`, `distance`, `witness`, `depth`, `patch`, `motion`, `derivatives`, `events`.

    With each goes what it needs. Of none the pair is not looked at, and answers list it in `declared_empty`. None: nothing is
    declared any more.
    """
    message = messages.DeclareEffects(a=a, b=b)
    if effects is not None:
        message.effects.SetInParent()
        for effect in effects:
            try:
                message.effects.effects.append(messages.Effect.Value(f"EFFECT_{effect.upper()}"))
            except ValueError:
                known = ", ".join(name.removeprefix("EFFECT_").lower() for name, number in messages.Effect.items() if number)
                raise ValueError(f"effects: {effect!r} is none, known are {known}") from None
    return Edit(declare_effects=message)
