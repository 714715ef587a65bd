"""Where what arrives waits for its reader."""

from __future__ import annotations

import queue
import threading
from typing import Generic, Optional, TypeVar

T = TypeVar("T")

#: Bytes that wait at most. Whoever brings more would have to wait, and with them everything else that arrives.
_MOST = 256 << 20


class Inbox(Generic[T]):
    """Things in the order of their arrival, for one reader; any thread may bring them, and never waits."""

    def __init__(self, spilled: T, most: int = _MOST):
        """Where something would be more than `most` bytes together with what waits, `spilled` takes its place, once until it is read."""
        self._things: queue.SimpleQueue[tuple[T, int]] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._waiting = 0
        self._most = most
        self._spilled = spilled
        self._spills = False

    def put(self, thing: T, size: int = 0) -> None:
        """Brings something of so many bytes; what has none is never too much."""
        with self._lock:
            if size and self._waiting and self._waiting + size > self._most:
                if self._spills:
                    return
                thing, size, self._spills = self._spilled, 0, True
            self._waiting += size
            self._things.put((thing, size))

    def take(self, timeout: Optional[float] = None) -> T:
        """Waits for the next thing; raises `queue.Empty` if there is none after so many seconds."""
        thing, size = self._things.get(timeout=timeout)
        with self._lock:
            self._waiting -= size
            if thing is self._spilled:
                self._spills = False
        return thing
