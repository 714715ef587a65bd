"""Motions, paths and clearances of the UR5 of tests/data, against sampling."""

import json

import numpy as np

import clearance
from clearance import Verdict

from .daemon import DaemonTest
from .test_robots import UR5, json_lines, shape


class Motions(DaemonTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.robot = cls.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf")
        states = [state for state in json_lines("queries.jsonl") if state["scene"] == 3]

        def of_kind(kind: str) -> np.ndarray:
            return np.array([state["q"] for state in states if state["kind"] == kind])

        beside = of_kind("line_noise")
        starts, goals = of_kind("start"), of_kind("goal")
        cls.starts = np.concatenate([starts, starts[np.arange(len(beside)) % len(starts)]])
        cls.goals = np.concatenate([goals, beside])

    def setUp(self) -> None:
        super().setUp()
        objects = json.loads((UR5 / "scenes.json").read_text())[3]["objects"]
        edits = [
            clearance.add_body(o["name"], shape(o["shape"]), clearance.pose(o["pose"]["t"], o["pose"]["q"]))
            for o in objects
        ]
        self.scene.apply(clearance.add_robot("arm", self.robot), *edits)

    def test_what_is_proved_holds_for_samples(self) -> None:
        answer = self.scene.check_motions("arm", self.starts, self.goals)
        self.assertEqual(len(answer.verdicts), len(self.starts))
        for index, verdict in enumerate(answer.verdicts):
            times = np.linspace(0.0, 1.0, 201)
            path = np.array([clearance.along(self.starts[index], self.goals[index], time) for time in times])
            sampled = self.scene.check_states("arm", path, want="verdict")
            self.assertTrue(sampled.free[times < answer.free_until[index]].all())
            if verdict == Verdict.FREE:
                self.assertTrue(sampled.free.all())
                self.assertTrue(np.isnan(answer.reached[index]).all())
            if verdict == Verdict.COLLISION:
                first, last = answer.reached[index]
                self.assertTrue(answer.free_until[index] <= first <= last)
                contact = clearance.along(self.starts[index], self.goals[index], last)
                hit = self.scene.check_states("arm", [contact], want="verdict")
                self.assertEqual(hit.verdicts[0], Verdict.COLLISION)
        self.assertIn(Verdict.COLLISION, answer.verdicts)

    def test_any_contact_is_quicker_and_says_the_same(self) -> None:
        first = self.scene.check_motions("arm", self.starts, self.goals)
        any_contact = self.scene.check_motions("arm", self.starts, self.goals, first_contact=False)
        np.testing.assert_array_equal(first.verdicts, any_contact.verdicts)
        self.assertLessEqual(any_contact.states.sum(), first.states.sum())

    def test_a_path_stops_at_its_first_blocked_motion(self) -> None:
        every = self.scene.check_motions("arm", self.starts, self.goals)
        blocked = int(np.argmax(every.verdicts == Verdict.COLLISION))
        waypoints = [self.starts[blocked], self.starts[blocked], self.goals[blocked], self.starts[blocked]]
        answer = self.scene.check_path("arm", waypoints)
        self.assertEqual(answer.stopped_at, 1)
        self.assertEqual(list(answer.verdicts), [Verdict.FREE, Verdict.COLLISION, Verdict.NOT_RUN])

    def test_bad_motions_are_refused(self) -> None:
        with self.assertRaises(ValueError):
            self.scene.check_motions("arm", self.starts, self.goals[:1])
        with self.assertRaises(ValueError):
            self.scene.check_path("arm", self.starts[0])
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.scene.check_motions("arm", self.starts, self.goals, resolution=-1.0)
        self.assertEqual(caught.exception.field, "resolution")
        with self.assertRaises(clearance.LimitExceeded):
            self.scene.check_motions("arm", self.starts, self.goals, max_states=10**9)
        bad = self.goals.copy()
        bad[1, 2] = np.nan
        answer = self.scene.check_motions("arm", self.starts, bad)
        self.assertEqual(list(answer.problems), [1])

    def test_clearances_are_the_nearest_pairs_and_more(self) -> None:
        (state,) = self.scene.clearance_of_states("arm", self.starts[:1], 0.2)
        (look,) = self.scene.look_at_states("arm", self.starts[:1], want="distance")
        self.assertEqual(min(pair.bracket.lower for pair in state.pairs), look.nearest.bracket.lower)
        self.assertTrue(all(pair.bracket.lower <= 0.2 for pair in state.pairs))
        (some,) = self.scene.clearance_of_states("arm", self.starts[:1], 0.2, max_pairs=1)
        self.assertTrue(some.truncated and len(some.pairs) == 1)
        near = self.scene.clearance(10.0, (clearance.sphere(0.1), clearance.pose([0.0, 0.0, 5.0])))
        self.assertGreater(len(near[0].pairs), 5)
        with self.assertRaises(clearance.InvalidRequest):
            self.scene.clearance(-1.0)
