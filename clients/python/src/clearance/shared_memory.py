"""Ask a daemon on the same machine through shared memory: numpy arrays in, numpy arrays out.

    pip install './clients/python[shared-memory]'

    with clearance.shared_memory.Client("clearance") as client:
        answer = client.check_states("cell", "arm", positions, distance=True)
        print(answer.verdicts, answer["nearest_lower"])

Scenes and robots are made through gRPC (:class:`clearance.Client`); the questions whose answers are long go this way. The
columns are those of docs/wire.md, by their names in lower case. One request at a time; a client is used by one thread.
"""

from __future__ import annotations

import ctypes
import os
import time
from typing import Any, Iterator, Mapping, Optional, Sequence, TypeVar

import numpy as np
from google.protobuf.message import Message

from .errors import (
    ClearanceError,
    Conflict,
    DeadlineExceeded,
    InvalidRequest,
    LimitExceeded,
    NotFound,
    RevisionGone,
    Unavailable,
)
from .shared_memory_layout import ABI_HASH, ALIGNMENT, COLUMNS, HEADERS, MAGIC, VERSION

try:
    import iceoryx2
except ImportError as error:  # pragma: no cover
    raise ImportError("clearance.shared_memory needs iceoryx2: pip install './clients/python[shared-memory]'") from error

Response = TypeVar("Response", bound=Message)

DEFAULT_NAME = "clearance"
DEFAULT_ROOT = "/tmp/clearance"

#: While it waits, a client looks this often whether the daemon is still alive, seconds.
_ALIVE = 0.25

_STATES, _MOTIONS, _PATH, _COLLIDE, _DISTANCE, _RAYS, _CALL = range(1, 8)
_EPOCH, _CUT_OFF, _ACCURACY, _MAX_PAIRS, _LAYERS, _MASK, _RESOLUTION, _MAX_STATES, _BUDGET, _DISREGARD = (
    1 << bit for bit in range(10)
)
_WANTS = {"distance": 1, "witness": 2, "depth": 4, "pairs": 8, "sides": 16}
_SHAPES = {"sphere": 1, "box": 2, "capsule": 3, "cylinder": 4, "cone": 5, "ellipsoid": 6, "point": 7}
_RAY_MODES = {"first": 0, "all": 1, "any": 2}
_BODY, _SHAPE, _SHAPE_OF_BODY = 2, 3, 5

_CODES: dict[int, tuple[str, type[ClearanceError]]] = {
    3: ("INVALID_ARGUMENT", InvalidRequest),
    4: ("DEADLINE_EXCEEDED", DeadlineExceeded),
    5: ("NOT_FOUND", NotFound),
    6: ("ALREADY_EXISTS", Conflict),
    8: ("RESOURCE_EXHAUSTED", LimitExceeded),
    9: ("FAILED_PRECONDITION", Conflict),
    10: ("ABORTED", Conflict),
    11: ("OUT_OF_RANGE", RevisionGone),
    13: ("INTERNAL", ClearanceError),
    14: ("UNAVAILABLE", Unavailable),
    15: ("DATA_LOSS", ClearanceError),
}


def _dtype(name: str) -> np.dtype:
    size, fields = HEADERS[name]
    formats = [(kind, (count,)) if count > 1 else kind for kind, count, _ in fields.values()]
    offsets = [offset for _, _, offset in fields.values()]
    return np.dtype({"names": list(fields), "formats": formats, "offsets": offsets, "itemsize": size})


_REQUEST, _RESPONSE, _SECTION = (
    _dtype(name) for name in ("clearance_request_header", "clearance_response_header", "clearance_section")
)
_NAMES = {kind: (name, element, per_row) for name, (kind, element, per_row) in COLUMNS.items()}
#: Columns of integers; the others of eight bytes are doubles.
_INTEGERS = {"declared_empty_not_listed", "ignore", "subject_ids", "hit_bodies", "grazed_bodies"} | {
    f"{pair}_{side}_id" for pair in ("nearest", "pair") for side in "ab"
}


class _Line(ctypes.Structure):
    """What messages are made of."""

    _fields_ = [("bytes", ctypes.c_uint8 * ALIGNMENT)]

    @staticmethod
    def type_name() -> str:
        return f"[u8; {ALIGNMENT}]"


