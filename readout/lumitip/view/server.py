"""`ViewServer`: the live view behind an address."""

import ipaddress
import secrets
import socket
import threading
from types import TracebackType
from urllib.parse import urlencode

import uvicorn

from lumitip.errors import ViewError
from lumitip.view.app import make_app
from lumitip.view.guard import Guard
from lumitip.view.room import Room

DEFAULT_PORT = 8642


class ViewServer:
    """Serves a room until it is stopped; as a context manager on a thread of its own.

    Args:
        room: not yet open.
        host: address to listen at; any but a loopback address needs a token.
        port: 0 takes a free one.
        token: what browsers must show; made up where one is needed and none given.

    Raises:
        ViewError: if the address cannot be listened at, or the token cannot be sent.
    """

    def __init__(
        self,
        room: Room,
        host: str = "127.0.0.1",
        port: int = DEFAULT_PORT,
        token: str | None = None,
    ) -> None:
        if token and not (token.isascii() and token.isprintable()):
            raise ViewError(f"token {token!r:.80} given, letters, digits and signs of ASCII go")
        loopback = _is_loopback(host)
        self.room = room
        self.token = token or (None if loopback else secrets.token_urlsafe(24))
        self._socket = _listen(host, port)
        self.port: int = self._socket.getsockname()[1]
        self._host = host
        guard = Guard(make_app(room), loopback, self.token, self.port)
        self._server = uvicorn.Server(
            uvicorn.Config(
                guard,
                log_level="warning",
                ws_per_message_deflate=False,  # values are noise: it would cost and gain nothing
                ws_max_size=1 << 16,
                timeout_graceful_shutdown=2,
            )
        )
        self._thread = threading.Thread(target=self.run, name="lumitip-server", daemon=True)

    @property
    def url(self) -> str:
        """What to open in a browser."""
        host = {"0.0.0.0": socket.gethostname(), "::": socket.gethostname()}.get(
            self._host, self._host
        )
        host = f"[{host}]" if ":" in host else host
        return f"http://{host}:{self.port}/" + (
            f"?{urlencode({'token': self.token})}" if self.token else ""
        )

    def run(self) -> None:
        """Serve until the process is asked to end, or `stop`."""
        with self._socket:
            self._server.run(sockets=[self._socket])

    def stop(self) -> None:
        """Ask a running server to end. From any thread."""
        self._server.should_exit = True

    def __enter__(self) -> "ViewServer":
        self._thread.start()
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.stop()
        self._thread.join()


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _listen(host: str, port: int) -> socket.socket:
    if not 0 <= port < 1 << 16:
        raise ViewError(f"port {port} given, allowed is 0 to 65535; 0 takes a free one")
    listening = None
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
        listening.listen(128)
    except OSError as error:
        if listening:
            listening.close()
        raise ViewError(
            f"{host}:{port} cannot be listened at: {error.strerror}; give another --host or "
            "--port, 0 takes a free port"
        ) from error
    return listening
