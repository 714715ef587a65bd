"""A connection to a daemon, and the scenes it keeps."""

from __future__ import annotations

import hashlib
from types import TracebackType
from typing import TYPE_CHECKING, Iterable, Iterator, Mapping, Optional, Sequence, Union

import grpc
import numpy as np
from numpy.typing import ArrayLike

from .answers import Applied, ItemAnswers, MeshCard, StatesAnswer
from .casts import CastItem, NearestItem, OverlapItem, RaysAnswer, cast_mode, rays_request
from .contacts import ContactWatch
from .edits import BodyName, body_ref
from . import motions as motion_messages
from .channels import open_channel, open_zenoh
from .errors import refused, translated
from .estimates import Estimator
from .motions import MotionsAnswer
from .overlays import WhatIf
from .pair_derivatives import Derivatives, want_derivatives
from .poses import Vector, vec3
from .poses import pose as make_pose
from .robots import Description, PathLike, Robot
from .shapes import mesh_format, mesh_mode
from .streams import PoseStream, SceneCopy, SceneWatch, poses_message
from .v1 import cast_pb2 as cast
from .v1 import contact_pb2 as contact
from .v1 import geometry_pb2 as geometry
from .v1 import health_pb2
from .v1 import motion_pb2 as motion
from .v1 import query_pb2 as query
from .v1 import robot_pb2, scene_pb2
from .v1 import service_pb2 as service
from .v1 import stream_pb2 as stream
from .v1.service_pb2_grpc import AssetsStub, QueriesStub, RobotsStub, ScenesStub, ServerStub

if TYPE_CHECKING:
    from .zenoh_channel import ZenohChannel
    from .zenoh_scenes import PosesTold

#: The port `clearance serve` listens on unless told otherwise.
DEFAULT_ADDRESS = "127.0.0.1:50551"

#: Bytes of an upload sent in one message.
_CHUNK = 1 << 20

#: What is held against a scene: a body by name or id, a shape with its pose, or :func:`changed_since` and its like.
Subject = Union[BodyName, tuple[geometry.Shape, geometry.Pose], query.Subject]


def changed_since(revision: int) -> query.Subject:
    """Every pair of bodies that changed after a revision: a side of it, or what the scene says of the pair.

    As far back as the daemon keeps revisions; :class:`RevisionGone` names the oldest.
    """
    return query.Subject(changed_since=query.ChangedSince(revision=revision))


