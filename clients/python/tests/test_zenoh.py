"""Through zenoh: the same answers and errors as through gRPC, and what zenoh has beside calls."""

import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any, Callable, Iterator, Optional

import numpy as np
import trustme

import clearance
from clearance.errors import translated
from clearance.inbox import Inbox
from clearance.v1 import query_pb2 as query
from clearance.v1 import service_pb2 as service
from clearance.v1 import stream_pb2 as stream
from clearance.zenoh_query import CallError
from clearance.zenoh_scenes import Following

from .daemon import ROOT, DaemonTest, ZenohTest

UR5 = ROOT / "tests" / "data" / "robot-ur5"


def balls(*places: float) -> list:
    return [clearance.add_body(f"{i}", clearance.sphere(0.5), clearance.pose([x, 0, 0])) for i, x in enumerate(places)]


def within(seconds: float, closed: Any) -> Any:
    """A stream that is closed after so long, so that nobody waits for it any longer."""
    watchdog = threading.Timer(seconds, closed.close)
    watchdog.daemon = True
    watchdog.start()
    return closed


def eventually(is_so: Callable[[], bool], seconds: float = 30.0) -> None:
    until = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > until:
            raise AssertionError("it did not come about in time")
        time.sleep(0.01)


class Calls(ZenohTest):
    def test_a_prefix_that_no_daemon_has_is_told(self) -> None:
        with clearance.Client(f"zenoh/{self.door('zenoh')}", timeout=5.0) as stranger:
            with self.assertRaises(clearance.Unavailable) as caught:
                stranger.server_info()
        self.assertIn("no daemon with the prefix 'clearance'", str(caught.exception))

    def test_a_robot_is_uploaded_loaded_and_asked_about(self) -> None:
        robot = self.through_zenoh.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf", padding=0.001)
        self.assertEqual(robot.id, self.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf", padding=0.001).id)
        self.zenoh_scene.apply(
            clearance.add_robot("arm", robot),
            clearance.add_body("table", clearance.box([1.0, 1.0, 0.02]), clearance.pose([0, 0, 0.7])),
        )
        positions = np.random.default_rng(5).uniform(-1.5, 1.5, size=(500, robot.degrees_of_freedom))
        answer, wanted = (scene.check_states("arm", positions) for scene in (self.zenoh_scene, self.scene))
        self.assertEqual({1, 3}, set(wanted.verdicts.tolist()))
        np.testing.assert_array_equal(answer.verdicts, wanted.verdicts)
        np.testing.assert_array_equal(answer.lower, wanted.lower)
        np.testing.assert_array_equal(answer.upper, wanted.upper)
        self.assertEqual((answer.epoch, answer.revision), (wanted.epoch, wanted.revision))

    def test_a_file_of_many_chunks_arrives(self) -> None:
        data = np.random.default_rng(6).bytes(3 * (1 << 20) + 5)
        (sha256,) = self.through_zenoh.upload([data])
        request = service.HasAssetsRequest(sha256=[sha256])
        self.assertEqual(list(self.client._assets.HasAssets(request).present), [True])

    def test_errors_are_those_of_grpc(self) -> None:
        self.scene.apply(*balls(0.0, 3.0))
        context = query.Context(scene=self.scene.name)
        nan = clearance.pose([float("nan"), 0, 0])

        def ask(client: clearance.Client) -> Iterator[Callable[[], object]]:
            scene = client.scene(self.scene.name)
            yield lambda: scene.apply(clearance.move_body("0", clearance.pose()), clearance.move_body("1", nan))
            yield lambda: scene.distance((clearance.point(), nan))
            yield lambda: client.scene("nowhere").distance()
            yield lambda: client.create_scene(scene.name)
            yield lambda: scene.apply(*balls(0.0), expected_revision=7)
            yield lambda: client._queries.CheckStates(query.CheckStatesRequest(context=context))
            yield lambda: client._scenes.GetScene(service.GetSceneRequest(scene=scene.name, max_bodies=(1 << 32) - 1))
            yield lambda: scene.distance(at_least=99, timeout=0.2)
            yield lambda: next(scene.watch(copy=clearance.SceneCopy(epoch=1)))

        kinds = set()
        for through_grpc, through_zenoh in zip(ask(self.client), ask(self.through_zenoh)):
            told = []
            for asked in (through_grpc, through_zenoh):
                with self.assertRaises(clearance.ClearanceError) as caught, translated():
                    asked()
                told.append((type(caught.exception), str(caught.exception), vars(caught.exception)))
            self.assertEqual(told[0], told[1])
            kinds.add(told[1][0])
        wanted = {clearance.InvalidRequest, clearance.NotFound, clearance.Conflict, clearance.LimitExceeded, clearance.Unavailable}
        self.assertLessEqual(wanted, kinds)
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.zenoh_scene.apply(clearance.move_body("0", clearance.pose()), clearance.move_body("1", nan))
        self.assertEqual((caught.exception.item, caught.exception.field), (1, "edits[1].move_body.pose.translation"))

    def test_where_nobody_is_nothing_is_opened(self) -> None:
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            with self.assertRaises(clearance.Unavailable):
                clearance.Client(f"zenoh/tcp/127.0.0.1:{taken.getsockname()[1]}")

    def test_a_stopped_daemon_costs_the_timeout(self) -> None:
        os.kill(self.process.pid, signal.SIGSTOP)
        try:
            began = time.monotonic()
            with self.assertRaises(clearance.DeadlineExceeded):
                self.zenoh_scene.distance(timeout=0.3)
            self.assertLess(time.monotonic() - began, 10.0)
        finally:
            os.kill(self.process.pid, signal.SIGCONT)
        self.assertEqual(len(self.zenoh_scene.distance()), 1)

    def test_timeouts_may_be_long_and_none(self) -> None:
        self.assertEqual(len(self.zenoh_scene.distance(timeout=1e6)), 1)
        request = service.ListScenesRequest()
        self.assertEqual(len(self.through_zenoh._scenes.ListScenes(request).scenes), len(self.client.scenes()))
        with self.assertRaises(clearance.DeadlineExceeded):
            self.zenoh_scene.distance(timeout=-1.0)

    def test_a_closed_client_asks_nobody(self) -> None:
        client = self.connect()
        watch = client.scene(self.scene.name).watch()
        next(watch)
        client.close()
        with self.assertRaises(ValueError):
            client.scenes()
        watch.close()
        client.close()


class Streams(ZenohTest):
    def test_a_copy_follows_the_scene(self) -> None:
        self.scene.apply(*balls(0.0, 3.0))
        with within(30, self.zenoh_scene.watch(shapes=True)) as watch:
            first = next(watch)
            self.assertEqual((first.from_revision, first.revision, first.changed), (None, 1, (1, 2)))
            self.assertAlmostEqual(watch.copy.shapes[1].swept_radius, 0.5)
            self.zenoh_scene.apply(clearance.move_body("1", clearance.pose([0, 5, 0])), clearance.remove_body("0"))
            second = next(watch)
            self.assertEqual((second.from_revision, second.changed, second.removed), (1, (2,), (1,)))
            self.assertEqual(list(watch.copy.bodies.values()), list(self.scene.contents().bodies))

    def test_contacts_begin_and_end(self) -> None:
        self.scene.apply(*balls(0.0, 0.9))
        with within(30, self.zenoh_scene.watch_contacts()) as watch:
            self.assertEqual(next(watch).contacts, 1)
            self.scene.apply(clearance.move_body("1", clearance.pose([5, 0, 0])))
            self.assertEqual([event.reason for event in next(watch).events], ["APART"])

    def test_a_closed_watch_wakes_its_reader_and_leaves(self) -> None:
        watch = self.zenoh_scene.watch()
        threading.Timer(0.3, watch.close).start()
        self.assertEqual([step.revision for step in within(30, watch)], [0])
        eventually(lambda: self.tokens() == 1)
        forgotten = self.zenoh_scene.watch_contacts()
        next(forgotten)
        eventually(lambda: self.tokens() == 2)
        del forgotten
        eventually(lambda: self.tokens() == 1)

    def tokens(self) -> int:
        """How many names callers have."""
        session = self.through_zenoh._zenoh._session
        told = session.liveliness().get(f"{self.PREFIX}/v1/client/**", timeout=10.0)
        # Zenoh tells of a session's own tokens twice.
        return len({str(reply.ok.key_expr) for reply in told})

    def test_a_deleted_scene_and_a_timeout_are_errors(self) -> None:
        scene = self.client.create_scene("for a moment")
        watch = within(30, self.through_zenoh.scene(scene.name).watch())
        next(watch)
        scene.delete()
        with self.assertRaises(clearance.NotFound):
            next(watch)
        with self.assertRaises(clearance.DeadlineExceeded):
            list(self.zenoh_scene.watch_contacts(timeout=0.3))

    def test_a_reader_that_is_too_slow_is_told(self) -> None:
        self.scene.apply(*balls(0.0))
        with within(30, self.zenoh_scene.watch()) as watch:
            next(watch)
            inbox = watch._call._arrived
            inbox._most = 1
            for is_so in (lambda: inbox._waiting > 0, lambda: inbox._spills):
                revision = self.scene.apply(clearance.move_body("0", clearance.pose())).revision
                eventually(is_so)
            self.assertEqual(next(watch).revision, revision - 1)
            with self.assertRaisesRegex(clearance.LimitExceeded, "too slow"):
                next(watch)

    def test_a_connection_that_is_lost_is_an_error(self) -> None:
        with Wire(self.door("zenoh")) as wire, self.connect(wire.endpoint) as client:
            scene = client.scene(self.scene.name)
            with within(30, scene.watch()) as watch, within(30, scene.watch_contacts()) as contacts:
                next(watch), next(contacts)
                wire.cut()
                for lost in (watch, contacts):
                    with self.assertRaisesRegex(clearance.Unavailable, "connection to the daemon was lost"):
                        next(lost)

    def test_batches_are_asked_several_at_a_time(self) -> None:
        robot = self.through_zenoh.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf")
        self.scene.apply(clearance.add_robot("arm", robot))
        random = np.random.default_rng(3)
        batches = [random.uniform(-1.5, 1.5, size=(20, robot.degrees_of_freedom)) for _ in range(30)]
        answers = list(self.zenoh_scene.stream_states("arm", iter(batches), in_flight=4))
        self.assertEqual(len(answers), 30)
        for batch, answer in zip(batches, answers):
            np.testing.assert_array_equal(answer.lower, self.scene.check_states("arm", batch).lower)
        refused = self.zenoh_scene.stream_states("arm", [batches[0], batches[0][:, 1:]])
        self.assertEqual(len(next(refused).verdicts), 20)
        with self.assertRaises(clearance.InvalidRequest) as caught:
            next(refused)
        self.assertEqual(caught.exception.field, "positions")
        with self.assertRaisesRegex(ValueError, "needs shape"):
            list(self.zenoh_scene.stream_states("arm", [np.zeros(3)]))

    def test_questions_of_any_kind_are_answered_by_their_ids(self) -> None:
        self.scene.apply(*balls(0.0, 0.9))
        context, every = query.Context(scene=self.scene.name), [query.Subject(all_pairs=query.AllPairs())]
        asked = [
            service.QueryStreamRequest(id=7, collide=query.CollideRequest(context=context, items=every)),
            service.QueryStreamRequest(id=8),
            service.QueryStreamRequest(id=9, distance=query.DistanceRequest(context=query.Context(scene="nowhere"), items=every)),
        ]
        told = [
            {answer.id: answer for answer in client._queries.QueryStream(iter(asked), timeout=30)}
            for client in (self.client, self.through_zenoh)
        ]
        self.assertEqual(sorted(told[1]), [7, 8, 9])
        self.assertEqual(told[0], told[1])
        options = service.QueryStreamRequest(options=service.QueryStreamOptions())
        with self.assertRaises(clearance.InvalidRequest) as caught, translated():
            list(self.through_zenoh._queries.QueryStream(iter([asked[1], options]), timeout=30))
        self.assertEqual(caught.exception.field, "options")

    def test_questions_wait_for_those_who_read(self) -> None:
        read = threading.Semaphore(0)
        given = 0

        def questions() -> Iterator[service.QueryStreamRequest]:
            nonlocal given
            yield service.QueryStreamRequest(options=service.QueryStreamOptions(max_in_flight=2))
            for given in range(1, 6):
                yield service.QueryStreamRequest(id=given)
            # Questions may depend on answers.
            self.assertTrue(read.acquire(timeout=30))

        answers = self.through_zenoh._queries.QueryStream(questions(), timeout=30)
        time.sleep(0.3)
        self.assertEqual(given, 2)
        self.assertEqual([next(answers).id for _ in range(5)], [1, 2, 3, 4, 5])
        read.release()
        self.assertEqual(list(answers), [])
        waiting = self.through_zenoh._queries.QueryStream(iter(threading.Event().wait, None), timeout=0.3)
        with self.assertRaises(clearance.DeadlineExceeded), translated():
            next(waiting)

    def test_a_stream_of_poses_is_refused(self) -> None:
        with self.assertRaisesRegex(clearance.ClearanceError, "UNIMPLEMENTED: Scenes/PoseStream .*put_poses"):
            self.zenoh_scene.pose_stream()


class Poses(ZenohTest):
    def test_poses_are_made_and_told(self) -> None:
        applied = self.scene.apply(*balls(0.0, 3.0))
        with within(30, self.zenoh_scene.poses_told()) as told:
            for x in range(1, 101):
                self.zenoh_scene.put_poses({"0": clearance.pose([x, 0, 0]), applied.added[1]: clearance.pose([0, x, 0])})
            self.zenoh_scene.put_poses({"nobody": clearance.pose()})
            made = []
            while not made or made[-1].messages < 101:
                made.append(next(told))
        self.assertEqual(sum(step.poses + step.overtaken for step in made), 200)
        self.assertEqual([refused[:2] for step in made for refused in step.refused], [(100, "bodies[0].body")])
        last = {body.name: body.pose.translation for body in self.scene.contents(revision=made[-1].revision).bodies}
        self.assertEqual((last["0"].x, last["1"].y), (100.0, 100.0))

    def test_puts_that_cannot_be_taken_are_told(self) -> None:
        with within(30, self.zenoh_scene.poses_told()) as told:
            self.through_zenoh._zenoh.put(self.scene.name, "poses", stream.PoseStreamRequest(interval=1.0).SerializeToString())
            refused = next(told)
            self.assertIsInstance(refused, clearance.InvalidRequest)
            self.assertEqual(refused.field, "interval")
        nowhere = self.through_zenoh.scene("nowhere")
        with within(30, nowhere.poses_told()) as told:
            nowhere.put_poses({"0": clearance.pose()})
            self.assertIsInstance(next(told), clearance.NotFound)

    def test_names_may_have_any_character(self) -> None:
        name = f"{self.scene.name}/ä *?#$%"
        scene = self.through_zenoh.create_scene(name)
        self.addCleanup(scene.delete)
        scene.apply(*balls(0.0))
        with within(30, scene.follow()) as follow, within(30, scene.poses_told()) as told:
            next(follow)
            scene.put_poses({"0": clearance.pose([7, 0, 0])})
            self.assertEqual(next(told).poses, 1)
            self.assertEqual(next(follow).changed, (1,))
            self.assertEqual(follow.copy.bodies[1].pose.translation.x, 7.0)

    def test_closing_ends_the_iteration(self) -> None:
        told = self.zenoh_scene.poses_told()
        threading.Timer(0.2, told.close).start()
        self.assertEqual(list(within(30, told)), [])

    def test_grpc_has_other_ways(self) -> None:
        for method, instead in (("put_poses", "pose_stream"), ("poses_told", "pose_stream"), ("follow", "watch")):
            with self.assertRaisesRegex(ValueError, f"{method} needs .*zenoh/.* {instead}"):
                getattr(self.scene, method)()


class Follow(ZenohTest):
    def test_many_follow_what_is_told_once(self) -> None:
        self.scene.apply(*balls(0.0, 3.0))
        followers = [within(60, self.zenoh_scene.follow()) for _ in range(3)]
        for follower in followers:
            first = next(follower)
            self.assertEqual((first.from_revision, first.revision, first.changed), (None, 1, (1, 2)))
        for x in range(100):
            newest = self.scene.apply(clearance.move_body("1", clearance.pose([x, 0, 0]))).revision
        for follower in followers:
            at = 1
            while at < newest:
                step = next(follower)
                self.assertEqual(step.from_revision, at)
                at = step.revision
            self.assertEqual(list(follower.copy.bodies.values()), list(self.scene.contents().bodies))
            self.assertAlmostEqual(follower.copy.shapes[1].swept_radius, 0.5)
        copy = followers[0].copy
        for follower in followers:
            follower.close()
            self.assertEqual(list(follower), [])
        # One that comes back goes on where it was.
        self.scene.apply(clearance.remove_body("0"))
        with within(30, self.zenoh_scene.follow(copy=copy)) as again:
            step = next(again)
            self.assertEqual((step.from_revision, step.removed), (newest, (1,)))

    def test_a_deleted_scene_is_an_error(self) -> None:
        scene = self.client.create_scene("followed for a moment")
        follow = within(30, self.through_zenoh.scene(scene.name).follow())
        next(follow)
        scene.delete()
        with self.assertRaises(clearance.NotFound):
            next(follow)

    def test_another_life_of_the_scene_begins_anew(self) -> None:
        copy = clearance.SceneCopy(epoch=1, revision=3)
        with within(30, self.zenoh_scene.follow(copy=copy)) as follow:
            step = next(follow)
        self.assertEqual((step.from_revision, step.revision), (None, 0))
        self.assertEqual(copy.epoch, self.scene.contents().epoch)

    def test_a_scene_that_is_not_there_is_an_error(self) -> None:
        with within(30, self.through_zenoh.scene("nowhere").follow()) as follow, self.assertRaises(clearance.NotFound):
            next(follow)

    def test_a_connection_that_is_cut_and_healed_loses_nothing(self) -> None:
        """Longer than the log goes back, then shorter."""
        self.scene.apply(*balls(0.0, 3.0))
        with Wire(self.door("zenoh")) as wire, self.connect(wire.endpoint) as client:
            with within(120, client.scene(self.scene.name).follow()) as follow:
                next(follow)
                for edits in (1, 200, 20):
                    wire.cut()
                    with self.assertRaises(clearance.Unavailable):
                        eventually(lambda: not client.scenes())
                    for x in range(edits):
                        newest = self.scene.apply(clearance.move_body("1", clearance.pose([x, edits, 0]))).revision
                    wire.heal()
                    while follow.copy.revision < newest:
                        next(follow)
                    self.assertEqual(list(follow.copy.bodies.values()), list(self.scene.contents().bodies))


class Wire:
    """A way to an endpoint that can be cut."""

    def __init__(self, endpoint: str):
        host, port = endpoint.removeprefix("tcp/").split(":")
        self._to = (host, int(port))
        self._lock = threading.Lock()
        self._ends: list[socket.socket] = []
        self._is_cut = False
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp/127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def __enter__(self) -> "Wire":
        return self

    def __exit__(self, *_: object) -> None:
        self.cut()
        self._listener.close()

    def cut(self) -> None:
        with self._lock:
            self._is_cut = True
            ends, self._ends = self._ends, []
        for end in ends:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # The other side was quicker.
            end.close()

    def heal(self) -> None:
        with self._lock:
            self._is_cut = False

    def _accept(self) -> None:
        while True:
            try:
                ours, _ = self._listener.accept()
            except OSError:
                return
            theirs = socket.create_connection(self._to)
            with self._lock:
                if self._is_cut:
                    ours.close()
                    theirs.close()
                    continue
                self._ends += [ours, theirs]
            for source, sink in ((ours, theirs), (theirs, ours)):
                threading.Thread(target=self._carry, args=(source, sink), daemon=True).start()

    @staticmethod
    def _carry(source: socket.socket, sink: socket.socket) -> None:
        try:
            while data := source.recv(1 << 16):
                sink.sendall(data)
        except OSError:
            pass


class Steps(unittest.TestCase):
    """What a follower makes of what it hears, without a daemon."""

    def setUp(self) -> None:
        self.asked: list[stream.WatchRequest] = []
        self.following = Following(self, "cell", None)  # type: ignore[arg-type]
        self.answer(step(None, 3))
        self.assertEqual(self.led(), [3])

    # What a channel has.

    def hear_numbered(self, scene: str, what: str, take: Callable, ended: Callable) -> "Steps":
        self.assertEqual((scene, what), ("cell", "changes"))
        self.tell, self.ended = take, ended
        return self

    def tokens(self, scene: str, take: Callable) -> list:
        self.token = take
        take("alive", True)
        return [self]

    def ask(self, rpc: str, body: bytes, take: Callable, *, steps: int) -> "Steps":
        self.assertEqual((rpc, steps), ("Scenes/Watch", 1))
        self.asked.append(stream.WatchRequest.FromString(body))
        self.take = take
        return self

    def cancel(self) -> None:
        pass

    def undeclare(self) -> None:
        self.ended()

    # What happens.

    def answer(self, *outcomes: Any) -> None:
        for outcome in (*outcomes, None):
            self.take(outcome.SerializeToString() if isinstance(outcome, stream.WatchResponse) else outcome)

    def hear(self, number: int, message: stream.WatchResponse, source: str = "a") -> None:
        self.tell(message.SerializeToString(), source, number)

    def led(self, until: Optional[int] = None) -> list[int]:
        """The revisions that messages lead to, with what waits taken."""
        self.following._inbox.put((self.following._ready.append, None))
        return [message.revision for message in iter(self.following.__next__, None)]

    def from_revisions(self) -> list[Optional[int]]:
        """What was asked since the last time."""
        asked, self.asked = self.asked, []
        return [request.from_revision if request.HasField("from_revision") else None for request in asked]

    def test_steps_that_lead_on_are_taken_and_old_ones_are_not(self) -> None:
        self.assertEqual(self.from_revisions(), [None])
        self.hear(0, step(3, 3))
        self.hear(1, step(2, 3))
        self.hear(2, step(3, 4))
        self.hear(3, step(4, 6))
        self.assertEqual((self.led(), self.from_revisions()), ([4, 6], []))

    def test_a_gap_is_asked_for_once(self) -> None:
        self.hear(0, step(3, 3))
        self.hear(1, step(5, 6))
        self.hear(2, step(6, 7))
        self.assertEqual((self.led(), self.from_revisions()), ([], [None, 3]))
        # The answer is older than what was heard meanwhile.
        self.answer(step(3, 6))
        self.assertEqual((self.led(), self.from_revisions()), ([6], [6]))
        self.answer(step(6, 9))
        self.hear(3, step(7, 9))
        self.hear(4, step(9, 10))
        self.assertEqual((self.led(), self.from_revisions()), ([9, 10], []))

    def test_a_step_of_several_messages_is_taken_whole_or_not_at_all(self) -> None:
        self.hear(0, step(3, 3))
        self.hear(1, step(3, 4, more=True))
        self.assertEqual(self.led(), [])
        self.hear(2, step(3, 4))
        self.assertEqual(self.led(), [4, 4])
        self.hear(3, step(4, 5, more=True))
        self.hear(5, step(4, 5))
        self.assertEqual((self.led(), self.from_revisions()), ([], [None, 4]))
        self.answer(step(4, 5, more=True), step(4, 5))
        self.hear(6, step(5, 6))
        self.assertEqual(self.led(), [5, 5, 6])

    def test_what_is_heard_before_the_log_answers_may_be_the_end_of_a_step(self) -> None:
        self.following = Following(self, "cell", clearance.SceneCopy(epoch=1, revision=3))  # type: ignore[arg-type]
        self.hear(8, step(3, 4))
        self.assertEqual((self.led(), self.from_revisions()), ([], [None, 3]))
        self.answer(step(3, 4))
        self.hear(9, step(4, 5))
        self.assertEqual((self.led(), self.from_revisions()), ([4, 5], []))

    def test_numbers_begin_again_after_the_last(self) -> None:
        self.hear((1 << 32) - 1, step(3, 3))
        self.hear(0, step(3, 4))
        self.assertEqual(self.led(), [4])

    def test_a_daemon_that_comes_back_is_asked(self) -> None:
        self.token("alive", False)
        self.led()
        self.answer(refusal("UNAVAILABLE", 14))
        self.assertEqual((self.led(), self.from_revisions()), ([], [None, 3]))
        self.token("alive", True)
        self.led()
        self.answer(refusal("WRONG_EPOCH", 9, service.ERROR_REASON_WRONG_EPOCH))
        self.led()
        self.answer(step(None, 1, epoch=2))
        self.assertEqual((self.led(), self.from_revisions()), ([1], [3, None]))
        self.hear(0, step(3, 4), source="b")
        self.led()
        self.assertEqual(self.from_revisions(), [1])

    def test_what_does_not_fit_the_inbox_is_asked_for(self) -> None:
        self.hear(0, step(3, 3))
        self.following._inbox._most = 1
        self.hear(1, step(3, 4))
        self.hear(2, step(4, 5))
        self.led()
        self.assertEqual(self.from_revisions(), [None, 3])
        self.answer(step(3, 5))
        self.assertEqual(self.led(), [5])

    def test_what_else_is_refused_is_raised(self) -> None:
        self.token("alive", False)
        self.led()
        self.answer(refusal("no scene", 5))
        with self.assertRaises(CallError):
            self.led()
        self.assertEqual(list(self.following), [])


def step(from_revision: Optional[int], revision: int, *, more: bool = False, epoch: int = 1) -> stream.WatchResponse:
    return stream.WatchResponse(epoch=epoch, from_revision=from_revision, revision=revision, more=more)


def refusal(message: str, code: int, reason: int = 0) -> CallError:
    return CallError(service.QueryError(code=code, message=message, reason=reason))


class Waiting(unittest.TestCase):
    def test_what_is_too_much_is_told_of_once(self) -> None:
        inbox = Inbox("lost", most=10)
        inbox.put("larger than the inbox, and alone", 11)
        for size in (1, 2, 3):
            inbox.put("more", size)
        inbox.put("of no size")
        self.assertEqual([inbox.take() for _ in range(3)], ["larger than the inbox, and alone", "lost", "of no size"])
        inbox.put("more", 10)
        inbox.put("more", 1)
        self.assertEqual([inbox.take() for _ in range(2)], ["more", "lost"])


class Addresses(unittest.TestCase):
    def test_what_makes_no_sense_is_told(self) -> None:
        for given, problem in (
            ({"token": "t", "ca": "ca.pem"}, "token and ca cannot be given"),
            ({"certificate": "me.pem", "key": "key.pem"}, "certificate and key cannot be given"),
            ({"zenoh_prefix": "a/*"}, "no key without wildcards"),
            ({"zenoh_prefix": ""}, "no key without wildcards"),
        ):
            with self.subTest(given), self.assertRaisesRegex(ValueError, problem):
                clearance.Client("zenoh/tcp/127.0.0.1:1", **given)
        with self.assertRaisesRegex(ValueError, "'127.0.0.1:1' is no endpoint"):
            clearance.Client("zenoh/127.0.0.1:1")
        with self.assertRaisesRegex(ValueError, "zenoh_config has no meaning"):
            clearance.Client("127.0.0.1:1", zenoh_config="zenoh.json5")
        with self.assertRaises(FileNotFoundError):
            clearance.Client("zenoh/tcp/127.0.0.1:1", zenoh_config="nowhere.json5")

    def test_without_zenoh_grpc_is_still_there(self) -> None:
        program = "import sys; sys.modules['zenoh'] = None; import clearance; clearance.Client('127.0.0.1:1').close()\n"
        program += "clearance.Client('zenoh/tcp/127.0.0.1:1')"
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
        self.assertIn("ImportError: zenoh/tcp/127.0.0.1:1 needs eclipse-zenoh: pip install", done.stderr)


class Certificates(DaemonTest):
    """Both sides show certificates, as their files say."""

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = Path(folder.name)
        authority = trustme.CA()
        authority.cert_pem.write_to_path(str(cls.path / "ca.pem"))
        for name in ("localhost", "planner"):
            made = authority.issue_cert(name)
            made.cert_chain_pems[0].write_to_path(str(cls.path / f"{name}.pem"))
            made.private_key_pem.write_to_path(str(cls.path / f"{name}_key.pem"))
        daemon = cls.file("listen", "localhost")
        cls.DOORS = ["--no-shared-memory", "--zenoh-listen", "tls/localhost:0", "--zenoh-file", str(daemon)]
        super().setUpClass()

    @classmethod
    def file(cls, side: str, name: str) -> Path:
        path = cls.path / f"{name}.json5"
        path.write_text(
            f"""{{ transport: {{ link: {{ tls: {{
                root_ca_certificate: "{cls.path}/ca.pem",
                enable_mtls: true,
                {side}_certificate: "{cls.path}/{name}.pem",
                {side}_private_key: "{cls.path}/{name}_key.pem",
            }} }} }} }}"""
        )
        return path

    def test_a_file_says_how_to_connect(self) -> None:
        address = f"zenoh/{self.door('zenoh').replace('127.0.0.1', 'localhost')}"
        with clearance.Client(address, zenoh_config=self.file("connect", "planner"), timeout=30.0) as client:
            self.assertEqual(client.server_info().version, self.client.server_info().version)
        with self.assertRaises(clearance.Unavailable):
            clearance.Client(address)
        with self.assertRaisesRegex(ValueError, "nonsense"):
            (self.path / "bad.json5").write_text("{ nonsense: 1 }")
            clearance.Client(address, zenoh_config=self.path / "bad.json5")


if __name__ == "__main__":
    unittest.main()
