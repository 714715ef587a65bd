"""A daemon on a free port, for as long as the tests of a class run."""

import os
import subprocess
import unittest
from pathlib import Path

import clearance

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = os.environ.get("CLEARANCE_BIN", str(ROOT / "target" / "debug" / "clearance"))


class DaemonTest(unittest.TestCase):
    """Gives every test `self.client` and an empty `self.scene`."""

    #: What the daemon is told of its other doors.
    DOORS = ["--no-shared-memory"]

    @classmethod
    def setUpClass(cls) -> None:
        command = [PROGRAM, "serve", "--grpc-address", "127.0.0.1:0", *cls.DOORS]
        cls.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        line = cls.process.stdout.readline().split()
        if line[:2] != ["listening", "grpc"]:
            cls.process.kill()
            raise RuntimeError(f"{PROGRAM} said {line}")
        cls.address = line[2]
        cls.client = clearance.Client(cls.address, timeout=30.0)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.client.close()
        cls.process.terminate()
        try:
            code = cls.process.wait(timeout=30)
        finally:
            cls.process.stdout.close()
        if code != 0:
            raise RuntimeError(f"the daemon ended with {code}")

    def setUp(self) -> None:
        self.scene = self.client.create_scene(self.id())
        self.addCleanup(self.scene.delete)
