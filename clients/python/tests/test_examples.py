"""The examples and the README do what they say; the generated code is that of the .proto files."""

import filecmp
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from .daemon import ROOT, DaemonTest

CLIENT = ROOT / "clients" / "python"
UR5 = ROOT / "tests" / "data" / "robot-ur5"


#: The shared-memory door of these tests; no other daemon of the machine has the name.
DOOR = f"python-examples-{os.getpid()}"


class Examples(DaemonTest):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.DOORS = ["--shared-memory-name", DOOR, "--shared-memory-root", cls.folder.name, "--zenoh-listen", "tcp/127.0.0.1:0"]
        super().setUpClass()

    @classmethod
    def tearDownClass(cls) -> None:
        super().tearDownClass()
        cls.folder.cleanup()

    def run_example(self, name: str, *arguments: str) -> str:
        address = [f"--address={self.address}"]
        command = [sys.executable, str(CLIENT / "examples" / name), *address, *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_first_query_prints_what_that_of_every_client_prints(self) -> None:
        for address in (self.address, f"zenoh/{self.door('zenoh')}"):
            command = [sys.executable, str(CLIENT / "examples" / "first_query.py"), address]
            done = subprocess.run(command, capture_output=True, text=True, timeout=120)
            self.assertEqual(done.stderr, "")
            self.assertEqual(done.stdout, (ROOT / "tests" / "data" / "first_query.txt").read_text())

    def test_a_path_that_is_free_and_one_that_is_blocked(self) -> None:
        free = self.run_example("straight_line_path.py", "--goal=1.57 -1.2 0 -1.57 -1.57 3.14")
        self.assertRegex(free, r"^free all the way, proved by \d+ states\n$")
        blocked = self.run_example("straight_line_path.py")
        self.assertRegex(blocked, r"^COLLISION after \d+ states; free at least up to \S+ % of the way\nfirst contact between")
        self.assertRegex(blocked, r"  forearm_link_0 and post: -\d")

    def test_derivatives_lead_bodies_to_where_they_should_touch(self) -> None:
        told = self.run_example("contact_alignment.py", "--shapes=ellipsoids", "--starts=20")
        methods = dict(re.findall(r"^(\w+) +reached +(\d+) of 20, \d+ separations", told, re.MULTILINE))
        self.assertEqual(len(methods), 5, told)
        # Of smooth shapes formulae lead nearly always; differences spend 24 separations on each step, which is no matter here.
        self.assertGreaterEqual(min(int(methods[name]) for name in ("exact", "smoothed_1_gumbel")), 15, told)

    def test_the_readme_of_the_client_runs(self) -> None:
        self.run_readme(CLIENT / "README.md")

    def test_the_readme_of_the_project_runs(self) -> None:
        self.run_readme(ROOT / "README.md", "scene.delete()")

    def run_readme(self, page: Path, ending: str = "") -> None:
        blocks = re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL)
        self.assertTrue(blocks)
        program = "\n".join([*blocks, ending]).replace("127.0.0.1:50551", self.address)
        program = program.replace("tcp/127.0.0.1:50552", self.door("zenoh"))
        program = program.replace('shared_memory.Client("clearance")', f'shared_memory.Client("{DOOR}", "{self.folder.name}")')
        # The page loads `ur5.urdf` from the folder it is run in.
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, cwd=UR5)
        self.assertEqual(done.returncode, 0, done.stderr)


class Generated(unittest.TestCase):
    def test_generating_again_changes_nothing(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, str(CLIENT / "regenerate.py"), folder], check=True, timeout=120)
            fresh, kept = Path(folder) / "clearance" / "v1", CLIENT / "src" / "clearance" / "v1"
            names = sorted(path.name for path in fresh.iterdir())
            self.assertEqual(names, sorted(path.name for path in kept.glob("*_pb2*")))
            different = [name for name in names if not filecmp.cmp(fresh / name, kept / name, shallow=False)]
            self.assertEqual(different, [], "run clients/python/regenerate.py")