class Answer(Mapping[str, np.ndarray]):
    """The columns of an answer by name, each a numpy array with a row an item (or a pair, or a hit)."""

    def __init__(
        self,
        header: np.void,
        columns: dict[str, np.ndarray],
        problems: dict[int, str],
        declared_empty: list[tuple[str, str]],
        declared_empty_not_listed: int,
    ):
        self._columns = columns
        #: Pairs that the scene declares empty, by the names of their sides: the answer says nothing of them.
        self.declared_empty = declared_empty
        #: How many more such pairs there are than are listed.
        self.declared_empty_not_listed = declared_empty_not_listed
        #: Which state of the scene was asked.
        self.epoch, self.revision = int(header["epoch"]), int(header["revision"])
        flags = int(header["flags"])
        #: The item that stopped the batch, if one did.
        self.stopped_at: Optional[int] = int(header["stopped_at"]) if flags & 1 else None
        #: Time ran out before every item was looked at.
        self.out_of_time = bool(flags & 2)
        #: What is wrong with the items that cannot be asked.
        self.problems = problems

    @property
    def verdicts(self) -> np.ndarray:
        """The numbers of :class:`clearance.Verdict`, of rays of :class:`clearance.CastVerdict`."""
        return self["verdicts"]

    def __getitem__(self, name: str) -> np.ndarray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


