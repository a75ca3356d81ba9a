"""Room for clients: those that send no token take none from those that do."""

import socket
import time
from collections.abc import Callable
from contextlib import ExitStack

import pytest

from lumitip import Fingertip
from lumitip.errors import AccessRefused, NotConnected, SharingError
from lumitip.links.tcp import ServerFull
from lumitip.protocol.messages import Kind, MessageDecoder, decode_json, encode_request
from lumitip.sharing import FingertipServer, client, server

Serve = Callable[..., FingertipServer]
SECRET = "s3cret"


def _connect(shared: FingertipServer) -> socket.socket:
    host, port = shared.address.removeprefix("tcp://").partition("?")[0].split(":")
    return socket.create_connection((host, int(port)), 60.0)


def _is_closed(connection: socket.socket) -> bool:
    connection.settimeout(0.0)
    try:
        return not connection.recv(1 << 12)
    except BlockingIOError:
        return False
    except OSError:
        return True


def test_a_line_that_drips_ends_in_time(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client, "_REQUEST_S", 0.5)
    with _connect(serve(token=SECRET)) as drips:
        end_s = time.monotonic() + 20.0
        while not _is_closed(drips):
            assert time.monotonic() < end_s, "the server still waits"
            drips.settimeout(1.0)
            try:
                drips.send(b"{")
            except OSError:
                break
            time.sleep(0.1)


def test_clients_without_a_line_lock_nobody_out(
    serve: Serve, until: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "_REQUEST_S", 600.0)
    shared = serve(token=SECRET)
    with ExitStack() as stack:
        mute = [
            stack.enter_context(_connect(shared))
            for _ in range(server.MOST_WAITING + server.MOST_CLIENTS)
        ]
        for connection in mute:
            connection.send(b"{")
        with Fingertip.open(shared.address, timeout=60.0) as tip:
            tip.read(60.0)
        until(lambda: all(map(_is_closed, mute[: server.MOST_CLIENTS])))
        assert not any(map(_is_closed, mute[-server.MOST_WAITING + 1 :]))
        began_s = time.monotonic()
        shared.close()
        assert time.monotonic() - began_s < 30.0, "it waits for clients that say nothing"


@pytest.mark.slow
def test_a_full_server_says_so(
    serve: Serve, until: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "MOST_CLIENTS", 2)
    shared = serve(token=SECRET)
    why = "2 programs read twin:disc already, which is the limit. End one of them"
    with Fingertip.open(shared.address) as first:
        first.read(60.0)
        until(lambda: len(shared.clients) == 1)
        with Fingertip.open(shared.address) as second:
            second.read(60.0)
            until(lambda: len(shared.clients) == 2)
            with pytest.raises(NotConnected, match=f"^tcp://127.*: {why}$") as caught:
                Fingertip.open(shared.address)
            assert isinstance(caught.value, ServerFull), "so that a link tries again later"
            with pytest.raises(AccessRefused, match="the token is missing or wrong"):
                Fingertip.open(shared.address.partition("?")[0])
            with _connect(shared) as raw:
                raw.sendall(encode_request(SECRET))
                ((kind, payload),) = MessageDecoder().feed(raw.makefile("rb").read())
            assert (kind, decode_json(payload)) == (Kind.REFUSED, {"why": why, "full": True})
            port = int(shared.address.partition("?")[0].rpartition(":")[2])
            with pytest.raises(SharingError, match="`lumitip serve` listens there"):
                serve(port=port)
        until(lambda: len(shared.clients) == 1)
        with Fingertip.open(shared.address) as third:
            third.read(60.0)


@pytest.mark.slow
def test_the_connection_that_asks_for_the_layout_takes_no_room(
    serve: Serve, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "MOST_CLIENTS", 1)
    shared = serve("twin://disc?rate=1")
    for _ in range(3):
        with Fingertip.open(shared.address) as tip:
            assert tip.connected