class Client:
    """A connection. Use it in a `with` statement, or close it."""

    def __init__(
        self,
        address: str = DEFAULT_ADDRESS,
        *,
        timeout: Optional[float] = 60.0,
        token: Optional[str] = None,
        ca: Optional[PathLike] = None,
        certificate: Optional[PathLike] = None,
        key: Optional[PathLike] = None,
        zenoh_prefix: str = "clearance",
        zenoh_config: Optional[PathLike] = None,
    ):
        """`address` is `HOST:PORT`, `http://HOST:PORT`, `https://HOST:PORT` or `unix:PATH`; through zenoh it is
        `zenoh/ENDPOINT`, for example `zenoh/tcp/127.0.0.1:50552`.

        `timeout`, in seconds, counts for every call that does not bring its own. `token` goes with every call.
        `ca` is a file (PEM) of certificates of which one must have signed the daemon's; without it those that gRPC
        brings along are trusted. `certificate` and `key` are files (PEM) of the client's own. A bare `HOST:PORT` means
        TLS if any of these three is given.

        Through zenoh these four are refused. `zenoh_config` is a file (JSON5) of zenoh's own configuration, for TLS,
        certificates and passwords; the endpoint is put into it, and scouting is off. `zenoh_prefix` is the daemon's. The
        connection is made at once, by zenoh itself again when it is lost, and what has no timeout ends after the daemon's
        `max_deadline_seconds` (600 unless told otherwise).
        """
        shown = {"token": token, "ca": ca, "certificate": certificate, "key": key}
        self._zenoh = open_zenoh(address, prefix=zenoh_prefix, config=zenoh_config, **shown)
        self._channel = self._zenoh or open_channel(address, **shown)
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

    def create_scene(self, name: str, *, broad_phase: str = "tree") -> Scene:
        """A new, empty scene.

        `broad_phase` says how bodies are found that meet: `tree`, `sweep_and_prune` or `exhaustive`. No answer depends
        on it; docs/broad_phase.md says when which one is faster.
        """
        request = service.CreateSceneRequest(name=name, broad_phase=_broad_phase(broad_phase))
        with translated():
            self._scenes.CreateScene(request, timeout=self._timeout)
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
        """Bodies and robots of the newest revision, or of a given one; of a large scene page by page, as one."""
        rule = query.RevisionRule(exactly=revision) if revision is not None else None
        request = service.GetSceneRequest(scene=self.name, revision=rule)
        with translated():
            contents = self._client._scenes.GetScene(request, timeout=self._client._timeout).scene
            # The other pages are of the first one's state.
            request.revision.CopyFrom(query.RevisionRule(exactly=contents.revision, epoch=contents.epoch))
            while contents.bodies_left:
                request.after_body = contents.bodies[-1].id
                page = self._client._scenes.GetScene(request, timeout=self._client._timeout).scene
                contents.bodies.extend(page.bodies)
                contents.bodies_left = page.bodies_left
        return contents

    def health(self, *, against_rebuilt: bool = False) -> health_pb2.SceneHealth:
        """What the scene and its kept revisions hold in memory, and how good its broad phase is just now.

        With `against_rebuilt` a tree of the same boxes is built to compare with: `tree.rebuilt_surface_cost`.
        """
        request = health_pb2.GetSceneHealthRequest(scene=self.name, against_rebuilt=against_rebuilt)
        with translated():
            return self._client._scenes.GetSceneHealth(request, timeout=self._client._timeout).health

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
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> StatesAnswer:
        """Is the robot free in these states?

        `positions` has shape (n, degrees of freedom); radians, metres for sliding joints. `want` is `verdict`,
        `distance` (brackets of the nearest pairs), or `depth` (tight brackets in overlaps, too). `at_least` waits for
        a revision. With `stop_at_first` the states after the first hit are `NOT_RUN`. `solver` names who measures each
        pair, for example `gjk_polyak`; a state with a pair that it does not take is `INVALID_INPUT`.
        """
        context = self._context(want, margin, cut_off, solver, at_least, what_if)
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
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> ItemAnswers:
        """As :meth:`check_states`, with everything there is to know: which pairs, and where.

        For a few states; a batch of thousands is quicker without. `derivatives`: as for :meth:`distance`, and with the gradient of the clearance
        with respect to the joints.
        """
        context = self._context(want, margin, cut_off, solver, at_least, what_if, derivatives)
        context.wants.pairs = True
        request = self._states_request(context, robot, positions, stop_at_first=False)
        with translated():
            answer = self._client._queries.CheckStates(request, timeout=timeout or self._client._timeout).answer
        _check_count(positions, len(answer.items))
        return ItemAnswers.of(answer)

    def check_motions(
        self,
        robot: str,
        starts: ArrayLike,
        goals: ArrayLike,
        *,
        first_contact: bool = True,
        stop_at_first: bool = False,
        resolution: Optional[float] = None,
        max_states: Optional[int] = None,
        margin: float = 0.0,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> MotionsAnswer:
        """Is the robot free all along these motions? Proved between states, not sampled.

        `starts` and `goals` have shape (n, degrees of freedom); radians, metres for sliding joints. A motion is the straight
        line between them in every number, and joints without limits are not wrapped. With `first_contact=False` a motion
        that collides is left as soon as a contact is met, and its bracket is wide. `resolution` is how little a pair may
        move, in metres, before what is not proved is left undecided; `max_states` how many states a motion is looked at in.
        """
        context = self._context("verdict", margin, None, "default", at_least, what_if)
        request = self._motions_request(context, robot, starts, goals, first_contact, resolution, max_states)
        request.mode = motion_messages.mode(stop_at_first)
        request.context.answer_form = query.ANSWER_FORM_BULK
        with translated():
            response = self._client._queries.CheckMotions(request, timeout=timeout or self._client._timeout)
        answer = MotionsAnswer.of(response)
        _check_count(starts, len(answer.verdicts))
        return answer

    def check_path(
        self,
        robot: str,
        waypoints: ArrayLike,
        *,
        first_contact: bool = True,
        stop_at_first: bool = True,
        resolution: Optional[float] = None,
        max_states: Optional[int] = None,
        margin: float = 0.0,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> MotionsAnswer:
        """Is the robot free all along a path? As :meth:`check_motions`, from each waypoint to the next.

        `waypoints` has shape (n + 1, degrees of freedom); the answer has n elements, and `stopped_at` is the first that is
        blocked.
        """
        context = self._context("verdict", margin, None, "default", at_least, what_if)
        request = self._path_request(context, robot, waypoints, first_contact, resolution, max_states)
        request.mode = motion_messages.mode(stop_at_first)
        request.context.answer_form = query.ANSWER_FORM_BULK
        with translated():
            response = self._client._queries.CheckPath(request, timeout=timeout or self._client._timeout)
        answer = MotionsAnswer.of(response)
        if len(answer.verdicts) != max(len(np.asarray(waypoints)) - 1, 0):
            raise ValueError(f"waypoints: {np.shape(waypoints)[1]} numbers a waypoint do not fit the robot")
        return answer

    def clearance(
        self,
        within: float,
        *subjects: Subject,
        want: str = "distance",
        margin: float = 0.0,
        max_pairs: Optional[int] = None,
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> ItemAnswers:
        """Which bodies are within that many metres of each subject? Each answer's `pairs` has them all, with their brackets.

        Without subjects: which pairs of all bodies are that near.
        """
        request = self._clearance_request(within, want, margin, max_pairs, at_least, what_if, derivatives)
        request.items.items.extend(self._subjects(subjects))
        return self._clearance(request, timeout)

    def clearance_of_states(
        self,
        robot: str,
        positions: ArrayLike,
        within: float,
        *,
        want: str = "distance",
        margin: float = 0.0,
        max_pairs: Optional[int] = None,
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> ItemAnswers:
        """Which pairs of links, and of links and bodies, are within that many metres in each state?"""
        request = self._clearance_request(within, want, margin, max_pairs, at_least, what_if, derivatives)
        request.states.robot = robot
        request.states.positions.CopyFrom(
            motion_messages.doubles(positions, "positions", "(n, degrees of freedom)", 2)
        )
        answers = self._clearance(request, timeout)
        _check_count(positions, len(answers))
        return answers

    def _clearance_request(
        self, within: float, want: str, margin: float, max_pairs: Optional[int], at_least: Optional[int],
        what_if: Optional[WhatIf], derivatives: Optional[Derivatives] = None,
    ) -> motion.ClearanceRequest:
        context = self._context(want, margin, None, "default", at_least, what_if, derivatives)
        if max_pairs is not None:
            context.max_pairs = max_pairs
        return motion.ClearanceRequest(context=context, within=within)

    def _clearance(self, request: motion.ClearanceRequest, timeout: Optional[float]) -> ItemAnswers:
        with translated():
            answer = self._client._queries.Clearance(request, timeout=timeout or self._client._timeout).answer
        return ItemAnswers.of(answer)

    def distance(
        self,
        *subjects: Subject,
        want: str = "witness",
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        solver: str = "default",
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> ItemAnswers:
        """How far is the nearest body from each subject? Without subjects: the nearest pair of all bodies.

        `derivatives` names how pairs are differentiated, for example `exact`, or is what :func:`derivatives` makes; None: they are not.
        """
        context = self._context(want, margin, cut_off, solver, at_least, what_if, derivatives)
        request = query.DistanceRequest(context=context, items=self._subjects(subjects))
        with translated():
            answer = self._client._queries.Distance(request, timeout=timeout or self._client._timeout).answer
        return ItemAnswers.of(answer)

    def collide(
        self,
        *subjects: Subject,
        want: str = "verdict",
        margin: float = 0.0,
        solver: str = "default",
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        what_if: Optional[WhatIf] = None,
        timeout: Optional[float] = None,
    ) -> ItemAnswers:
        """Which bodies does each subject touch? Without subjects: which pairs of all bodies touch.

        `derivatives`: as for :meth:`distance`; of pairs that overlap `want="depth"` or more is needed, too.
        """
        context = self._context(want, margin, None, solver, at_least, what_if, derivatives)
        request = query.CollideRequest(context=context, items=self._subjects(subjects))
        with translated():
            answer = self._client._queries.Collide(request, timeout=timeout or self._client._timeout).answer
        return ItemAnswers.of(answer)

    def estimate(
        self,
        *,
        tolerances: Sequence[float] = (),
        outputs: Sequence[str] = (),
        sample: Optional[int] = None,
        time: Optional[float] = None,
        timeout: Optional[float] = None,
    ) -> Estimator:
        """What would a question cost? The same question, asked of what this returns, is measured for each output at each tolerance.

            for price in scene.estimate(tolerances=[1e-3, 1e-6]).distance("ball"): print(price)

        `tolerances`: metres; by default a ladder down to the floor of rounding. `outputs`: `verdict`, `pairs`, `distance`, `witness`,
        `depth`, `patch`, `derivatives`; by default all that the question has and the scene's declared effects permit. `sample` items at most are
        measured for `time` seconds at most; the daemon caps both.
        """
        return Estimator(self, tolerances, outputs, sample, time, timeout)

    def cast_rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        length: ArrayLike = 1e6,
        mode: str = "first",
        margin: float = 0.0,
        ignore: Sequence[BodyName] = (),
        max_hits: Optional[int] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> RaysAnswer:
        """What does each ray meet?

        `origins` and `directions` have shape (n, 3), or one origin for all; directions may have any length but zero. `length`, in metres, is one
        number or one for each ray. `mode` is `first`, `all` (up to `max_hits` a ray) or `any` (only whether there is a hit, which is the
        quickest). A `margin` makes rays thick.
        """
        context = self._cast_context("verdict", margin, None, ignore, max_hits, at_least)
        request = rays_request(context, origins, directions, length, mode)
        with translated():
            return RaysAnswer.of(self._client._queries.CastRays(request, timeout=timeout or self._client._timeout))

    def cast_shapes(
        self,
        *movers: cast.Mover,
        mode: str = "first",
        margin: float = 0.0,
        resolution: Optional[float] = None,
        ignore: Sequence[BodyName] = (),
        max_hits: Optional[int] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[CastItem]:
        """What does each moving shape or body (see :func:`moving`) meet, and when? All other bodies stay where they are."""
        context = self._cast_context("verdict", margin, None, ignore, max_hits, at_least)
        request = cast.CastShapesRequest(context=context, items=movers, mode=cast_mode(mode), resolution=resolution)
        with translated():
            answer = self._client._queries.CastShapes(request, timeout=timeout or self._client._timeout)
        return [CastItem.of(item) for item in answer.items]

    def check_moving_pairs(
        self,
        *pairs: tuple[cast.Mover, cast.Mover],
        margin: float = 0.0,
        resolution: Optional[float] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[CastItem]:
        """When does each pair meet, of which both move?"""
        context = self._cast_context("verdict", margin, None, (), None, at_least)
        items = [cast.MovingPair(a=a, b=b) for a, b in pairs]
        request = cast.CheckMovingPairsRequest(context=context, items=items, resolution=resolution)
        with translated():
            answer = self._client._queries.CheckMovingPairs(request, timeout=timeout or self._client._timeout)
        return [CastItem.of(item) for item in answer.items]

    def overlap(
        self,
        *regions: cast.Region,
        bounds_only: bool = False,
        margin: float = 0.0,
        ignore: Sequence[BodyName] = (),
        max_bodies: Optional[int] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[OverlapItem]:
        """Which bodies have a point in each region? With `bounds_only` those whose bounding boxes meet the region's: more, for less."""
        context = self._cast_context("verdict", margin, None, ignore, max_bodies, at_least)
        request = cast.OverlapRequest(context=context, items=regions, bounds_only=bounds_only)
        with translated():
            answer = self._client._queries.Overlap(request, timeout=timeout or self._client._timeout)
        return [OverlapItem.of(item) for item in answer.items]

    def nearest_bodies(
        self,
        *subjects: Subject,
        count: int = 1,
        want: str = "witness",
        margin: float = 0.0,
        cut_off: Optional[float] = None,
        ignore: Sequence[BodyName] = (),
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> list[NearestItem]:
        """Which `count` bodies are nearest to each subject, and is that proved?"""
        if not subjects:
            raise ValueError("subjects: needs at least one body or shape")
        context = self._cast_context(want, margin, cut_off, ignore, None, at_least)
        want_derivatives(context, derivatives)
        request = cast.NearestBodiesRequest(context=context, items=self._subjects(subjects), count=count)
        with translated():
            answer = self._client._queries.NearestBodies(request, timeout=timeout or self._client._timeout)
        return [NearestItem.of(item) for item in answer.items]

    def _cast_context(
        self,
        want: str,
        margin: float,
        cut_off: Optional[float],
        ignore: Sequence[BodyName],
        most: Optional[int],
        at_least: Optional[int],
    ) -> query.Context:
        context = self._context(want, margin, cut_off, "default", at_least)
        context.filter.ignore.extend(body_ref(body) for body in ignore)
        if most is not None:
            context.max_pairs = most
        return context

    def watch_contacts(
        self,
        *,
        want: str = "verdict",
        margin: Optional[float] = None,
        stays: bool = False,
        solver: str = "default",
        derivatives: Optional[Derivatives] = None,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> ContactWatch:
        """Which contacts begin and end, revision by revision, for as long as it is iterated.

        The first step has every contact as begun. With a `margin` a pair is in contact when it is proved to be within it
        (a scene's entry for the pair replaces it), without when it is proved to touch. `stays` lists what stays, too.
        `timeout` ends the watch after so many seconds; None: never, through zenoh as late as the daemon allows.
        """
        touching, within = contact.CONTACT_THRESHOLD_TOUCHING, contact.CONTACT_THRESHOLD_MARGIN
        request = contact.WatchContactsRequest(
            context=self._context(want, margin or 0.0, None, solver, at_least, None, derivatives),
            threshold=touching if margin is None else within,
            stays=stays,
        )
        with translated():
            return ContactWatch(self._client._queries.WatchContacts(request, timeout=timeout))

    def watch(
        self,
        *,
        copy: Optional[SceneCopy] = None,
        shapes: bool = False,
        timeout: Optional[float] = None,
    ) -> SceneWatch:
        """What changes in the scene, revision by revision, for as long as it is iterated; `copy` of the watch follows.

        A `copy` of an earlier watch is gone on with; without one the first step tells the whole content. With `shapes` the
        shapes of bodies are told, too. `timeout` ends the watch after so many seconds; None: never, through zenoh as late as
        the daemon allows. Many watchers of one scene are better served by :meth:`follow`.
        """
        request = stream.WatchRequest(scene=self.name, shapes=shapes)
        if copy is not None:
            request.epoch, request.from_revision = copy.epoch, copy.revision
        with translated():
            return SceneWatch(self._client._scenes.Watch(request, timeout=timeout), copy)

    def pose_stream(self, *, interval: float = 0.0, timeout: Optional[float] = None) -> PoseStream:
        """Poses of bodies and robots at a high rate; the last one wins, and is told of by revision.

        `interval`: seconds that pass between two revisions of this stream, at least.
        """
        first = stream.PoseStreamRequest(scene=self.name, interval=interval)
        with translated():
            return PoseStream(lambda sent: self._client._scenes.PoseStream(sent, timeout=timeout), first)

    def follow(self, *, copy: Optional[SceneCopy] = None) -> SceneWatch:
        """As :meth:`watch` with shapes, through zenoh, of what the daemon tells all who follow the scene: told once, however
        many they are.

        What got lost on the way is asked for. A daemon that is away, or not reached, is waited for; when the scene has begun
        another life meanwhile, the copy begins anew. A scene that is deleted is an error.
        """
        channel = self._through_zenoh("follow", "watch")
        from .zenoh_scenes import Following

        with translated():
            return SceneWatch(Following(channel, self.name, copy), copy)

    def put_poses(
        self,
        bodies: Optional[Mapping[BodyName, geometry.Pose]] = None,
        robots: Optional[Mapping[str, geometry.Pose]] = None,
    ) -> None:
        """Poses of bodies, by name or id, and of robots' bases, by name: in the world, metres. Through zenoh only.

        All of them are made in one revision, or overtaken by newer poses of the same bodies. Waits only where the connection
        is full; what became of them is told by :meth:`poses_told`.
        """
        self._through_zenoh("put_poses", "pose_stream").put(
            self.name, "poses", poses_message(bodies, robots).SerializeToString()
        )

    def poses_told(self) -> PosesTold:
        """What becomes of poses that anybody puts for this scene from now on. Through zenoh only.

        `messages` counts those of all who put, since poses began to come after ten seconds without any.
        """
        channel = self._through_zenoh("poses_told", "pose_stream")
        from .zenoh_scenes import PosesTold

        return PosesTold(channel, self.name)

    def _through_zenoh(self, method: str, instead: str) -> ZenohChannel:
        if self._client._zenoh is None:
            raise ValueError(f"{method} needs an address that begins with zenoh/; through gRPC there is {instead}")
        return self._client._zenoh

    def stream_states(
        self,
        robot: str,
        batches: Iterable[ArrayLike],
        *,
        want: str = "distance",
        margin: float = 0.0,
        in_flight: int = 8,
        at_least: Optional[int] = None,
        timeout: Optional[float] = None,
    ) -> Iterator[StatesAnswer]:
        """As :meth:`check_states`, batch after batch on one stream: answers in order, while later batches are under way.

        At most `in_flight` batches are being answered at a time; `batches` is not read on before there is room. A batch that is
        refused raises when its turn comes.
        """
        def questions() -> Iterator[service.QueryStreamRequest]:
            options = service.QueryStreamOptions(in_order=True, max_in_flight=in_flight)
            yield service.QueryStreamRequest(options=options)
            for number, positions in enumerate(batches):
                context = self._context(want, margin, None, "default", at_least)
                context.answer_form = query.ANSWER_FORM_BULK
                request = self._states_request(context, robot, positions, stop_at_first=False)
                yield service.QueryStreamRequest(id=number, check_states=request)

        with translated():
            call = self._client._queries.QueryStream(questions(), timeout=timeout or self._client._timeout)
            try:
                for answer in call:
                    if answer.WhichOneof("outcome") == "error":
                        raise refused(answer.error)
                    yield StatesAnswer.of(answer.check_states.answer)
            finally:
                call.cancel()

    def _context(
        self,
        want: str,
        margin: float,
        cut_off: Optional[float],
        solver: str,
        at_least: Optional[int],
        what_if: Optional[WhatIf] = None,
        derivatives: Optional[Derivatives] = None,
    ) -> query.Context:
        context = query.Context(
            scene=self.name,
            wants=_wants(want),
            margin=margin,
            cut_off=cut_off,
            solver=_solver(solver),
            revision=query.RevisionRule(at_least=at_least) if at_least is not None else None,
        )
        if what_if is not None:
            what_if.put_into(context)
        want_derivatives(context, derivatives)
        return context

    @staticmethod
    def _subjects(subjects: Sequence[Subject]) -> list[query.Subject]:
        if not subjects:
            return [query.Subject(all_pairs=query.AllPairs())]
        messages = []
        for subject in subjects:
            if isinstance(subject, query.Subject):
                messages.append(subject)
            elif isinstance(subject, tuple):
                shape, pose = subject
                messages.append(query.Subject(shape=query.PlacedShape(shape=shape, pose=pose or make_pose())))
            else:
                messages.append(query.Subject(body=body_ref(subject)))
        return messages

    def _motions_request(
        self,
        context: query.Context,
        robot: str,
        starts: ArrayLike,
        goals: ArrayLike,
        first_contact: bool,
        resolution: Optional[float],
        max_states: Optional[int],
    ) -> motion.CheckMotionsRequest:
        return motion.CheckMotionsRequest(
            context=context,
            robot=robot,
            positions=motion_messages.edges(starts, goals),
            effort=motion_messages.effort(first_contact, resolution, max_states),
        )

    def _path_request(
        self,
        context: query.Context,
        robot: str,
        waypoints: ArrayLike,
        first_contact: bool,
        resolution: Optional[float],
        max_states: Optional[int],
    ) -> motion.CheckPathRequest:
        return motion.CheckPathRequest(
            context=context,
            robot=robot,
            waypoints=motion_messages.doubles(waypoints, "waypoints", "(n, degrees of freedom)", 2),
            effort=motion_messages.effort(first_contact, resolution, max_states),
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
        "patch": query.Wants(distance=True, witness=True, depth=True, patch=True),
    }
    if want not in known:
        raise ValueError(f"want: is {want!r}, known are {', '.join(known)}")
    return known[want]


def _broad_phase(name: str) -> scene_pb2.BroadPhase:
    """`tree` is BROAD_PHASE_TREE."""
    known = {key.removeprefix("BROAD_PHASE_").lower(): number for key, number in scene_pb2.BroadPhase.items() if number}
    if name not in known:
        raise ValueError(f"broad_phase: is {name!r}, known are {', '.join(known)}")
    return known[name]


def _solver(name: str) -> query.Solver:
    """`gjk_polyak` is SOLVER_GJK_POLYAK."""
    known = {key.removeprefix("SOLVER_").lower(): number for key, number in query.Solver.items() if number}
    if name not in known:
        raise ValueError(f"solver: is {name!r}, known are {', '.join(known)}")
    return known[name]


def _upload(data: bytes, sha256: str) -> Iterator[service.PutAssetRequest]:
    yield service.PutAssetRequest(header=service.AssetHeader(sha256=sha256, bytes=len(data)))
    for start in range(0, len(data), _CHUNK):
        yield service.PutAssetRequest(chunk=data[start : start + _CHUNK])