class Client:
    """A connection to the daemon that serves shared memory under `name`; `root` is its folder."""

    def __init__(self, name: str = DEFAULT_NAME, root: str = DEFAULT_ROOT):
        if not os.path.isdir(root):
            raise _unavailable(f"no daemon serves shared memory under the name {name!r}: there is no folder {root}")
        # What goes wrong comes back as an error.
        iceoryx2.set_log_level(iceoryx2.LogLevel.Fatal)
        config = iceoryx2.config.default()
        config.global_cfg.prefix = iceoryx2.FileName.new(f"{name}.")
        config.global_cfg.root_path = iceoryx2.Path.new(root)
        builder = iceoryx2.NodeBuilder.new().config(config)
        builder = builder.signal_handling_mode(iceoryx2.SignalHandlingMode.Disabled)
        self._node = builder.create(iceoryx2.ServiceType.Ipc)
        self._node.try_cleanup_dead_nodes()
        self._id = os.urandom(16)
        lines = iceoryx2.Slice[_Line]
        try:
            service = self._service(name, "questions").request_response(lines, lines)
            self._questions = service.open()
            attributes = self._questions.attributes
            theirs = _attribute(attributes, "abi_hash")
            if theirs != f"{ABI_HASH:016x}":
                text = f"the daemon's messages have the layout {theirs}, this client's {ABI_HASH:016x}"
                raise ClearanceError("FAILED_PRECONDITION", text, {})
            self._most = int(_attribute(attributes, "max_request_bytes"))
            asked = self._service(name, "asked").event().open()
            answered = self._service(name, "answered").event().open()
        except (iceoryx2.RequestResponseOpenError, iceoryx2.EventOpenError) as error:
            raise _unavailable(f"no daemon serves shared memory under the name {name!r}: {error}") from None
        space = os.statvfs("/dev/shm")
        if space.f_bavail * space.f_frsize < 3 * self._most + (1 << 20):
            raise _unavailable(f"/dev/shm has too little space for {3 * self._most} bytes")
        try:
            port = self._questions.client_builder().initial_max_slice_len(-(-self._most // ALIGNMENT))
            port = port.allocation_strategy(iceoryx2.AllocationStrategy.Static)
            self._port = port.backpressure_strategy(iceoryx2.BackpressureStrategy.DiscardData).create()
        except iceoryx2.ClientCreateError as error:
            raise _unavailable(f"the daemon takes no more shared-memory clients: {error}") from None
        _take_pages(f"{name}.")
        self._asked = asked.notifier_builder().create()
        listener = answered.listener_builder().name(iceoryx2.PortName.new(self._id.hex()))
        self._answered = listener.create()

    def _service(self, name: str, part: str) -> Any:
        return self._node.service_builder(iceoryx2.ServiceName.new(f"{name}/{part}"))

    def close(self) -> None:
        """Gives the place at the door back."""
        for port in (self._port, self._asked, self._answered):
            port.delete()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def check_states(self, scene: str, robot: str, positions: Any, **options: Any) -> Answer:
        """Is the robot free in these states? `positions` has a row a state, in the order of the robot's joints."""
        rows = np.atleast_2d(np.asarray(positions, dtype="<f8"))
        return self._ask(_STATES, scene, len(rows), {"robot": robot, "positions": rows}, options)

    def check_motions(self, scene: str, robot: str, starts: Any, goals: Any, **options: Any) -> Answer:
        """Is the robot free on the straight lines from each start to its goal? Rows as of :meth:`check_states`."""
        ends = [np.atleast_2d(np.asarray(end, dtype="<f8")) for end in (starts, goals)]
        rows = np.concatenate(ends, axis=1)
        return self._ask(_MOTIONS, scene, len(rows), {"robot": robot, "positions": rows}, options)

    def check_path(self, scene: str, robot: str, waypoints: Any, **options: Any) -> Answer:
        """Is the robot free along this path? The answer has an item less than there are waypoints."""
        rows = np.atleast_2d(np.asarray(waypoints, dtype="<f8"))
        return self._ask(_PATH, scene, len(rows), {"robot": robot, "positions": rows}, options)

    def collide(self, scene: str, **subjects: Any) -> Answer:
        """What touches? Subjects as of :meth:`distance`."""
        return self._subjects(_COLLIDE, scene, subjects)

    def distance(self, scene: str, **subjects: Any) -> Answer:
        """How far is the nearest?

        `bodies=ids`: each body against the others. `bodies=ids, poses=rows`: the bodies' shapes elsewhere; the bodies
        themselves are met unless `ignore` names them. `shape=(kind, numbers), poses=rows`: one shape at many poses; kinds are
        sphere, box, capsule, cylinder, cone, ellipsoid and point. A pose is `x y z` (metres) and a quaternion `w x y z`, world.
        """
        return self._subjects(_DISTANCE, scene, subjects)

    def cast_rays(self, scene: str, origins: Any, directions: Any, lengths: Any, mode: str = "first", **options: Any) -> Answer:
        """What does each ray meet? `mode` is `first`, `all` or `any`."""
        columns = {
            "origins": np.asarray(origins, dtype="<f8").reshape(-1, 3),
            "directions": np.asarray(directions, dtype="<f8").reshape(-1, 3),
            "lengths": np.atleast_1d(np.asarray(lengths, dtype="<f8")),
        }
        return self._ask(_RAYS, scene, len(columns["origins"]), columns, {**options, "mode": _RAY_MODES[mode]})

    def call(self, rpc: str, request: Message, response: type[Response], timeout: float = 10.0) -> Response:
        """Calls any rpc that answers with one message by its name: `call("Queries/Overlap", request, OverlapResponse)`.

        The messages are those of `clearance.v1`.
        """
        body = np.frombuffer(request.SerializeToString(), dtype="u1")
        answer = self._ask(_CALL, None, 0, {"rpc": rpc, "message": body}, {"timeout": timeout})
        return response.FromString(answer["response"].tobytes())

    def _subjects(self, question: int, scene: str, given: dict[str, Any]) -> Answer:
        options = dict(given)
        bodies, poses, shape = (options.pop(name, None) for name in ("bodies", "poses", "shape"))
        columns: dict[str, Any] = {}
        if poses is not None:
            columns["poses"] = np.atleast_2d(np.asarray(poses, dtype="<f8"))
        if bodies is not None:
            ids = np.atleast_1d(np.asarray(bodies, dtype="<u8"))
            count = max(len(ids), len(columns.get("poses", ids)))
            columns["subject_ids"] = np.broadcast_to(ids, count)
            kind = _BODY if poses is None else _SHAPE_OF_BODY
        elif shape is not None and poses is not None:
            name, numbers = shape
            count = len(columns["poses"])
            row = np.zeros(4)
            row[: len(numbers)] = numbers
            columns["shape_kinds"] = np.full(count, _SHAPES[name], dtype="u1")
            columns["shape_parameters"] = np.tile(row, (count, 1))
            kind = _SHAPE
        else:
            raise ValueError("bodies, or a shape and poses, have to be given")
        columns["subject_kinds"] = np.full(count, kind, dtype="u1")
        return self._ask(question, scene, count, columns, options)

    def _ask(self, question: int, scene: Optional[str], items: int, columns: dict[str, Any], options: dict[str, Any]) -> Answer:
        timeout = float(options.pop("timeout", 10.0))
        header = np.zeros((), dtype=_REQUEST)
        nonce = os.urandom(16)
        header["magic"] = np.frombuffer(MAGIC, dtype="u1")
        header["abi_hash"], header["version"] = ABI_HASH, VERSION
        header["nonce"] = np.frombuffer(nonce, dtype="u1")
        header["client"] = np.frombuffer(self._id, dtype="u1")
        header["question"], header["items"] = question, items
        header["timeout_ns"] = max(1, int(timeout * 1e9))
        columns = {**({} if scene is None else {"scene": scene}), **columns, **_described(header, options)}
        message = _message(header, columns)
        if len(message) > self._most:
            details = {"clearance-limit": "max_shared_memory_request_bytes", "clearance-reason": "LIMIT_EXCEEDED"}
            details |= {"clearance-asked": str(len(message)), "clearance-allowed": str(self._most)}
            raise LimitExceeded("RESOURCE_EXHAUSTED", f"{len(message)} bytes are more than {self._most}", details)
        return self._exchange(message, nonce, time.monotonic() + timeout, timeout)

    def _exchange(self, message: bytes, nonce: bytes, end: float, timeout: float) -> Answer:
        pending = self._send(message, end, timeout)
        looked = time.monotonic()
        while True:
            # Asked before the look for an answer, so that an answer sent before the end is not missed.
            connected = pending.is_connected
            response = pending.receive()
            if response is not None:
                answer = _read(_copied(response), nonce)
                if answer is not None:
                    return answer
                continue  # Somebody else's, who died.
            if not connected:
                raise _unavailable("the daemon went away before it answered")
            now = time.monotonic()
            if now >= end:
                raise _late(timeout)
            self._sleep(min(end - now, _ALIVE))
            if now - looked >= _ALIVE:
                # Only this makes the connection to a dead daemon end.
                self._node.try_cleanup_dead_nodes()
                looked = now

    def _send(self, message: bytes, end: float, timeout: float) -> Any:
        while True:
            room = self._port.loan_slice_uninit(len(message) // ALIGNMENT)
            ctypes.memmove(room.payload().as_ptr(), message, len(message))
            pending = room.assume_init().send()
            if pending.number_of_server_connections > 0:
                self._asked.notify()
                return pending
            if self._questions.dynamic_config.number_of_servers == 0:
                raise _unavailable("the daemon went away")
            if time.monotonic() >= end:
                raise _late(timeout)
            pending.delete()
            time.sleep(0.001)  # The daemon still has the request that was given up before.

    def _sleep(self, seconds: float) -> None:
        try:
            self._answered.timed_wait(iceoryx2.Duration.from_secs_f64(seconds))
        except iceoryx2.ListenerWaitError:
            time.sleep(min(seconds, 0.001))  # A signal only wakes.


def _described(header: np.ndarray, options: dict[str, Any]) -> dict[str, Any]:
    """Writes the options into the header; those that are columns come back."""
    rest = dict(options)
    flags = 0
    for want, bit in _WANTS.items():
        if rest.pop(want, False):
            header["wants"] |= bit
    for rule, name in ((1, "exactly"), (2, "at_least")):
        revision = rest.pop(name, None)
        if revision is not None:
            header["revision_rule"], header["revision"] = rule, revision
    optional = (
        ("epoch", "epoch", _EPOCH),
        ("cut_off", "cut_off", _CUT_OFF),
        ("max_pairs", "max_pairs", _MAX_PAIRS),
        ("layers", "layers", _LAYERS),
        ("mask", "mask", _MASK),
        ("resolution", "resolution", _RESOLUTION),
        ("max_states", "max_states", _MAX_STATES),
    )
    for name, field, flag in optional:
        value = rest.pop(name, None)
        if value is not None:
            header[field] = value
            flags |= flag
    budget = rest.pop("time_budget", None)
    if budget is not None:
        header["time_budget_ns"] = int(budget * 1e9)
        flags |= _BUDGET
    accuracy = rest.pop("accuracy", None)
    if accuracy is not None:
        header["accuracy_absolute"], header["accuracy_relative"] = accuracy
        flags |= _ACCURACY
    if rest.pop("disregard_allowed_collisions", False):
        flags |= _DISREGARD
    header["margin"] = rest.pop("margin", 0.0)
    header["mode"] = rest.pop("mode", 1 if rest.pop("stop_at_first", False) else 0)
    header["find"] = 1 if rest.pop("any_contact", False) else 0
    header["flags"] = flags
    columns: dict[str, Any] = {}
    groups: Optional[Sequence[str]] = rest.pop("groups", None)
    if groups:
        columns["groups"] = "".join(f"{group}\0" for group in groups)
    ignore = rest.pop("ignore", None)
    if ignore is not None:
        columns["ignore"] = np.atleast_1d(np.asarray(ignore, dtype="<u8"))
    if rest:
        raise TypeError(f"unknown options: {', '.join(sorted(rest))}")
    return columns


def _message(header: np.ndarray, columns: dict[str, Any]) -> bytes:
    table = np.zeros(len(columns), dtype=_SECTION)
    begin = _aligned(_REQUEST.itemsize + table.nbytes)
    parts: list[bytes] = []
    for entry, (name, value) in zip(table, columns.items()):
        kind, element, per_row = COLUMNS[name]
        if isinstance(value, str):
            body, stride = value.encode(), 1
        else:
            body = np.ascontiguousarray(value).tobytes()
            stride = element * (per_row or value.shape[1])
        entry["kind"], entry["stride"], entry["offset"], entry["bytes"] = kind, stride, begin, len(body)
        body = body.ljust(_aligned(len(body)), b"\0")
        parts.append(body)
        begin += len(body)
    header["sections"], header["total_bytes"] = len(table), begin
    head = header.tobytes() + table.tobytes()
    return b"".join([head.ljust(_aligned(len(head)), b"\0"), *parts])


def _aligned(size: int) -> int:
    return -(-size // ALIGNMENT) * ALIGNMENT


def _copied(response: Any) -> bytes:
    # The length is the message's own: that of the slice counts bytes in one version of iceoryx2 and elements in another.
    pointer = response.payload().as_ptr()
    header = np.frombuffer(ctypes.string_at(pointer, _RESPONSE.itemsize), dtype=_RESPONSE)[0]
    if bytes(header["magic"]) != MAGIC:
        raise ClearanceError("DATA_LOSS", "what came is no answer", {})
    return ctypes.string_at(pointer, int(header["total_bytes"]))


def _read(message: bytes, nonce: bytes) -> Optional[Answer]:
    header = np.frombuffer(message, dtype=_RESPONSE, count=1)[0]
    if int(header["abi_hash"]) != ABI_HASH:
        raise ClearanceError("FAILED_PRECONDITION", "the daemon was built for another layout", {})
    if bytes(header["nonce"]) != nonce:
        return None
    columns: dict[str, np.ndarray] = {}
    for entry in np.frombuffer(message, dtype=_SECTION, count=int(header["sections"]), offset=_RESPONSE.itemsize):
        name, element, per_row = _NAMES[int(entry["kind"])]
        number = {1: "u1", 4: "<u4", 8: "<u8" if name in _INTEGERS else "<f8"}[element]
        offset, count = int(entry["offset"]), int(entry["bytes"]) // element
        column = np.frombuffer(message, dtype=number, count=count, offset=offset)
        columns[name] = column.reshape(-1, per_row) if per_row > 1 else column
    if int(header["code"]) != 0:
        raise _refusal(int(header["code"]), columns)
    texts = columns.pop("problem_texts", np.empty(0, dtype="u1")).tobytes().decode().split("\0")
    items = columns.pop("problem_items", np.empty(0, dtype="<u4"))
    sides = columns.pop("declared_empty", np.empty(0, dtype="u1")).tobytes().decode().split("\0")
    left = int(columns.pop("declared_empty_not_listed", [0])[0])
    return Answer(header, columns, dict(zip(items.tolist(), texts)), list(zip(sides[:-1:2], sides[1::2])), left)


def _refusal(code: int, columns: dict[str, np.ndarray]) -> ClearanceError:
    text = {name: column.tobytes().decode() for name, column in columns.items()}
    lines = (line.partition("=") for line in text.get("error_details", "").splitlines())
    details = {f"clearance-{key}": value for key, _, value in lines}
    details["clearance-reason"] = text.get("error_reason", "")
    name, kind = _CODES.get(code, (str(code), ClearanceError))
    return kind(name, f"{name}: {text.get('error_message', '')}", details)


def _attribute(attributes: Any, key: str) -> str:
    for attribute in attributes.values:
        if attribute.key.to_string() == key:
            return attribute.value.to_string()
    return ""


def _take_pages(prefix: str) -> None:
    """Puts pages behind the segment: writing where /dev/shm is full would end the process."""
    for name in os.listdir("/dev/shm"):
        if name.startswith(prefix) and name.endswith(".data"):
            try:
                descriptor = os.open(f"/dev/shm/{name}", os.O_RDWR)
            except FileNotFoundError:
                continue
            try:
                size = os.fstat(descriptor).st_size
                if size:
                    os.posix_fallocate(descriptor, 0, size)
            except OSError as error:
                raise _unavailable(f"/dev/shm: {error}") from None
            finally:
                os.close(descriptor)


def _unavailable(text: str) -> Unavailable:
    return Unavailable("UNAVAILABLE", text, {})


def _late(timeout: float) -> DeadlineExceeded:
    return DeadlineExceeded("DEADLINE_EXCEEDED", f"no answer came in {timeout} s", {})
