"""A connection to a daemon, and the scenes it keeps."""

from __future__ import annotations

import hashlib
from types import TracebackType
from typing import Iterable, Iterator, Mapping, Optional, Sequence, Union

import grpc
import numpy as np
from numpy.typing import ArrayLike

from .answers import Applied, ItemAnswer, MeshCard, StatesAnswer
from .edits import BodyName, body_ref
from .errors import translated
from .poses import Vector, vec3
from .poses import pose as make_pose
from .robots import Description, PathLike, Robot
from .shapes import mesh_format, mesh_mode
from .v1 import geometry_pb2 as geometry
from .v1 import query_pb2 as query
from .v1 import robot_pb2, scene_pb2
from .v1 import service_pb2 as service
from .v1.service_pb2_grpc import AssetsStub, QueriesStub, RobotsStub, ScenesStub, ServerStub

#: The port `clearance serve` listens on unless told otherwise.
DEFAULT_ADDRESS = "127.0.0.1:50551"

#: Bytes of an upload sent in one message.
_CHUNK = 1 << 20

#: What is held against a scene: a body by name or id, or a shape with its pose.
Subject = Union[BodyName, tuple[geometry.Shape, geometry.Pose]]


class Client:
    """A connection. Use it in a `with` statement, or close it."""

    def __init__(self, address: str = DEFAULT_ADDRESS, *, timeout: Optional[float] = 60.0):
        """`address` is `HOST:PORT`; `timeout`, in seconds, counts for every call that does not bring its own."""
        unlimited = [("grpc.max_receive_message_length", -1), ("grpc.max_send_message_length", -1)]
        self._channel = grpc.insecure_channel(address.removeprefix("http://"), options=unlimited)
        self._timeout = timeout
        self._scenes = ScenesStub(self._channel)
        self._assets = AssetsStub(self._channel)
        self._robots = RobotsStub(self._channel)
        self._queries = QueriesStub(self._channel)
        self._server = ServerStub(self._channel)

    def close(self) -> None:
        self._channel.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()

    def server_info(self) -> service.GetServerInfoResponse:
        """Version, doors, limits, scenes and their epochs."""
        with translated():
            return self._server.GetServerInfo(service.GetServerInfoRequest(), timeout=self._timeout)

    def create_scene(self, name: str) -> Scene:
        """A new, empty scene."""
        with translated():
            self._scenes.CreateScene(service.CreateSceneRequest(name=name), timeout=self._timeout)
        return Scene(self, name)

    def scene(self, name: str) -> Scene:
        """A scene that is there already. Whether it is shows with the first call."""
        return Scene(self, name)

    def scenes(self) -> list[scene_pb2.SceneSummary]:
        """All scenes, in the order of their names."""
        with translated():
            return list(self._scenes.ListScenes(service.ListScenesRequest(), timeout=self._timeout).scenes)

    def load_robot(
        self,
        urdf: PathLike,
        srdf: Optional[PathLike] = None,
        *,
        packages: Optional[Mapping[str, PathLike]] = None,
        mesh: str = "hull",
        padding: float = 0.0,
        scale: float = 1.0,
    ) -> Robot:
        """Reads a robot from disk, uploads the meshes that the daemon does not have, and loads it.

        `packages` says where `package://NAME/...` is; a package that is not named is the URDF's folder. `mesh` is
        `exact`, `hull` or `solid`. Every shape is scaled, then grown by `padding` metres.
        """
        description = Description.read(urdf, srdf, packages or {})
        self.upload(description.meshes.values())
        request = robot_pb2.LoadRobotRequest(
            urdf=description.urdf,
            srdf=description.srdf,
            meshes=description.bindings(),
            mesh_mode=mesh_mode(mesh),
            padding=padding,
            scale=scale,
        )
        with translated():
            return Robot.of(self._robots.LoadRobot(request, timeout=self._timeout).robot)

    def upload(self, files: Iterable[bytes]) -> list[str]:
        """Uploads files that the daemon does not have yet; returns the SHA-256 of each, by which messages name them."""
        contents = list(files)
        hashes = [hashlib.sha256(data).hexdigest() for data in contents]
        with translated():
            request = service.HasAssetsRequest(sha256=hashes)
            present = self._assets.HasAssets(request, timeout=self._timeout).present
            for data, sha256, here in zip(contents, hashes, present):
                if not here:
                    self._assets.PutAsset(_upload(data, sha256), timeout=self._timeout)
        return hashes


    def describe_mesh(
        self,
        data: bytes,
        file_format: str,
        mode: str = "decompose",
        *,
        scale: Vector = (1.0, 1.0, 1.0),
        accuracy: Optional[float] = None,
    ) -> MeshCard:
        """What a mesh file (`obj`, `stl`, `dae`, `gltf`) costs as one hull (`hull`) or as a few (`decompose`), and how well they fit it.

        `accuracy`: how wide the brackets of the figures may be, metres; by default a thousandth of the mesh's longest side.
        """
        (sha256,) = self.upload([data])
        mesh = geometry.MeshAsset(
            sha256=sha256, format=mesh_format(file_format), mode=mesh_mode(mode), scale=vec3("scale", scale)
        )
        with translated():
            request = service.DescribeMeshRequest(mesh=mesh, accuracy=accuracy)
            return MeshCard.of(self._assets.DescribeMesh(request, timeout=self._timeout).card)


