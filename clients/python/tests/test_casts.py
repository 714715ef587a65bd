"""Rays, moving shapes, regions and neighbours."""

import unittest

import numpy as np

import clearance
from clearance import CastVerdict, Verdict

from .daemon import DaemonTest


class Casts(DaemonTest):
    def setUp(self) -> None:
        super().setUp()
        balls = (clearance.add_body(f"ball {x}", clearance.sphere(0.5), clearance.pose([x, 0, 0])) for x in (0, 3, 6))
        self.added = self.scene.apply(*balls).added

    def test_rays_come_back_as_arrays(self) -> None:
        directions = [[1, 0, 0], [0, 0, 2], [0, 0, 0]]
        answer = self.scene.cast_rays([[-2, 0, 0]], directions, length=20.0)
        self.assertEqual(
            [CastVerdict(v) for v in answer.verdicts], [CastVerdict.HIT, CastVerdict.CLEAR, CastVerdict.INVALID_INPUT]
        )
        np.testing.assert_allclose(answer.distances, [1.5, np.nan, np.nan], atol=1e-9)
        self.assertLessEqual(answer.lower[0], 1.5)
        self.assertLessEqual(1.5, answer.upper[0])
        np.testing.assert_allclose(answer.points, [[-0.5, 0, 0]], atol=1e-9)
        np.testing.assert_allclose(answer.normals, [[-1, 0, 0]], atol=1e-9)
        self.assertEqual(list(answer.problems), [2])
        every = self.scene.cast_rays([[-2, 0, 0]], [[1, 0, 0]], mode="all")
        self.assertEqual(tuple(every.bodies), self.added)
        np.testing.assert_allclose(0.5 * (every.lower + every.upper), [1.5, 4.5, 7.5], atol=1e-9)
        without = self.scene.cast_rays([[-2, 0, 0]], [[1, 0, 0]], ignore=["ball 0"])
        self.assertEqual(tuple(without.bodies), self.added[1:2])
        thick = self.scene.cast_rays([[-2, 0.75, 0]], [[1, 0, 0]], margin=0.5)
        self.assertEqual(thick.verdicts[0], CastVerdict.HIT)
        short = self.scene.cast_rays([[-2, 0, 0], [-2, 0, 0]], [[1, 0, 0], [1, 0, 0]], length=[1.0, 2.0], mode="any")
        self.assertEqual(list(short.verdicts), [CastVerdict.CLEAR, CastVerdict.HIT])
        with self.assertRaisesRegex(ValueError, "origins: needs shape"):
            self.scene.cast_rays([0, 0, 0], directions)
        with self.assertRaisesRegex(ValueError, "mode: is 'last'"):
            self.scene.cast_rays([[0, 0, 0]], directions, mode="last")

    def test_moving_shapes_meet_bodies_and_each_other(self) -> None:
        mover = clearance.moving("ball 0", displacement=[4, 0, 0])
        spinning = clearance.moving(clearance.box([2.0, 0.1, 0.1]), start=clearance.pose([1.5, 2, 0]), turn=[0, 0, np.pi])
        first, second = self.scene.cast_shapes(mover, spinning)
        (hit,) = first.hits
        self.assertEqual((first.verdict, hit.body), (CastVerdict.HIT, self.added[1]))
        self.assertLessEqual(hit.lower, 0.5)
        self.assertLessEqual(0.5, hit.upper)
        np.testing.assert_allclose(hit.normal, [-1, 0, 0], atol=1e-6)
        self.assertEqual(second.verdict, CastVerdict.HIT)
        away = clearance.moving(self.added[2], to=clearance.pose([6, 50, 0]))
        (clear,) = self.scene.cast_shapes(away)
        self.assertEqual((clear.verdict, clear.free_until), (CastVerdict.CLEAR, 1.0))
        other = clearance.moving("ball 3", displacement=[-4, 0, 0])
        (pair,) = self.scene.check_moving_pairs((mover, other))
        self.assertAlmostEqual(pair.hits[0].lower, 0.25, places=7)
        with self.assertRaisesRegex(ValueError, "to: cannot be given"):
            clearance.moving("ball 0", to=clearance.pose(), turn=[0, 0, 1])

    def test_regions_and_neighbours_name_bodies(self) -> None:
        box, ball, placed = self.scene.overlap(
            clearance.box_region([-1, -1, -1], [1, 1, 1]),
            clearance.ball_region([4.5, 0, 0], 1.25),
            clearance.shape_region(clearance.point(), clearance.pose([0, 9, 0])),
        )
        self.assertEqual(box.bodies, {self.added[0]: Verdict.COLLISION})
        self.assertEqual(tuple(ball.bodies), self.added[1:])
        self.assertEqual((placed.verdict, placed.bodies), (Verdict.FREE, {}))
        (loose,) = self.scene.overlap(clearance.box_region([0.4, 0.4, 0.4], [1, 1, 1]), bounds_only=True)
        self.assertEqual(loose.bodies, {self.added[0]: Verdict.NOT_RUN})
        (near,) = self.scene.nearest_bodies((clearance.point(), clearance.pose([5.5, 0, 0])), count=2)
        self.assertEqual([pair.b.id for pair in near.nearest], [self.added[2], self.added[1]])
        self.assertTrue(near.order_is_proved and near.set_is_proved)
        with self.assertRaises(clearance.InvalidRequest):
            self.scene.nearest_bodies("ball 0", count=0)


if __name__ == "__main__":
    unittest.main()
