"""What a client shows a daemon: tokens, certificates; and a Unix socket."""

import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import trustme

import clearance

from .daemon import PROGRAM

READER = "a-token-that-only-reads"
WRITER = "a-token-that-does-both"


class Daemon:
    """A daemon with its own configuration; ends with the `with` statement."""

    def __init__(self, configuration: str = "", address: str = "127.0.0.1:0"):
        self.folder = tempfile.TemporaryDirectory()
        file = Path(self.folder.name) / "clearance.toml"
        file.write_text(configuration)
        command = [PROGRAM, "serve", "--config", str(file), "--grpc-address", address.replace("FOLDER", self.folder.name)]
        command += ["--no-shared-memory", "--no-zenoh"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = ""

    def __enter__(self) -> "Daemon":
        line = self.process.stdout.readline().split()
        if line[:2] != ["listening", "grpc"]:
            self.process.kill()
            raise RuntimeError(f"{PROGRAM} said {line}")
        self.address = line[2]
        return self

    def __exit__(self, *_: object) -> None:
        self.process.terminate()
        try:
            code = self.process.wait(timeout=30)
        finally:
            self.process.stdout.close()
            self.folder.cleanup()
        if code != 0:
            raise RuntimeError(f"the daemon ended with {code}")


def with_token(folder: Path, name: str, token: str, scopes: str) -> str:
    """The part of a configuration that lets `token` in."""
    file = folder / name
    file.write_text(token)
    return f'[[grpc.tokens]]\nname = "{name}"\nfile = "{file}"\nscopes = {scopes}\n'


class TestTokens(unittest.TestCase):
    def test_a_token_allows_what_its_scopes_say(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            configuration = with_token(Path(folder), "reader", READER, '["read"]')
            configuration += with_token(Path(folder), "writer", WRITER, '["read", "write"]')
            with Daemon(configuration) as daemon:
                with clearance.Client(daemon.address, token=WRITER) as writer:
                    scene = writer.create_scene("cell")
                    scene.apply(clearance.add_body("ball", clearance.sphere(1.0), clearance.pose([0, 0, 0])))
                with clearance.Client(daemon.address, token=READER) as reader:
                    self.assertEqual([scene.name for scene in reader.scenes()], ["cell"])
                    with self.assertRaises(clearance.NotAllowed) as told:
                        reader.create_scene("another")
                    self.assertEqual((told.exception.code, told.exception.reason), ("PERMISSION_DENIED", "MISSING_SCOPE"))
                    self.assertEqual(told.exception.scope, "write")
                for shown, reason in [(None, "NO_TOKEN"), ("wrong-token-altogether", "UNKNOWN_TOKEN")]:
                    with clearance.Client(daemon.address, token=shown) as stranger:
                        with self.assertRaises(clearance.NotAllowed) as told:
                            stranger.server_info()
                        self.assertEqual((told.exception.code, told.exception.reason), ("UNAUTHENTICATED", reason))

    def test_a_token_that_cannot_be_sent_is_not_shown(self) -> None:
        with self.assertRaises(ValueError) as told:
            clearance.Client("127.0.0.1:1", token="secret\nsecret")
        self.assertNotIn("secret", str(told.exception))


class TestCertificates(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.ours, self.theirs = trustme.CA(), trustme.CA()
        for name, authority in [("ca", self.ours), ("other_ca", self.theirs)]:
            authority.cert_pem.write_to_path(str(self.path / f"{name}.pem"))
        for name, authority, host in [
            ("server", self.ours, "localhost"),
            ("me", self.ours, "planner@example.com"),
            ("stranger", self.theirs, "planner@example.com"),
        ]:
            made = authority.issue_cert(host)
            made.cert_chain_pems[0].write_to_path(str(self.path / f"{name}.pem"))
            made.private_key_pem.write_to_path(str(self.path / f"{name}_key.pem"))

    def configuration(self, client_ca: bool) -> str:
        lines = [
            "[grpc.tls]",
            f'certificate = "{self.path}/server.pem"',
            f'key = "{self.path}/server_key.pem"',
        ]
        return "\n".join(lines + [f'client_ca = "{self.path}/ca.pem"'] * client_ca)

    def test_tls_lets_in_who_trusts_the_daemon(self) -> None:
        with Daemon(self.configuration(False)) as daemon:
            address = daemon.address.replace("127.0.0.1", "localhost")
            for form in (address, f"https://{address}"):
                with clearance.Client(form, ca=self.path / "ca.pem") as client:
                    self.assertTrue(client.server_info().version)
            with clearance.Client(address, ca=self.path / "other_ca.pem", timeout=10.0) as client:
                with self.assertRaises(clearance.Unavailable):
                    client.server_info()

    def test_a_client_ca_lets_in_whom_it_signed(self) -> None:
        with Daemon(self.configuration(True)) as daemon:
            address = daemon.address.replace("127.0.0.1", "localhost")

            def asked(name: str) -> str:
                files = {"certificate": self.path / f"{name}.pem", "key": self.path / f"{name}_key.pem"} if name else {}
                with clearance.Client(address, ca=self.path / "ca.pem", timeout=10.0, **files) as client:
                    return client.server_info().version

            self.assertTrue(asked("me"))
            for stranger in ("", "stranger"):
                with self.assertRaises(clearance.Unavailable):
                    asked(stranger)
            self.assertTrue(asked("me"))

    def test_what_makes_no_sense_together_is_told(self) -> None:
        with self.assertRaisesRegex(ValueError, "go together"):
            clearance.Client("localhost:1", certificate=self.path / "me.pem")
        with self.assertRaisesRegex(ValueError, "no TLS"):
            clearance.Client("unix:/run/clearance.sock", ca=self.path / "ca.pem")


class TestUnixSocket(unittest.TestCase):
    def test_a_daemon_is_asked_through_a_socket(self) -> None:
        with Daemon(address="unix:FOLDER/clearance.sock") as daemon:
            self.assertTrue(daemon.address.startswith("unix:/"))
            with clearance.Client(daemon.address) as client:
                client.create_scene("cell")
                self.assertEqual([scene.name for scene in client.scenes()], ["cell"])


class TestLimits(unittest.TestCase):
    def test_a_client_beyond_its_rate_is_told_when_to_come_back(self) -> None:
        with Daemon("[limits]\nmax_client_items_per_second = 100\n") as daemon:
            with clearance.Client(daemon.address) as client:
                scene = client.create_scene("cell")
                balls = [clearance.add_body(f"{i}", clearance.sphere(1.0), clearance.pose([0, 0, i])) for i in range(150)]
                scene.apply(*balls)
                with self.assertRaises(clearance.LimitExceeded) as told:
                    client.scenes()
                self.assertEqual(told.exception.limit, "max_client_items_per_second")
                self.assertGreater(told.exception.retry_after, 0.0)
                self.assertLess(told.exception.retry_after, 1.0)
                time.sleep(told.exception.retry_after)
                self.assertEqual(len(client.scenes()), 1)
