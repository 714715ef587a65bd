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
    DOORS = ["--no-shared-memory", "--no-zenoh"]

    @classmethod
    def setUpClass(cls) -> None:
        command = [PROGRAM, "serve", "--grpc-address", "127.0.0.1:0", *cls.DOORS]
        cls.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        cls.doors: dict[str, str] = {}
        cls.address = cls.door("grpc")
        cls.client = clearance.Client(cls.address, timeout=30.0)

    @classmethod
    def door(cls, kind: str) -> str:
        """The address of a door, as the daemon says it once it is open."""
        while kind not in cls.doors:
            line = cls.process.stdout.readline().split()
            if line[:1] != ["listening"] or len(line) != 3:
                cls.process.kill()
                raise RuntimeError(f"{PROGRAM} said {line}")
            cls.doors[line[1]] = line[2]
        return cls.doors[kind]

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


class ZenohTest(DaemonTest):
    """Gives every test a connection through zenoh as well: `self.through_zenoh`, and `self.zenoh_scene`, which is `self.scene`."""

    PREFIX = "site/clearance"
    DOORS = ["--no-shared-memory", "--zenoh-listen", "tcp/127.0.0.1:0", "--zenoh-prefix", PREFIX]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.through_zenoh = cls.connect()

    @classmethod
    def connect(cls, endpoint: str = "") -> clearance.Client:
        """Another connection, directly or by an endpoint that leads to the daemon's."""
        return clearance.Client(f"zenoh/{endpoint or cls.door('zenoh')}", zenoh_prefix=cls.PREFIX, timeout=30.0)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.through_zenoh.close()
        super().tearDownClass()

    def setUp(self) -> None:
        super().setUp()
        self.zenoh_scene = self.through_zenoh.scene(self.scene.name)
