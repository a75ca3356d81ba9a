"""`Client`: one program that reads a shared fingertip, on its own thread of the server."""

import contextlib
import logging
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from lumitip.listening import keep_alive
from lumitip.protocol import messages
from lumitip.protocol.messages import Kind, MessageError

_log = logging.getLogger(__name__)
_REQUEST_S = 5.0  # longest wait for the whole line of a client
_SILENT_S = 0.25  # wait for a message before the connection is looked at
_SEND_BYTES = 1 << 14  # of the operating system: what it holds is old when a slow client reads it


class FullError(MessageError):
    """A client with the right token, for which there is no room."""


@dataclass(frozen=True)
class ClientCounts:
    """Counts of one client; a message of a fault counts as one frame."""

    name: str
    """Its address and port."""
    sent: int
    """Frames sent."""
    dropped: int
    """Frames dropped because it was too slow, the oldest first."""


class Client:
    """A connection; `put` may be called from any thread.

    Args:
        connection: accepted.
        name: address and port, for the user.
        size: frames that may wait; then the oldest are dropped.
    """

    def __init__(self, connection: socket.socket, name: str, size: int) -> None:
        self._socket = connection
        self._name = name
        self._size = size
        self._changed = threading.Condition()
        self._waiting: deque[tuple[bytes, int]] = deque()
        self._frames = self._sent = self._dropped = 0
        self._closed = False

    @property
    def counts(self) -> ClientCounts:
        """Counts so far."""
        with self._changed:
            return ClientCounts(self._name, self._sent, self._dropped)

    def put(self, message: bytes, frames: int = 0) -> None:
        """Queue a message that counts as some frames. Never waits."""
        with self._changed:
            if self._closed:
                return
            first = not self._dropped
            self._waiting.append((message, frames))
            self._frames += frames
            while self._frames > self._size:
                self._drop()
            self._changed.notify_all()
            slow = first and self._dropped > 0
        if slow:
            _log.warning("%s is too slow: its oldest frames are dropped", self._name)

    def run(self, joins: Callable[["Client", str], None]) -> None:
        """Serve until the client disconnects or `close`.

        Args:
            joins: called with the client and its token; queues the first message.
        """
        with self._socket:
            try:
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BYTES)
                self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                keep_alive(self._socket)
                joins(self, messages.decode_request(self._request()))
                self._send()
            except MessageError as error:
                with contextlib.suppress(OSError):
                    refusal = {"why": str(error), "full": isinstance(error, FullError)}
                    self._socket.sendall(messages.encode_json(Kind.REFUSED, refusal))
            except OSError as error:
                _log.debug("%s: %s", self._name, error)

    def close(self, now: bool) -> None:
        """End the connection: after the queued messages, or now."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if now:
            with contextlib.suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)

    def _request(self) -> bytes:
        until_s = time.monotonic() + _REQUEST_S
        line = b""
        while not line.endswith(b"\n"):
            left_s = until_s - time.monotonic()
            if left_s <= 0.0:
                raise TimeoutError(f"no line in {_REQUEST_S:g} s")
            self._socket.settimeout(left_s)
            chunk = self._socket.recv(messages.MOST_REQUEST_BYTES)
            line += chunk
            if not chunk or len(line) > messages.MOST_REQUEST_BYTES:
                raise MessageError("the line of a client is missing")
        self._socket.settimeout(None)
        return line

    def _send(self) -> None:
        while True:
            with self._changed:
                if not self._waiting and not self._closed:
                    self._changed.wait(_SILENT_S)
                message, frames = self._waiting.popleft() if self._waiting else (b"", 0)
                self._frames -= frames
                if not message and self._closed:
                    return
            if message:
                self._socket.sendall(message)
                with self._changed:
                    self._sent += frames
            elif self._has_left():
                return

    def _has_left(self) -> bool:
        self._socket.settimeout(0.0)
        try:
            return not self._socket.recv(1)
        except BlockingIOError:
            return False
        finally:
            self._socket.settimeout(None)

    def _drop(self) -> None:
        """Drop the oldest message that counts as frames; events stay."""
        at = next(i for i, (_, frames) in enumerate(self._waiting) if frames)
        _, frames = self._waiting[at]
        del self._waiting[at]
        self._frames -= frames
        self._dropped += frames
