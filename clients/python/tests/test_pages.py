"""The code on pages of the documentation, as it stands there."""

import re
import tempfile
from pathlib import Path

import numpy as np

import clearance

from .daemon import ROOT, DaemonTest
from .test_overlays import CRANE


class Pages(DaemonTest):
    def test_streams(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "crane.urdf"
            urdf.write_text(CRANE)
            crane = self.client.load_robot(urdf)
        page = (ROOT / "docs" / "streams.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        self.assertEqual(len(blocks), 3)
        for block in blocks:
            exec(block, {"client": self.client, "clearance": clearance, "np": np, "crane": crane})
