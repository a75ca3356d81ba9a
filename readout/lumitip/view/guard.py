"""Who may use the live view: an ASGI layer in front of everything else.

A page of any site that is open in the same browser can send requests to this computer. It is kept
out thrice: the name asked for must be this computer's (so that a name of another site that points
here, DNS rebinding, is refused), whatever changes something or opens the stream must come from
our own page, and other computers need the token.
"""

import hmac
import ipaddress
import socket
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qsl, urlencode

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

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


class Guard:
    """Lets requests through to `app`, or refuses them.

    Args:
        loopback: whether the server listens to this computer alone.
        token: what a browser must show, `None` if nothing.
        port: of the server; cookies of one computer are shared by all its ports.
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
            # Refused before it is accepted, the handshake is answered with 403.
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
            return PlainTextResponse("This must be asked for by the live view's own page.\n", 403)
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
        # A page of another site has a name, so an address cannot be rebound.
        return address.is_loopback or not self._loopback

    def _without_token(self, scope: Scope, headers: Headers) -> Response | None:
        """Nothing if the token is shown; a token in the address moves into a cookie."""
        if self._is_token(_cookies(headers).get(self._cookie, "")):
            return None
        query = dict(parse_qsl(scope["query_string"].decode("latin-1")))
        if scope["type"] == "http" and self._is_token(query.pop("token", "")):
            assert self._token
            rest = f"?{urlencode(query)}" if query else ""
            moved = RedirectResponse(f"{scope['path']}{rest}", 303)
            moved.set_cookie(self._cookie, self._token, httponly=True, samesite="strict")
            return moved
        return PlainTextResponse(
            "The token is missing: open the address that `lumitip view` has printed.\n", 401
        )

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), (self._token or "").encode())


def _cookies(headers: Headers) -> dict[str, str]:
    try:
        return {name: told.value for name, told in SimpleCookie(headers.get("cookie", "")).items()}
    except CookieError:
        return {}


def _with_headers(send: Send) -> Send:
    async def send_with(message: Message) -> None:
        if message["type"] == "http.response.start":
            MutableHeaders(scope=message).update(_HEADERS)
        await send(message)

    return send_with
