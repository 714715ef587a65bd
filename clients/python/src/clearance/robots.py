"""Robots: descriptions on this machine's disk, models in the daemon."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Optional, Union
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from .v1 import robot_pb2 as messages

PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Joint:
    """An actuated joint."""

    name: str
    #: `REVOLUTE`, `CONTINUOUS`, `PRISMATIC` or `FLOATING`.
    kind: str
    #: Where its numbers are in a vector of joint positions.
    positions: slice
    #: Radians or metres; infinite where unlimited.
    lower: float
    upper: float


@dataclass(frozen=True)
class Robot:
    """A model that the daemon has loaded. It may stand in any number of scenes."""

    #: Names the model in the daemon.
    id: str
    #: As in the URDF.
    name: str
    #: How many numbers a vector of joint positions has.
    degrees_of_freedom: int
    #: In the order of a vector of joint positions.
    joints: tuple[Joint, ...]
    #: Names, in the order of the indices that answers use.
    links: tuple[str, ...]
    #: Pairs of links that are held against each other.
    self_pairs: tuple[tuple[int, int], ...]

    @property
    def lower(self) -> NDArray[np.float64]:
        """Least positions, one for each number of a position vector."""
        return self._limits("lower", -np.inf)

    @property
    def upper(self) -> NDArray[np.float64]:
        """Greatest positions, one for each number of a position vector."""
        return self._limits("upper", np.inf)

    def _limits(self, which: str, unlimited: float) -> NDArray[np.float64]:
        limits = np.full(self.degrees_of_freedom, unlimited)
        for joint in self.joints:
            limits[joint.positions] = getattr(joint, which)
        return limits

    @classmethod
    def of(cls, model: messages.RobotModel) -> Robot:
        return cls(
            id=model.id,
            name=model.name,
            degrees_of_freedom=model.degrees_of_freedom,
            joints=tuple(_joint(joint) for joint in model.joints),
            links=tuple(link.name for link in model.links),
            self_pairs=tuple((pair.a, pair.b) for pair in model.self_pairs),
        )


def _joint(joint: messages.Joint) -> Joint:
    return Joint(
        name=joint.name,
        kind=messages.JointKind.Name(joint.kind).removeprefix("JOINT_KIND_"),
        positions=slice(joint.first, joint.first + joint.width),
        lower=joint.lower if joint.HasField("lower") else -np.inf,
        upper=joint.upper if joint.HasField("upper") else np.inf,
    )


@dataclass(frozen=True)
class Description:
    """A robot's description as read from disk."""

    urdf: str
    srdf: Optional[str]
    #: Bytes of the mesh files, by the names the URDF has for them.
    meshes: dict[str, bytes]

    @classmethod
    def read(cls, urdf: PathLike, srdf: Optional[PathLike], packages: Mapping[str, PathLike]) -> Description:
        """Reads the texts and every mesh file that a collision element names.

        `package://NAME/rest` is `rest` in `packages[NAME]`, else in the URDF's own folder; any other name is a path from
        that folder.
        """
        path = Path(urdf)
        text = path.read_text()
        try:
            root = ElementTree.fromstring(text)
        except ElementTree.ParseError as error:
            raise ValueError(f"{path}: is not XML: {error}") from None
        names = {mesh.get("filename", "") for mesh in root.iterfind("link/collision/geometry/mesh")}
        meshes = {}
        for name in sorted(names):
            file = _resolve(name, path.parent, packages)
            try:
                meshes[name] = file.read_bytes()
            except OSError as error:
                raise FileNotFoundError(f"{path}: mesh {name!r} at {file}: {error.strerror}") from None
        return cls(text, Path(srdf).read_text() if srdf is not None else None, meshes)

    def bindings(self) -> list[messages.MeshBinding]:
        return [
            messages.MeshBinding(filename=name, sha256=hashlib.sha256(data).hexdigest())
            for name, data in self.meshes.items()
        ]


def _resolve(name: str, folder: Path, packages: Mapping[str, PathLike]) -> Path:
    if name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        return Path(packages.get(package, folder)) / rest
    return folder / name.removeprefix("file://")
