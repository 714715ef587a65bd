"""Scenes, edits, and questions about bodies."""

import unittest

import numpy as np

import clearance
from clearance import Verdict
from clearance.v1 import scene_pb2

from .daemon import DaemonTest


class Scenes(DaemonTest):
    def test_an_answer_comes_from_the_revision_that_holds_the_edit(self) -> None:
        first = self.scene.apply(clearance.add_body("ball", clearance.sphere(0.5)))
        (ball,) = first.added
        second = self.scene.apply(clearance.move_body("ball", clearance.pose([3.0, 0.0, 0.0])))
        self.assertEqual((first.revision, second.revision), (1, 2))
        subject = (clearance.point(), clearance.pose([0.0, 0.0, 0.0]))
        (answer,) = self.scene.distance(subject, at_least=second.revision)
        self.assertAlmostEqual(answer.nearest.signed_distance, 2.5, places=12)
        self.assertEqual((answer.nearest.a.kind, answer.nearest.b.id), ("query", ball))

    def test_the_broad_phase_is_chosen_with_the_scene(self) -> None:
        for kind in ("tree", "sweep_and_prune", "exhaustive"):
            scene = self.client.create_scene(f"scene with {kind}", broad_phase=kind)
            scene.apply(*(clearance.add_body(f"ball {x}", clearance.sphere(0.6), clearance.pose([x, 0, 0])) for x in (0, 1, 3)))
            (answer,) = scene.collide()
            self.assertEqual(len(answer.pairs), 1, kind)
            summary = next(one for one in self.client.scenes() if one.name == scene.name)
            name = scene_pb2.BroadPhase.Name(summary.broad_phase)
            self.assertEqual((summary.bodies, name), (3, f"BROAD_PHASE_{kind.upper()}"))
        with self.assertRaisesRegex(ValueError, "broad_phase: is 'octree'"):
            self.client.create_scene("never made", broad_phase="octree")

    def test_health_tells_what_a_scene_holds(self) -> None:
        self.scene.apply(*(clearance.add_body(f"ball {x}", clearance.sphere(0.1), clearance.pose([x, 0, 0])) for x in range(300)))
        self.scene.apply(clearance.move_body("ball 0", clearance.pose([0, 0, 1])))
        health = self.scene.health()
        self.assertEqual((health.bodies, health.tree.entries, [kept.revision for kept in health.kept]), (300, 300, [0, 1, 2]))
        self.assertGreater(health.kept[1].written_bytes, 5 * health.kept[2].written_bytes)
        self.assertGreaterEqual(health.kept_bytes, health.memory.bodies + health.memory.broad_phase)
        contents = self.scene.contents()
        self.assertEqual((len(contents.bodies), contents.body_count, contents.bodies_left), (300, 300, False))

    def test_a_patch_is_where_faces_touch(self) -> None:
        self.scene.apply(
            clearance.add_body("table", clearance.box([1, 1, 0.5]), clearance.pose([0, 0, -0.5])),
            clearance.add_body("book", clearance.box([0.1, 0.2, 0.02]), clearance.pose([0.5, 0, 0.019])),
            clearance.add_body("lamp", clearance.sphere(0.1), clearance.pose([0, 0, 2])),
        )
        (answer,) = self.scene.collide(want="patch")
        (pair,) = answer.pairs
        patch = pair.patch
        self.assertEqual((patch.corners, patch.points_on_a.shape, patch.truncated), (4, (4, 3), False))
        np.testing.assert_allclose(patch.normal, [0, 0, 1], atol=1e-9)
        np.testing.assert_allclose(patch.signed_distances, -1e-3, atol=1e-9)
        np.testing.assert_allclose(np.sort(patch.points_on_a[:, 0]), [0.4, 0.4, 0.6, 0.6], atol=1e-9)
        np.testing.assert_allclose(patch.points_on_b - patch.points_on_a, [[0, 0, -1e-3]] * 4, atol=1e-9)
        self.assertGreater(answer.cost.patch_corners, 0)
        (plain,) = self.scene.collide(want="witness")
        self.assertIsNone(plain.pairs[0].patch)
        self.assertEqual(plain.cost.patch_corners, 0)

    def test_derivatives_say_how_a_pair_changes(self) -> None:
        self.scene.apply(
            clearance.add_body("a", clearance.sphere(0.5)),
            clearance.add_body("b", clearance.sphere(0.25), clearance.pose([2, 0, 0])),
        )
        (answer,) = self.scene.distance(derivatives="exact")
        told = answer.nearest.derivatives
        np.testing.assert_allclose(told.of_a.signed_distance, [-1, 0, 0, 0, 0, 0], atol=1e-9)
        np.testing.assert_allclose(told.of_b.signed_distance, [1, 0, 0, 0, 0, 0], atol=1e-9)
        across = np.zeros((3, 6))
        across[1, 1] = across[2, 2] = 1
        np.testing.assert_allclose(told.of_b.normal, across / 2, atol=1e-9)
        np.testing.assert_allclose(told.of_b.point_on_a, across / 4, atol=1e-9)
        self.assertAlmostEqual(told.conditioning, 2, places=9)
        self.assertEqual((told.method, told.samples, told.is_valid, told.joints.shape), ("exact", 0, True, (0,)))
        (plain,) = self.scene.distance()
        self.assertIsNone(plain.nearest.derivatives)
        counters = (plain.cost.derivative_separations, plain.cost.derivative_supports, plain.cost.derivative_corners)
        self.assertEqual(counters, (0, 0, 0))

    def test_random_derivatives_are_reproduced_by_their_seed(self) -> None:
        self.scene.apply(
            clearance.add_body("a", clearance.box([0.5, 0.5, 0.5])),
            clearance.add_body("b", clearance.box([0.2, 0.3, 0.4]), clearance.pose([1.5, 0.1, 0.2])),
        )

        def sampled(seed: int) -> clearance.PairDerivatives:
            options = clearance.derivatives("smoothed_0", epsilon=0.1, samples=16, seed=seed)
            (pair,) = self.scene.clearance(2.0, derivatives=options)[0].pairs
            return pair.derivatives

        first = sampled(7)
        self.assertEqual((first.method, first.epsilon, first.samples, first.seed), ("smoothed_0", 0.1, 16, 7))
        self.assertTrue(np.isnan(first.conditioning))
        np.testing.assert_array_equal(sampled(7).of_b.point_on_b, first.of_b.point_on_b)
        self.assertFalse(np.array_equal(sampled(8).of_b.point_on_b, first.of_b.point_on_b))
        with self.assertRaisesRegex(ValueError, "derivatives: is 'guessed', known are exact, exact_cell, "):
            self.scene.distance(derivatives="guessed")
        with self.assertRaises(clearance.InvalidRequest) as refused:
            self.scene.distance(derivatives=clearance.derivatives(samples=0))
        self.assertEqual(refused.exception.field, "context.derivatives.samples")

    def test_what_is_declared_is_all_that_may_be_asked(self) -> None:
        crate, shelf = clearance.group("crates"), clearance.group("shelves")
        self.scene.apply(
            clearance.add_body("crate", clearance.sphere(0.5), groups=["crates"]),
            clearance.add_body("shelf", clearance.sphere(0.5), clearance.pose([0.9, 0, 0]), groups=["shelves"]),
            clearance.declare_effects(crate, shelf, ["distance"]),
        )
        with self.assertRaisesRegex(clearance.ClearanceError, "declared without the effect `witness`") as refused:
            self.scene.distance(want="witness")
        self.assertEqual((refused.exception.code, refused.exception.reason), ("FAILED_PRECONDITION", "EFFECT_NOT_DECLARED"))
        self.assertEqual(self.scene.distance(want="distance")[0].verdict, Verdict.COLLISION)
        self.scene.apply(clearance.declare_effects(crate, shelf, []))
        answers = self.scene.distance(want="distance")
        self.assertEqual((answers[0].verdict, answers[0].cost.pairs), (Verdict.FREE, 0))
        self.assertEqual([(pair.a.group, pair.b.group) for pair in answers.declared_empty], [("crates", "shelves")])
        self.scene.apply(clearance.declare_effects(crate, shelf, None))
        self.assertEqual(self.scene.distance(want="witness").declared_empty, ())
        with self.assertRaisesRegex(ValueError, "effects: 'sound' is none, known are verdict, margin"):
            clearance.declare_effects(crate, shelf, ["sound"])

    def test_distance_gives_bracket_points_and_normal(self) -> None:
        self.scene.apply(
            clearance.add_body("a", clearance.sphere(1.0)),
            clearance.add_body("b", clearance.box([1, 1, 1]), clearance.pose([0, 0, 5])),
        )
        (answer,) = self.scene.distance()
        pair = answer.nearest
        self.assertEqual(answer.verdict, Verdict.FREE)
        self.assertLessEqual(pair.bracket.lower, 3.0)
        self.assertLessEqual(3.0, pair.bracket.upper)
        np.testing.assert_allclose(pair.normal, [0, 0, 1], atol=1e-9)
        self.assertLessEqual(np.linalg.norm(pair.normal - [0, 0, 1]), pair.normal_error)
        self.assertLess(max(pair.normal_error, pair.point_error), 1e-3)
        np.testing.assert_allclose(pair.point_on_b - pair.point_on_a, pair.signed_distance * pair.normal, atol=1e-9)

    def test_every_solver_brackets_the_same_distance(self) -> None:
        self.scene.apply(
            clearance.add_body("a", clearance.box([1, 1, 1])),
            clearance.add_body("b", clearance.box([1, 2, 1]), clearance.pose([0, 0, 5])),
        )
        for solver in ("default", "frank_wolfe", "gjk", "gjk_polyak", "gjk_nesterov", "gjk_nesterov_normalised", "sat", "qp", "exact"):
            (answer,) = self.scene.distance(solver=solver)
            self.assertLessEqual(answer.nearest.bracket.lower, 3.0, solver)
            self.assertLessEqual(3.0, answer.nearest.bracket.upper, solver)

    def test_a_pair_that_a_solver_does_not_take_is_invalid_and_says_why(self) -> None:
        self.scene.apply(
            clearance.add_body("a", clearance.cone(1.0, 1.0)),
            clearance.add_body("b", clearance.box([1, 1, 1]), clearance.pose([0, 0, 5])),
        )
        (answer,) = self.scene.distance(solver="qp")
        self.assertEqual(answer.verdict, Verdict.INVALID_INPUT)
        self.assertIn("the solver qp does not take a cone and a box", answer.problem)

    def test_collide_lists_the_pairs_that_touch(self) -> None:
        ids = self.scene.apply(
            *(clearance.add_body(f"ball {x}", clearance.sphere(0.6), clearance.pose([x, 0, 0])) for x in (0, 1, 3))
        ).added
        (answer,) = self.scene.collide()
        self.assertEqual([(pair.a.id, pair.b.id) for pair in answer.pairs], [(ids[0], ids[1])])
        by_name, by_id = self.scene.collide("ball 3", ids[0])
        self.assertEqual((by_name.verdict, by_id.verdict), (Verdict.FREE, Verdict.COLLISION))

    def test_every_shape_is_understood(self) -> None:
        corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
        shapes = {
            "sphere": clearance.sphere(0.1),
            "point": clearance.point(),
            "box": clearance.box([1, 2, 3]),
            "capsule": clearance.capsule(0.1, 0.2),
            "cylinder": clearance.cylinder(0.1, 0.2),
            "cone": clearance.cone(0.1, 0.2),
            "ellipsoid": clearance.ellipsoid([1, 2, 3]),
            "convex": clearance.convex(corners),
            "segment": clearance.segment([0, 0, 0], [1, 1, 1]),
            "triangle": clearance.triangle([0, 0, 0], [1, 0, 0], [0, 1, 0]),
            "half_space": clearance.half_space([0, 0, 1], 0.0),
            "plane": clearance.plane([0, 0, 1], 0.0),
            "mesh": clearance.mesh(corners, faces, "solid"),
            "compound": clearance.compound([(clearance.sphere(0.1), clearance.pose([1, 0, 0]))]),
            "height_field": clearance.height_field([[0, 1], [1, 2]], [0.5, 0.5], -1.0),
            "point_cloud": clearance.point_cloud(corners, 0.1),
            "voxels": clearance.voxels(0.5, corners, cells=[[-3, 0, 0]]),
        }
        self.scene.apply(*(clearance.add_body(name, shape) for name, shape in shapes.items()))
        self.assertEqual([body.shape_kind for body in self.scene.contents().bodies], list(shapes))

    def test_margins_and_allowed_collisions_of_pairs(self) -> None:
        a, b = clearance.body("a"), clearance.body("b")
        self.scene.apply(
            clearance.add_body("a", clearance.sphere(1.0)),
            clearance.add_body("b", clearance.sphere(1.0), clearance.pose([2.5, 0, 0])),
            clearance.set_pair_margin(a, b, 1.0),
        )
        self.assertEqual(self.scene.distance()[0].verdict, Verdict.MARGIN)
        self.scene.apply(clearance.set_pair_margin(a, b, None), clearance.allow_collision(a, b))
        (answer,) = self.scene.distance()
        self.assertEqual((answer.verdict, answer.nearest), (Verdict.FREE, None))


