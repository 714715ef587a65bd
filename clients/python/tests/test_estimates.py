"""Prices of questions. Times are only there; widths and verdicts are held against the questions themselves."""

import numpy as np

import clearance
from clearance import EstimateEnd, InvalidRequest, Verdict

from .daemon import DaemonTest
from .test_robots import UR5


class Estimates(DaemonTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.robot = cls.client.load_robot(UR5 / "ur5.urdf", UR5 / "ur5.srdf")

    def setUp(self) -> None:
        super().setUp()
        cones = [
            clearance.add_body(f"cone{i}", clearance.cone(0.1, 0.2), clearance.pose([0.5 * i, 2.0, 0.0], [1.0, 0.1 * i, 0.2, 0.0]))
            for i in range(8)
        ]
        self.scene.apply(clearance.add_robot("arm", self.robot), *cones)
        self.cones = [f"cone{i}" for i in range(8)]

    def test_rows_say_what_the_question_does(self) -> None:
        estimate = self.scene.estimate(tolerances=[1e-2, 1e-6], outputs=["distance"]).distance(*self.cones)
        self.assertEqual((estimate.end, estimate.items, estimate.sample), (EstimateEnd.COMPLETE, 8, 8))
        self.assertEqual([(p.output, p.tolerance) for p in estimate], [("distance", 1e-2), ("distance", 1e-6)])
        self.assertGreater(estimate.seconds, 0.0)
        for price in estimate:
            self.assertTrue(price.complete)
            self.assertTrue(0.0 < price.median <= price.p99)
            self.assertLessEqual(price.median_width, price.largest_width)
            self.assertLessEqual(price.largest_width, price.tolerance)
            self.assertEqual(price.wider, 0)
            answers = self.scene.distance(*self.cones, want="distance")
            self.assertEqual(price.verdicts[Verdict.FREE], sum(item.verdict == Verdict.FREE for item in answers))
            self.assertGreater(price.mean_cost["pairs"], 0.0)

    def test_every_question_of_a_scene_has_a_price(self) -> None:
        estimator = self.scene.estimate(tolerances=[1e-2], sample=2)
        states = np.zeros((3, 6)) + np.arange(3)[:, None] * 0.1
        of = {
            "check_states": (estimator.check_states("arm", states), 3),
            "check_motions": (estimator.check_motions("arm", states[:-1], states[1:]), 2),
            "check_path": (estimator.check_path("arm", states), 2),
            "distance": (estimator.distance("cone1"), 1),
            "collide": (estimator.collide(*self.cones), 8),
            "clearance": (estimator.clearance(0.5, *self.cones), 8),
        }
        for name, (estimate, items) in of.items():
            with self.subTest(name):
                self.assertEqual((estimate.items, estimate.sample), (items, min(items, 2)))
                self.assertTrue(all(price.median is not None for price in estimate))
                self.assertIn("depth", {price.output for price in estimate})

    def test_a_price_is_that_of_the_supposed_world(self) -> None:
        what_if = clearance.WhatIf(clearance.overlay(clearance.add_body("ball", clearance.sphere(0.5), clearance.pose([0.0, 2.0, 0.0]))))
        estimator = self.scene.estimate(tolerances=[1e-2], outputs=["distance"])
        (as_is,) = estimator.distance("cone0")
        (supposed,) = estimator.distance("cone0", what_if=what_if)
        self.assertEqual((as_is.verdicts[Verdict.FREE], supposed.verdicts[Verdict.COLLISION]), (1, 1))

    def test_what_cannot_be_is_named(self) -> None:
        with self.assertRaises(InvalidRequest) as raised:
            self.scene.estimate(tolerances=[1e-2, float("nan")]).distance("cone1")
        self.assertEqual(raised.exception.field, "tolerances[1]")
        with self.assertRaisesRegex(ValueError, "outputs: 'colour' is not known"):
            self.scene.estimate(outputs=["colour"])
