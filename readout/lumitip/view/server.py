"""`ViewServer` and `Guard`: the web server of the live view, and its access control.

Pages of other sites in the same browser can send requests to this computer. Three rules keep them
out: the host name must be this computer's (against DNS rebinding), changes and the stream need the
origin of our own page, and other computers need the token.
"""

import ipaddress
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from urllib.parse import parse_qsl, urlencode

import uvicorn
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import cookie_parser
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from lumitip.errors import ViewError
from lumitip.interrupt import InterruptsHeld
from lumitip.links.occupant import listen_or_explain
from lumitip.listening import is_loopback, is_token, public_host, server_token
from lumitip.view.app import make_app
from lumitip.view.registry import FingerRegistry

DEFAULT_PORT = 8642
_HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class ViewServer:
    """Serves fingers until stopped; as a context manager on its own thread.

    Args:
        registry: the fingers, not yet open.
        host: address to listen on; all but loopback addresses need a token.
        port: 0 is any free one.
        token: secret that browsers must send; default: random if needed.

    Raises:
        ViewError: if the address is taken or cannot be used, or the token cannot be sent.
    """

    def __init__(
        self,
        registry: FingerRegistry,
        host: str = "127.0.0.1",
        port: int = DEFAULT_PORT,
        token: str | None = None,
    ) -> None:
        self.registry = registry
        self.token = server_token(token, host, ViewError)
        self._socket = listen_or_explain(host, port, ViewError)
        self.port: int = self._socket.getsockname()[1]
        self._host = host
        guard = Guard(make_app(registry), is_loopback(host), self.token, self.port)
        self._server = _Server(
            uvicorn.Config(
                guard,
                log_level="warning",
                ws_per_message_deflate=False,  # noise does not compress
                ws_max_size=1 << 16,
                timeout_graceful_shutdown=2,
            )
        )
        self._thread = threading.Thread(target=self.run, name="lumitip-server", daemon=True)

    @property
    def url(self) -> str:
        """Address for the browser."""
        return f"http://{public_host(self._host, self.port)}/" + (
            f"?{urlencode({'token': self.token})}" if self.token else ""
        )

    def run(self) -> None:
        """Serve until a signal or `stop`."""
        with self._socket, InterruptsHeld(self.stop):
            self._server.run(sockets=[self._socket])

    def stop(self) -> None:
        """End a running server. Thread-safe."""
        self._server.should_exit = True

    def __enter__(self) -> "ViewServer":
        self._thread.start()
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.stop()
        self._thread.join()


class _Server(uvicorn.Server):
    """A server without signal handlers: on a second Ctrl-C its own leave tasks half-done, which say
    so with a traceback. It ends within some 2 s anyway."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals to `ViewServer.run`."""
        yield


class Guard:
    """Passes requests to `app`, or rejects them.

    Args:
        loopback: whether the server listens on a loopback address only.
        token: secret that a browser must send, `None` if not needed.
        port: of the server, for the name of the cookie: ports share cookies.
    """

    def __init__(self, app: ASGIApp, loopback: bool, token: str | None, port: int) -> None:
        self._app = app
        self._loopback = loopback
        self._token = token
        self._cookie = f"lumitip_{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, _with_headers(send))
        elif scope["type"] == "websocket":
            # Closing before accepting answers the handshake with 403.
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": ""})
        else:
            await refusal(scope, receive, _with_headers(send))

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._is_here(host):
            return PlainTextResponse(f"Host {host!r} is not this live view.\n", 421)
        safe = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
        if not safe and headers.get("origin") != f"http://{host}":
            return PlainTextResponse("Only the page of the live view may send this request.\n", 403)
        return self._without_token(scope, headers) if self._token else None

    def _is_here(self, host: str) -> bool:
        name = host.rpartition(":")[0] if host.rpartition(":")[2].isdigit() else host
        name = name.strip("[]").lower().rstrip(".")
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            own = socket.gethostname().lower()
            return name == "localhost" or (
                not self._loopback and name in (own, f"{own}.local", own.partition(".")[0])
            )
        # DNS rebinding needs a name, so any address is safe.
        return address.is_loopback or not self._loopback

    def _without_token(self, scope: Scope, headers: Headers) -> Response | None:
        """`None` if the token is right; a token in the address moves into a cookie."""
        # Cookies of other programs on this host may be none by the standard: read as browsers do.
        if self._is_token(cookie_parser(headers.get("cookie", "")).get(self._cookie, "")):
            return None
        query = dict(parse_qsl(scope["query_string"].decode("latin-1")))
        if scope["type"] == "http" and self._is_token(query.pop("token", "")):
            assert self._token
            rest = f"?{urlencode(query)}" if query else ""
            moved = RedirectResponse(f"{scope['path']}{rest}", 303)
            # A strict one would not be sent where another site's link led to this address.
            moved.set_cookie(self._cookie, self._token, httponly=True, samesite="lax")
            return moved
        return PlainTextResponse(
            "The token is missing. Open the address that `lumitip view` has printed.\n", 401
        )

    def _is_token(self, text: str) -> bool:
        return is_token(text, self._token or "")


def _with_headers(send: Send) -> Send:
    async def send_with(message: Message) -> None:
        if message["type"] == "http.response.start":
            MutableHeaders(scope=message).update(_HEADERS)
        await send(message)

    return send_with