class Scene:
    """A scene of a daemon, by its name. Made by :meth:`Client.create_scene` and :meth:`Client.scene`."""

    def __init__(self, client: Client, name: str):
        self._client = client
        self.name = name

    def __repr__(self) -> str:
        return f"Scene({self.name!r})"

    def apply(
        self,
        *edits: scene_pb2.Edit,
        expected_revision: Optional[int] = None,
        expected_epoch: Optional[int] = None,
        idempotency_key: str = "",
    ) -> Applied:
        """Makes all edits, in order, or none.

        With `expected_revision`, only if the scene is at that revision; otherwise :class:`Conflict`.
        """
        request = service.ApplyRequest(
            scene=self.name,
            edits=edits,
            expected_revision=expected_revision,
            expected_epoch=expected_epoch,
            idempotency_key=idempotency_key,
        )
        with translated():
            answer = self._client._scenes.Apply(request, timeout=self._client._timeout)
        return Applied(answer.epoch, answer.revision, tuple(answer.added))

    def contents(self, *, revision: Optional[int] = None) -> scene_pb2.SceneContents:
        """Bodies and robots of the newest revision, or of a given one."""
        rule = query.RevisionRule(exactly=revision) if revision is not None else None
        request = service.GetSceneRequest(scene=self.name, revision=rule)
        with translated():
            return self._client._scenes.GetScene(request, timeout=self._client._timeout).scene

    def delete(self) -> None:
        """The scene is gone."""
        with translated():
            request = service.DeleteSceneRequest(scene=self.name)
            self._client._scenes.DeleteScene(request, timeout=self._client._timeout)

    def check_states(
        self,
        robot: str,
        positions: ArrayLike,
        *,
        want: str = "distance",
        stop_at_first: bool = False,
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> StatesAnswer:
        """Is the robot free in these states?

        `positions` has shape (n, degrees of freedom); radians, metres for sliding joints. `want` is `verdict`,
        `distance` (brackets of the nearest pairs), or `depth` (tight brackets in overlaps, too). `at_least` waits for
        a revision. With `stop_at_first` the states after the first hit are `NOT_RUN`. `solver` names who measures each
        pair, for example `gjk_polyak`; a state with a pair that it does not take is `INVALID_INPUT`.
        """
        context = self._context(want, margin, cut_off, solver, at_least)
        context.answer_form = query.ANSWER_FORM_BULK
        request = self._states_request(context, robot, positions, stop_at_first)
        with translated():
            answer = self._client._queries.CheckStates(request, timeout=timeout or self._client._timeout).answer
        _check_count(positions, len(answer.bulk.verdicts))
        return StatesAnswer.of(answer)

    def look_at_states(
        self,
        robot: str,
        positions: ArrayLike,
        *,
        want: str = "witness",
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[ItemAnswer]:
        """As :meth:`check_states`, with everything there is to know: which pairs, and where.

        For a few states; a batch of thousands is quicker without.
        """
        context = self._context(want, margin, cut_off, solver, at_least)
        context.wants.pairs = True
        request = self._states_request(context, robot, positions, stop_at_first=False)
        with translated():
            answer = self._client._queries.CheckStates(request, timeout=timeout or self._client._timeout).answer
        _check_count(positions, len(answer.items))
        return [ItemAnswer.of(item) for item in answer.items]

    def distance(
        self,
        *subjects: Subject,
        want: str = "witness",
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[ItemAnswer]:
        """How far is the nearest body from each subject? Without subjects: the nearest pair of all bodies."""
        context = self._context(want, margin, cut_off, solver, at_least)
        request = query.DistanceRequest(context=context, items=_subjects(subjects))
        with translated():
            answer = self._client._queries.Distance(request, timeout=timeout or self._client._timeout).answer
        return [ItemAnswer.of(item) for item in answer.items]

    def collide(
        self,
        *subjects: Subject,
        want: str = "verdict",
        margin: float = 0.0,
        solver: str = "default",
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[ItemAnswer]:
        """Which bodies does each subject touch? Without subjects: which pairs of all bodies touch."""
        context = self._context(want, margin, None, solver, at_least)
        request = query.CollideRequest(context=context, items=_subjects(subjects))
        with translated():
            answer = self._client._queries.Collide(request, timeout=timeout or self._client._timeout).answer
        return [ItemAnswer.of(item) for item in answer.items]

    def _context(
        self, want: str, margin: float, cut_off: Optional[float], solver: str, at_least: Optional[int]
    ) -> query.Context:
        return query.Context(
            scene=self.name,
            wants=_wants(want),
            margin=margin,
            cut_off=cut_off,
            solver=_solver(solver),
            revision=query.RevisionRule(at_least=at_least) if at_least is not None else None,
        )

    def _states_request(
        self, context: query.Context, robot: str, positions: ArrayLike, stop_at_first: bool
    ) -> query.CheckStatesRequest:
        table = np.ascontiguousarray(positions, dtype="<f8")
        if table.ndim != 2:
            raise ValueError(f"positions: needs shape (n, degrees of freedom), has {table.shape}")
        return query.CheckStatesRequest(
            context=context,
            robot=robot,
            positions=geometry.Doubles(little_endian=table.tobytes()),
            mode=query.MODE_STOP_AT_FIRST if stop_at_first else query.MODE_ALL,
        )


def _check_count(positions: ArrayLike, answered: int) -> None:
    """The daemon sees one list of numbers and cuts it by the robot's joints, whatever the table's shape was."""
    states, width = np.shape(positions)
    if answered != states:
        raise ValueError(f"positions: {width} numbers a state do not fit the robot, which takes {states * width // max(answered, 1)}")


def _wants(want: str) -> query.Wants:
    known = {
        "verdict": query.Wants(),
        "distance": query.Wants(distance=True),
        "witness": query.Wants(distance=True, witness=True, depth=True),
        "depth": query.Wants(distance=True, depth=True),
    }
    if want not in known:
        raise ValueError(f"want: is {want!r}, known are {', '.join(known)}")
    return known[want]


def _solver(name: str) -> query.Solver:
    """`gjk_polyak` is SOLVER_GJK_POLYAK."""
    known = {key.removeprefix("SOLVER_").lower(): number for key, number in query.Solver.items() if number}
    if name not in known:
        raise ValueError(f"solver: is {name!r}, known are {', '.join(known)}")
    return known[name]


def _subjects(subjects: Sequence[Subject]) -> list[query.Subject]:
    if not subjects:
        return [query.Subject(all_pairs=query.AllPairs())]
    messages = []
    for subject in subjects:
        if isinstance(subject, tuple):
            shape, pose = subject
            messages.append(query.Subject(shape=query.PlacedShape(shape=shape, pose=pose or make_pose())))
        else:
            messages.append(query.Subject(body=body_ref(subject)))
    return messages


def _upload(data: bytes, sha256: str) -> Iterator[service.PutAssetRequest]:
    yield service.PutAssetRequest(header=service.AssetHeader(sha256=sha256, bytes=len(data)))
    for start in range(0, len(data), _CHUNK):
        yield service.PutAssetRequest(chunk=data[start : start + _CHUNK])
