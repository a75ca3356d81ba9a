"""Sockets that programs on other computers may connect to, the token that keeps others out, and
keepalive of connections."""

import hmac
import ipaddress
import secrets
import socket

from lumitip import arguments
from lumitip.errors import LumitipError

_KEEPALIVE = {"TCP_KEEPIDLE": 5, "TCP_KEEPALIVE": 5, "TCP_KEEPINTVL": 2, "TCP_KEEPCNT": 3}
"""Silence before the first probe (s; the second name is that of macOS), time between probes (s),
and number of probes without an answer that end the connection. Not every platform has them all."""


def keep_alive(connection: socket.socket) -> None:
    """Probe a silent TCP connection, so that it fails after 11 s if the other computer vanishes.

    Without the options of `_KEEPALIVE` it fails after the time that the platform sets, often 2 h.
    """
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in _KEEPALIVE.items():
        option = getattr(socket, name, None)
        if option is not None:
            connection.setsockopt(socket.IPPROTO_TCP, option, value)


def is_loopback(host: str) -> bool:
    """Whether an address is reached from this computer only."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def listen(host: str, port: int, error: type[LumitipError]) -> socket.socket:
    """A socket that listens on a TCP port; 0 is any free one.

    Raises:
        LumitipError: `error`, if the address cannot be used; its cause is the `OSError`.
    """
    arguments.instance(host, str, "host", error)
    if not arguments.count(port, "port", 0, error) < 1 << 16:
        raise error(f"port is {port}; allowed are 0 to 65535, 0 is any free one")
    listening = None
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
        listening.listen(128)
    except OSError as problem:
        if listening:
            listening.close()
        raise error(
            f"{host}:{port} cannot be used: {problem.strerror}. Choose another --host or --port; "
            "port 0 is any free one"
        ) from problem
    return listening


def server_token(token: str | None, host: str, error: type[LumitipError]) -> str | None:
    """The secret that clients must send: `token`, or else a random one unless `host` is a loopback
    address; `None` if none is needed.

    Raises:
        LumitipError: `error`, if the token cannot be sent.
    """
    if token and not (token.isascii() and token.isprintable()):
        raise error(f"the token is {token!r:.80}; printable ASCII characters are needed")
    return token or (None if is_loopback(host) else secrets.token_urlsafe(24))


def is_token(text: str, token: str) -> bool:
    """Whether a text is the token; the time that this takes does not depend on the text."""
    return hmac.compare_digest(text.encode("utf-8", "replace"), token.encode())


def public_host(host: str, port: int) -> str:
    """`host:port` of a listening socket, as other computers reach it."""
    name = socket.gethostname() if host in ("0.0.0.0", "::") else host
    return f"[{name}]:{port}" if ":" in name else f"{name}:{port}"
