"""Connections whose other end vanishes without a word, as after a power cut."""

import errno
import os
import socket
import threading

import pytest

from lumitip import listening
from lumitip.errors import NotConnected
from lumitip.links.tcp import Address, Connection
from lumitip.sharing import FingertipServer
from lumitip.sharing.client import Client

PROBES = {"TCP_KEEPIDLE": 5, "TCP_KEEPALIVE": 5, "TCP_KEEPINTVL": 2, "TCP_KEEPCNT": 3}


def _connection(server: FingertipServer) -> Connection:
    host, port = server.address.removeprefix("tcp://").split(":")
    return Connection(Address(host, int(port)), threading.Event())


def _probed(connection: socket.socket) -> dict[str, int]:
    """Its keepalive options, of those that this platform has."""
    assert connection.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)
    options = {name: getattr(socket, name) for name in PROBES if hasattr(socket, name)}
    return {
        name: connection.getsockopt(socket.IPPROTO_TCP, option) for name, option in options.items()
    }


def test_both_ends_probe_a_silent_connection(serve, monkeypatch: pytest.MonkeyPatch) -> None:
    accepted: list[socket.socket] = []
    real = Client.__init__

    def seen(client: Client, connection: socket.socket, name: str, size: int) -> None:
        accepted.append(connection)
        real(client, connection, name, size)

    monkeypatch.setattr(Client, "__init__", seen)
    with _connection(serve()) as connection:
        expected = {name: value for name, value in PROBES.items() if hasattr(socket, name)}
        assert _probed(connection._socket) == expected
        assert _probed(accepted[0]) == expected


def test_a_platform_without_the_options_probes_in_its_own_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in PROBES:
        monkeypatch.delattr(socket, name, raising=False)
    with socket.socket() as connection:
        listening.keep_alive(connection)
        assert connection.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)


def test_a_server_that_vanishes_is_a_lost_connection(serve) -> None:
    with _connection(serve()) as connection:
        real = connection._socket

        class Vanished:
            failed = False

            def recv(self, _: int) -> bytes:
                """Fail once, then end, as a socket of Linux does."""
                if self.failed:
                    return b""
                self.failed = True
                raise TimeoutError(errno.ETIMEDOUT, os.strerror(errno.ETIMEDOUT))

        connection._socket = Vanished()
        try:
            with pytest.raises(NotConnected, match=os.strerror(errno.ETIMEDOUT)):
                list(connection.messages())
        finally:
            connection._socket = real