class Fields(DaemonTest):
    def test_terrain_is_solid_below_its_surface(self) -> None:
        x = np.linspace(0.0, 2.0, 21)
        heights = np.add.outer(0.0 * x, x)  # Rising by 1 a metre along x.
        for dtype in (np.float64, np.float32):
            with self.subTest(dtype):
                self.scene.apply(clearance.add_body("hill", clearance.height_field(heights.astype(dtype), [0.1, 0.1], -1.0)))
                points = [(1.0, 2.0), (1.0, 0.5)]
                subjects = [(clearance.point(), clearance.pose([px, 1.03, pz])) for px, pz in points]
                over, under = self.scene.distance(*subjects)
                self.assertAlmostEqual(over.nearest.signed_distance, np.sqrt(0.5), places=6)
                self.assertEqual(under.verdict, Verdict.COLLISION)
                self.scene.apply(clearance.remove_body("hill"))

    def test_a_point_cloud_is_as_far_as_its_nearest_ball(self) -> None:
        points = np.random.default_rng(5).uniform(-1.0, 1.0, (5000, 3))
        self.scene.apply(clearance.add_body("cloud", clearance.point_cloud(points, 0.01)))
        for place in np.random.default_rng(6).uniform(-2.0, 2.0, (20, 3)):
            (answer,) = self.scene.distance((clearance.point(), clearance.pose(place)))
            gaps = np.linalg.norm(points - place, axis=1) - 0.01
            self.assertAlmostEqual(answer.nearest.signed_distance, gaps.min(), places=12)
            self.assertEqual(answer.nearest.b.subshape, gaps.argmin())

    def test_a_mapping_loop_inserts_points_and_clears_boxes(self) -> None:
        self.scene.apply(clearance.add_body("map", clearance.voxels(0.1)))
        (answer,) = self.scene.distance((clearance.point(), clearance.pose()))
        self.assertEqual((answer.verdict, answer.nearest), (Verdict.FREE, None))
        points = np.random.default_rng(7).uniform(0.5, 1.5, (2000, 3)).astype(np.float32)
        cells = np.unique(np.floor(points.astype(float) / 0.1), axis=0)
        for edit, kept in [
            (clearance.insert_points("map", points), cells),
            (clearance.clear_box("map", [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]), cells[(cells > 10).any(axis=1)]),
        ]:
            self.scene.apply(edit)
            (answer,) = self.scene.distance((clearance.point(), clearance.pose()))
            expected = np.linalg.norm(kept.clip(min=0.0) * 0.1, axis=1).min()
            self.assertAlmostEqual(answer.nearest.signed_distance, expected, places=9)

    def test_the_card_of_a_mesh_says_what_its_pieces_cost(self) -> None:
        cube = "".join(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8))
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        cube += "".join(f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}\n" for a, b, c, d in quads)
        card = self.client.describe_mesh(cube.encode(), "obj", "hull", scale=[2, 2, 2])
        self.assertEqual((card.pieces, card.closed), (1, True))
        # All of the hull's surface is at distance zero, so the work ends before the bracket is narrow.
        self.assertLess(card.inflation.lower, 1e-9)
        self.assertLess(max(card.loss.upper, card.inflation.upper), 0.05)
        card = self.client.describe_mesh(cube.encode(), "obj", accuracy=0.01)
        self.assertGreaterEqual(card.pieces, 1)
        self.assertLess(max(card.loss.upper, card.inflation.upper), 0.1)

    def test_arrays_of_the_wrong_shape_are_refused_before_they_are_sent(self) -> None:
        for make, field in [
            (lambda: clearance.height_field([1.0, 2.0], [1, 1], 0.0), "heights"),
            (lambda: clearance.height_field([[1.0, 2.0]] * 2, [1, 1, 1], 0.0), "spacing"),
            (lambda: clearance.height_field([["a", "b"]] * 2, [1, 1], 0.0), "heights"),
            (lambda: clearance.point_cloud([1.0, 2.0, 3.0]), "points"),
        ]:
            with self.subTest(field), self.assertRaisesRegex(ValueError, field):
                make()


