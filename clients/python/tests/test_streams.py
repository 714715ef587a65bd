"""Scenes that are watched, poses that are streamed, batches of states on one stream."""

import tempfile
import threading
from pathlib import Path

import numpy as np

import clearance

from .daemon import DaemonTest
from .test_overlays import CRANE


class Watching(DaemonTest):
    def test_a_copy_follows_the_scene(self) -> None:
        at = clearance.pose
        self.scene.apply(*(clearance.add_body(f"{i}", clearance.sphere(0.1), at([i, 0, 0])) for i in range(4)))
        with self.scene.watch(shapes=True) as watch:
            first = next(watch)
            self.assertEqual((first.from_revision, first.revision, first.changed), (None, 1, (1, 2, 3, 4)))
            self.assertAlmostEqual(watch.copy.shapes[1].swept_radius, 0.1)
            fragile = clearance.group("fragile")
            self.scene.apply(
                clearance.move_body("1", at([0, 5, 0])),
                clearance.remove_body("2"),
                clearance.set_pair_margin(clearance.body("0"), fragile, 0.5),
            )
            second = next(watch)
            self.assertEqual((second.from_revision, second.changed, second.removed), (1, (2,), (3,)))
            listed = self.scene.contents(revision=second.revision)
            self.assertEqual(list(watch.copy.bodies.values()), list(listed.bodies))
            self.assertEqual([entry.margin for entry in watch.copy.entries.values()], [0.5])
            copy = watch.copy
        # A reader that comes back goes on where it was.
        self.scene.apply(clearance.remove_body("0"))
        with self.scene.watch(copy=copy) as again:
            step = next(again)
            self.assertEqual((step.from_revision, step.removed, step.compacted), (2, (1,), False))
            self.assertEqual((sorted(copy.bodies), copy.entries), ([2, 4], {}))
        # One that was away for longer than revisions are kept begins anew.
        for i in range(70):
            self.scene.apply(clearance.move_body("1", at([0, i, 0])))
        with self.scene.watch(copy=copy) as late:
            step = next(late)
            self.assertEqual((step.from_revision, step.compacted, sorted(late.copy.bodies)), (None, True, [2, 4]))

    def test_a_watch_that_is_closed_ends_the_iteration(self) -> None:
        watch = self.scene.watch()
        threading.Timer(0.2, watch.close).start()
        self.assertEqual([step.revision for step in watch], [0])

    def test_a_copy_of_another_life_of_the_scene_is_refused(self) -> None:
        copy = clearance.SceneCopy(epoch=1, revision=3)
        with self.assertRaises(clearance.Conflict):
            next(self.scene.watch(copy=copy))


class Poses(DaemonTest):
    def test_every_pose_is_made_overtaken_or_refused(self) -> None:
        self.scene.apply(clearance.add_body("a", clearance.sphere(0.1)), clearance.add_body("b", clearance.sphere(0.1)))
        with self.scene.pose_stream(interval=0.05) as poses:
            for i in range(1, 201):
                poses.send({"a": clearance.pose([i, 0, 0]), "b": clearance.pose([0, i, 0])})
            poses.send({"nobody": clearance.pose()})
            poses.finish()
            made = list(poses)
        self.assertEqual(made[-1].messages, 202)
        self.assertEqual(sum(step.poses + step.overtaken for step in made), 400)
        self.assertEqual([refused[:2] for step in made for refused in step.refused], [(201, "bodies[0].body")])
        last = {body.name: body.pose.translation for body in self.scene.contents(revision=made[-1].revision).bodies}
        self.assertEqual((last["a"].x, last["b"].y), (200.0, 200.0))
        self.assertLess(len(made), 100)

    def test_a_scene_that_is_not_there_is_an_error(self) -> None:
        with self.client.scene("nowhere").pose_stream() as poses, self.assertRaises(clearance.NotFound):
            next(poses)


class Questions(DaemonTest):
    def setUp(self) -> None:
        super().setUp()
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "crane.urdf"
            urdf.write_text(CRANE)
            self.scene.apply(
                clearance.add_robot("arm", self.client.load_robot(urdf)),
                clearance.add_body("post", clearance.box([0.1, 0.1, 2]), clearance.pose([0, 0.8, 0])),
            )

    def test_batches_on_a_stream_are_answered_as_calls_are(self) -> None:
        random = np.random.default_rng(3)
        batches = [random.uniform([-3, -1], [3, 0], size=(50, 2)) for _ in range(30)]
        answers = list(self.scene.stream_states("arm", iter(batches), in_flight=4))
        self.assertEqual(len(answers), 30)
        for batch, answer in zip(batches, answers):
            called = self.scene.check_states("arm", batch)
            np.testing.assert_array_equal(answer.verdicts, called.verdicts)
            np.testing.assert_array_equal(answer.nearest.lower, called.nearest.lower)

    def test_a_batch_that_is_refused_raises_when_its_turn_comes(self) -> None:
        answers = self.scene.stream_states("arm", [np.zeros((1, 2)), np.zeros((1, 3))])
        self.assertEqual(len(next(answers).verdicts), 1)
        with self.assertRaises(clearance.InvalidRequest) as caught:
            next(answers)
        self.assertEqual(caught.exception.field, "positions")
