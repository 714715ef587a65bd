"""Through shared memory: the same numbers as through gRPC, and errors that name the field."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import numpy as np

import clearance
from clearance import shared_memory
from clearance.v1 import query_pb2, scene_pb2, service_pb2

from .daemon import PROGRAM


URDF = """<robot name="crane">
  <link name="foot"/>
  <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="0" velocity="1" effort="1"/></joint>
</robot>"""


class SharedMemoryTest(unittest.TestCase):
    """A crane whose hook can reach a block."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.root = tempfile.mkdtemp()
        cls.name = f"python-{os.getpid()}"
        command = [PROGRAM, "serve", "--grpc-address", "127.0.0.1:0", "--shared-memory-name", cls.name]
        command += ["--shared-memory-root", cls.root, "--limit", "max_shared_memory_clients=2", "--no-zenoh"]
        cls.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        address = cls.process.stdout.readline().split()[2]
        # The doors' lines come in the order of the doors; there may be one between these two.
        while (line := cls.process.stdout.readline()) and line != f"listening shared-memory {cls.name}\n":
            pass
        assert line, "the daemon does not say where shared memory is"
        cls.client = clearance.Client(address, timeout=30.0)
        with open(os.path.join(cls.root, "crane.urdf"), "w", encoding="utf-8") as file:
            file.write(URDF)
        robot = cls.client.load_robot(file.name)
        cls.scene = cls.client.create_scene("cell")
        cls.applied = cls.scene.apply(
            clearance.add_robot("arm", robot),
            clearance.add_body("block", clearance.box([0.2, 0.2, 0.2]), clearance.pose([1.0, 0.0, -1.0])),
            clearance.add_body("ball", clearance.sphere(0.1), clearance.pose([1.0, 0.5, -0.9])),
        )
        cls.door = shared_memory.Client(cls.name, cls.root)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.door.close()
        cls.client.close()
        cls.process.terminate()
        code = cls.process.wait(timeout=30)
        cls.process.stdout.close()
        shutil.rmtree(cls.root)
        for name in os.listdir("/dev/shm"):
            if name.startswith(f"{cls.name}."):
                os.unlink(f"/dev/shm/{name}")
        if code != 0:
            raise RuntimeError(f"the daemon ended with {code}")

    def test_states_are_those_of_grpc(self) -> None:
        positions = np.random.default_rng(7).uniform([-0.5, -1.0], [1.5, 0.0], size=(500, 2))
        wanted = self.scene.check_states("arm", positions)
        answer = self.door.check_states("cell", "arm", positions, distance=True)
        self.assertEqual(answer.verdicts.tolist(), wanted.verdicts.tolist())
        self.assertEqual({1, 3}, set(answer.verdicts.tolist()))
        for column, brackets in (("nearest", wanted.nearest), ("self", wanted.nearest_self), ("scene", wanted.nearest_scene)):
            np.testing.assert_array_equal(answer.get(f"{column}_lower", brackets.lower * np.nan), brackets.lower)
            np.testing.assert_array_equal(answer.get(f"{column}_upper", brackets.upper * np.nan), brackets.upper)
        self.assertEqual((answer.epoch, answer.revision), (wanted.epoch, wanted.revision))

    def test_motions_say_where_they_meet(self) -> None:
        answer = self.door.check_motions("cell", "arm", [[1.5, -0.5], [0.0, -0.5]], [[0.0, -0.5], [0.0, -0.9]])
        self.assertEqual(answer.verdicts.tolist(), [1, 3])
        self.assertTrue(answer["reached_from"][1] <= 0.5 <= answer["reached_to"][1])
        self.assertTrue(np.isnan(answer["reached_from"][0]))
        path = self.door.check_path("cell", "arm", [[1.5, -0.5], [0.0, -0.5], [0.0, -0.9]])
        self.assertEqual(path.verdicts.tolist(), [1, 3])

    def test_pairs_declared_empty_are_listed(self) -> None:
        block = next(body for body in self.scene.contents().bodies)
        arm, other = clearance.robot("arm"), clearance.body(block.name)
        positions = [[1.5, -0.5]]
        self.assertEqual(self.door.check_states("cell", "arm", positions).declared_empty, [])
        self.scene.apply(clearance.declare_effects(arm, other, []))
        try:
            answer = self.door.check_states("cell", "arm", positions)
            self.assertEqual(answer.declared_empty, [("robot arm", f"body {block.id}")])
            cut = self.door.check_states("cell", "arm", positions, max_pairs=0)
            self.assertEqual((cut.declared_empty, cut.declared_empty_not_listed), ([], 1))
        finally:
            self.scene.apply(clearance.declare_effects(arm, other, None))

    def test_shapes_at_many_poses(self) -> None:
        poses = np.array([[1.0, 0.0, -0.5 + 0.1 * step, 1.0, 0.0, 0.0, 0.0] for step in range(5)])
        answer = self.door.distance("cell", shape=("sphere", [0.1]), poses=poses, sides=True, witness=True)
        # A ball of 0.1 m above the block's top at -0.8.
        wanted = poses[:, 2] - 0.1 + 0.8
        self.assertTrue(np.all(answer["nearest_lower"] <= wanted + 1e-12))
        self.assertTrue(np.all(answer["nearest_upper"] >= wanted - 1e-12))
        self.assertEqual(answer["nearest_b_kind"].tolist(), [3] * 5)
        np.testing.assert_allclose(answer["nearest_point_on_b"][:, 2], -0.8, atol=1e-9)
        block = int(answer["nearest_b_id"][0])
        moved = self.door.collide("cell", bodies=block, poses=poses, ignore=[block], pairs=True)
        self.assertEqual(moved.verdicts.tolist()[-1], 1)
        self.assertEqual(len(moved["pair_counts"]), 5)

    def test_rays_meet_the_block(self) -> None:
        answer = self.door.cast_rays("cell", [[1.0, 0.0, 1.0], [3.0, 0.0, 1.0]], [[0, 0, -1], [0, 0, -1]], 5.0)
        self.assertEqual(answer.verdicts.tolist(), [2, 1])
        self.assertTrue(answer["hit_lower"][0] <= 1.8 <= answer["hit_upper"][0])

    def test_any_rpc_is_called_by_its_name(self) -> None:
        request = query_pb2.CollideRequest(
            context=query_pb2.Context(scene="cell"),
            items=[query_pb2.Subject(all_pairs=query_pb2.AllPairs())],
        )
        through_grpc = self.client._queries.Collide(request)
        answer = self.door.call("Queries/Collide", request, service_pb2.CollideResponse)
        self.assertEqual(answer, through_grpc)
        edit = scene_pb2.Edit(remove_body=scene_pb2.RemoveBody(body=scene_pb2.BodyRef(name="nobody")))
        with self.assertRaises(clearance.Conflict) as caught:
            apply = service_pb2.ApplyRequest(scene="cell", edits=[edit])
            self.door.call("Scenes/Apply", apply, service_pb2.ApplyResponse)
        self.assertEqual(caught.exception.reason, "EDIT_REFUSED")
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.door.call("Scenes/Watch", request, service_pb2.CollideResponse)
        self.assertEqual(caught.exception.field, "rpc")

    def test_errors_name_reason_and_field(self) -> None:
        with self.assertRaises(clearance.NotFound) as caught:
            self.door.check_states("nowhere", "arm", [[0.0, 0.0]])
        self.assertEqual((caught.exception.code, caught.exception.reason), ("NOT_FOUND", "NOT_FOUND"))
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.door.check_states("cell", "arm", [[0.0, 0.0, 0.0]])
        self.assertEqual(caught.exception.field, "positions")
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.door.distance("cell", shape=("sphere", [-1.0]), poses=[[0, 0, 0, 1, 0, 0, 0]])
        self.assertEqual((caught.exception.field, caught.exception.item), ("shape_parameters[0]", 0))
        with self.assertRaises(clearance.LimitExceeded) as caught:
            self.door.check_states("cell", "arm", np.zeros((300_000, 2)))
        self.assertEqual(caught.exception.limit, "max_shared_memory_request_bytes")
        with self.assertRaises(clearance.Unavailable) as caught:
            self.door.check_states("cell", "arm", [[0.0, 0.0]], at_least=self.applied.revision + 9, timeout=0.3)
        self.assertEqual(caught.exception.reason, "REVISION_NOT_YET")
        with self.assertRaises(TypeError):
            self.door.check_states("cell", "arm", [[0.0, 0.0]], margni=0.1)
        answer = self.door.check_states("cell", "arm", [[0.0, np.nan], [1.0, -0.1]])
        self.assertEqual(answer.verdicts.tolist(), [6, 1])
        self.assertIn("position 1", answer.problems[0])

    def _state(self) -> str:
        with open(f"/proc/{self.process.pid}/stat", encoding="utf-8") as file:
            return file.read().rpartition(") ")[2][0]

    def test_a_stopped_daemon_costs_the_timeout(self) -> None:
        os.kill(self.process.pid, signal.SIGSTOP)
        try:
            # The signal is sent, and comes a moment later.
            while self._state() != "T":
                time.sleep(0.001)
            with self.assertRaises(clearance.DeadlineExceeded):
                self.door.check_states("cell", "arm", [[0.0, 0.0]], timeout=0.2)
        finally:
            os.kill(self.process.pid, signal.SIGCONT)
        for _ in range(20):
            self.assertEqual(len(self.door.check_states("cell", "arm", [[0.0, 0.0]] * 3).verdicts), 3)


if __name__ == "__main__":
    unittest.main()
