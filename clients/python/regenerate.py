"""Generates src/clearance/v1 from proto/clearance/v1 again. Needs the extra `development`.

    python regenerate.py            # in clients/python
    python regenerate.py FOLDER     # elsewhere, to compare
"""

import sys
from pathlib import Path

import grpc_tools
from grpc_tools import protoc

HERE = Path(__file__).resolve().parent
PROTO = HERE.parent.parent / "proto"


def generate(folder: Path) -> None:
    """Writes `clearance/v1` under `folder`."""
    target = folder / "clearance" / "v1"
    target.mkdir(parents=True, exist_ok=True)
    sources = sorted(str(path) for path in (PROTO / "clearance" / "v1").glob("*.proto"))
    standard = Path(grpc_tools.__file__).parent / "_proto"
    outputs = [f"--{kind}_out={folder}" for kind in ("python", "pyi", "grpc_python")]
    if protoc.main(["protoc", f"-I{PROTO}", f"-I{standard}", *outputs, *sources]) != 0:
        raise SystemExit("protoc failed")
    for path in target.glob("*_pb2_grpc.py"):
        if "class " not in path.read_text():
            path.unlink()  # A file without services has nothing to call.


if __name__ == "__main__":
    generate(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "src")
