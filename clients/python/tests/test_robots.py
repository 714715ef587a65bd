"""Robots and their states, on the UR5 of tests/data with its known distances."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

import clearance
from clearance import Verdict

from .daemon import ROOT, DaemonTest

UR5 = ROOT / "tests" / "data" / "robot-ur5"


def json_lines(name: str) -> list:
    return [json.loads(line) for line in (UR5 / name).read_text().splitlines()]


def shape(description: dict) -> clearance.v1.geometry_pb2.Shape:
    """A shape of the scene file by the client's functions."""
    params = description["params"]
    functions = {"box": clearance.box, "cylinder": clearance.cylinder, "sphere": clearance.sphere}
    return functions[description["type"]](**params)


class Ur5(DaemonTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.robot = cls.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf")

    def stand(self, index: int) -> clearance.Applied:
        """Robot and objects of one scene of the file."""
        objects = json.loads((UR5 / "scenes.json").read_text())[index]["objects"]
        edits = [
            clearance.add_body(o["name"], shape(o["shape"]), clearance.pose(o["pose"]["t"], o["pose"]["q"]))
            for o in objects
        ]
        return self.scene.apply(clearance.add_robot("arm", self.robot), *edits)

    def test_joints_links_and_limits(self) -> None:
        self.assertEqual(self.robot.degrees_of_freedom, len(self.robot.lower))
        self.assertEqual(self.robot.joints[0].name, "shoulder_pan_joint")
        self.assertTrue((self.robot.lower < self.robot.upper).all())
        self.assertIn("forearm_link_0", self.robot.links)

    def test_loading_again_is_the_same_model(self) -> None:
        self.assertEqual(self.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf").id, self.robot.id)
        padded = self.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf", padding=0.01)
        self.assertNotEqual(padded.id, self.robot.id)

    def test_a_batch_has_the_known_verdicts_and_distances(self) -> None:
        queries = [query for query in json_lines("queries.jsonl") if query["scene"] == 0]
        truth = {line["id"]: line for line in json_lines("truth.jsonl")}
        applied = self.stand(0)
        positions = np.array([query["q"] for query in queries])
        answer = self.scene.check_states("arm", positions, want="depth", at_least=applied.revision)
        expected = np.array([truth[query["id"]]["min_distance"] for query in queries])
        np.testing.assert_allclose(answer.signed_distance, expected, atol=1e-9)
        self.assertTrue((answer.lower <= expected + 1e-12).all() and (expected <= answer.upper + 1e-12).all())
        np.testing.assert_array_equal(answer.verdicts == Verdict.COLLISION, expected < 0)
        np.testing.assert_array_equal(answer.free, expected > 0)
        self.assertEqual((answer.revision, answer.stopped_at, answer.problems), (applied.revision, None, {}))
        in_self = np.array([truth[query["id"]]["self_min"] for query in queries])
        np.testing.assert_allclose(answer.nearest_self.signed_distance, in_self, atol=1e-9)

    def test_stop_at_first_says_where(self) -> None:
        queries = [query for query in json_lines("queries.jsonl") if query["scene"] == 0]
        self.stand(0)
        positions = np.array([query["q"] for query in queries])
        every = self.scene.check_states("arm", positions, want="verdict")
        first = int(np.argmax(every.verdicts == Verdict.COLLISION))
        self.assertEqual(every.verdicts[first], Verdict.COLLISION, "the scene needs a colliding state")
        answer = self.scene.check_states("arm", positions, want="verdict", stop_at_first=True)
        self.assertEqual(answer.stopped_at, first)
        self.assertTrue((answer.verdicts[first + 1 :] == Verdict.NOT_RUN).all())

    def test_a_state_in_detail_names_the_pairs(self) -> None:
        self.stand(0)
        colliding = next(
            query
            for query, line in zip(json_lines("queries.jsonl"), json_lines("truth.jsonl"))
            if query["scene"] == 0 and line["in_collision"]
        )
        (state,) = self.scene.look_at_states("arm", [colliding["q"]])
        self.assertEqual(state.verdict, Verdict.COLLISION)
        self.assertTrue(any(pair.verdict == Verdict.COLLISION for pair in state.pairs))
        self.assertIsNotNone(state.nearest.normal)

    def test_a_state_that_cannot_be_is_named_and_the_others_are_answered(self) -> None:
        self.stand(0)
        positions = np.zeros((3, self.robot.degrees_of_freedom))
        positions[1, 2] = np.nan
        answer = self.scene.check_states("arm", positions)
        self.assertEqual(answer.verdicts[1], Verdict.INVALID_INPUT)
        self.assertEqual(list(answer.problems), [1])
        self.assertNotIn(Verdict.INVALID_INPUT, answer.verdicts[[0, 2]])

    def test_a_wrong_number_of_joints_and_an_unknown_robot_are_refused(self) -> None:
        self.stand(0)
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.scene.check_states("arm", np.zeros((1, self.robot.degrees_of_freedom + 1)))
        self.assertEqual(caught.exception.field, "positions")
        with self.assertRaises(ValueError):
            # Two rows of half a state each are one state's worth of numbers, and not what was meant.
            self.scene.check_states("arm", np.zeros((2, self.robot.degrees_of_freedom // 2)))
        with self.assertRaises(clearance.NotFound):
            self.scene.check_states("leg", np.zeros((1, self.robot.degrees_of_freedom)))


class Descriptions(DaemonTest):
    def test_a_missing_mesh_is_named(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "ur5.urdf"
            urdf.write_text((UR5 / "ur5.urdf").read_text())
            with self.assertRaises(FileNotFoundError) as caught:
                self.client.load_robot(urdf)
            self.assertIn("package://ur5/meshes/base_link_0.obj", str(caught.exception))
            # The package may be elsewhere.
            self.assertEqual(self.client.load_robot(urdf, packages={"ur5": UR5}).joints[0].kind, "REVOLUTE")

    def test_a_urdf_that_makes_no_robot_is_refused_by_the_daemon(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "loop.urdf"
            joint = '<joint name="{0}{1}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint>'
            urdf.write_text(
                '<robot name="loop"><link name="a"/><link name="b"/>'
                + joint.format("a", "b")
                + joint.format("b", "a")
                + "</robot>"
            )
            with self.assertRaises(clearance.InvalidRequest):
                self.client.load_robot(urdf)
            urdf.write_text("not xml")
            with self.assertRaises(ValueError):
                self.client.load_robot(urdf)