class Refusals(DaemonTest):
    def test_an_error_names_item_and_field_and_changes_nothing(self) -> None:
        good, bad = clearance.sphere(1.0), clearance.box([1.0, -1.0, 1.0])
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.scene.apply(clearance.add_body("a", good), clearance.add_body("b", bad))
        error = caught.exception
        self.assertEqual((error.reason, error.item), ("INVALID_FIELD", 1))
        self.assertIn("half_extents", error.field)
        self.assertEqual(self.scene.contents().revision, 0)

    def test_non_finite_numbers_and_zero_quaternions_are_refused_by_name(self) -> None:
        for shape, pose, field in [
            (clearance.sphere(np.nan), clearance.pose(), "radius"),
            (clearance.sphere(1.0), clearance.pose([np.inf, 0, 0]), "translation"),
            (clearance.sphere(1.0), clearance.pose(rotation=[0, 0, 0, 0]), "rotation"),
        ]:
            with self.subTest(field), self.assertRaises(clearance.InvalidRequest) as caught:
                self.scene.apply(clearance.add_body("a", shape, pose))
            self.assertIn(field, f"{caught.exception.field} {caught.exception}")

    def test_a_lost_race_says_where_the_scene_is(self) -> None:
        self.scene.apply(clearance.add_body("a", clearance.point()))
        with self.assertRaises(clearance.Conflict) as caught:
            self.scene.apply(clearance.remove_body("a"), expected_revision=0)
        self.assertEqual((caught.exception.reason, caught.exception.revision), ("REVISION_MOVED_ON", 1))

    def test_unknown_names_are_not_found(self) -> None:
        with self.assertRaises(clearance.NotFound):
            self.client.scene("nowhere").contents()
        with self.assertRaises(clearance.NotFound):
            self.scene.distance("nobody")

    def test_a_revision_that_does_not_come_is_unavailable(self) -> None:
        with self.assertRaises((clearance.Unavailable, clearance.DeadlineExceeded)):
            self.scene.distance(at_least=7, timeout=0.2)

    def test_nobody_there_is_unavailable(self) -> None:
        with self.assertRaises(clearance.Unavailable):
            clearance.Client("127.0.0.1:1", timeout=5.0).scenes()

    def test_wrong_shapes_of_arrays_are_refused_before_anything_is_sent(self) -> None:
        for make in (
            lambda: clearance.box([1, 2]),
            lambda: clearance.convex([1, 2, 3]),
            lambda: clearance.mesh([[0, 0, 0]], [[0.0, 0.0, 0.0]]),
            lambda: clearance.mesh([[0, 0, 0]], [[0, 0, 0]], "blob"),
            lambda: clearance.pose(rotation=[1, 0, 0]),
            lambda: clearance.pose_from_matrix(2 * np.eye(4)),
            lambda: self.scene.check_states("arm", [1, 2, 3]),
            lambda: self.scene.distance(want="everything"),
            lambda: self.scene.distance(solver="guess"),
        ):
            with self.assertRaises(ValueError):
                make()


class Poses(unittest.TestCase):
    def test_matrices_become_the_same_rotation(self) -> None:
        chance = np.random.default_rng(7)
        for _ in range(200):
            q = chance.normal(size=4)
            q /= np.linalg.norm(q)
            w, (x, y, z) = q[0], q[1:]
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            matrix = np.eye(4)
            matrix[:3, :3] = np.eye(3) + 2 * w * cross + 2 * cross @ cross
            r = clearance.pose_from_matrix(matrix).rotation
            self.assertAlmostEqual(abs(np.dot(q, [r.w, r.x, r.y, r.z])), 1.0, places=12)
