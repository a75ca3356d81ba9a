"""`listen_or_explain`: a port to listen on, or an error that says which program has it."""

import errno
import http.client
import socket

from lumitip.errors import AccessRefused, LinkError, LumitipError
from lumitip.links.tcp import Address, ServerFull, greeting_of
from lumitip.listening import listen

_ANSWER_S = 1.25  # on this computer; asked twice
_PAGE_BYTES = 4096  # enough for the title of the live view's page


def listen_or_explain(host: str, port: int, error: type[LumitipError]) -> socket.socket:
    """A socket that listens on a TCP port; 0 is any free one.

    Raises:
        LumitipError: `error`, if the address cannot be used; if another program has it, the message
            says which and what to do.
    """
    try:
        return listen(host, port, error)
    except error as problem:
        cause = problem.__cause__
        if not isinstance(cause, OSError) or cause.errno != errno.EADDRINUSE:
            raise
        raise error(f"{host}:{port} is taken: {_occupant(Address(host, port))}") from cause


def _occupant(address: Address) -> str:
    """Who listens at an address, and what to do, for the user."""
    other = "choose another --port; port 0 is any free one"
    try:
        device = greeting_of(address, _ANSWER_S).device_id
    except (AccessRefused, ServerFull):
        return f"`lumitip serve` listens there. Open the address that it has printed, or {other}"
    except LinkError:
        if _is_live_view(address):
            return f"`lumitip view` listens there. Open the page that it has printed, or {other}"
        return f"another program listens there. End it, or {other}"
    return f"`lumitip serve` shares {device} there. Open {address} instead, or {other}"


def _is_live_view(address: Address) -> bool:
    connection = http.client.HTTPConnection(address.host, address.port, timeout=_ANSWER_S)
    try:
        connection.request("GET", "/")
        page = connection.getresponse().read(_PAGE_BYTES)
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()
    return b"<title>Lumitip<" in page or b"`lumitip view`" in page  # the latter without its token
