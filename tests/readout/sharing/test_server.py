"""`FingertipServer` and `tcp://` links, over real sockets."""

import re
import socket
import threading
import time

import numpy as np
import pytest

from lumitip import Fingertip, LinkEvent
from lumitip.errors import (
    AccessRefused,
    DeviceFailed,
    LinkError,
    LinkTimeout,
    LumitipError,
    NotConnected,
    SharingError,
    UrlError,
    WrongDesign,
)
from lumitip.links.base import Arrival
from lumitip.links.serve import SerialDevice
from lumitip.links.twin import Scene, packet_at, published_layout
from lumitip.protocol.messages import Kind, MessageDecoder, encode_request
from lumitip.protocol.packet import decode
from lumitip.session.timing import Timeline
from lumitip.sharing import FingertipServer


def test_every_client_gets_every_frame(serve) -> None:
    server = serve()
    with Fingertip.open(server.address) as one, Fingertip.open(server.address) as two:
        blocks = [tip.get_data(100, timeout=60.0) for tip in (one, two)]
        assert one.layout == server.layout == published_layout()
        assert one.device_id == server.device_id == "twin:disc"
        frame = one.wait_latest(10.0)
        assert frame.t_device is not None and 0.0 <= frame.t_host - frame.t < 60.0
    for block in blocks:
        assert block.dropped == 0
        assert block.raw.shape == (100, 32)


def _request(server: FingertipServer, receive_bytes: int) -> socket.socket:
    """A client that has sent its line and reads nothing yet."""
    client = socket.socket()
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
    client.settimeout(30.0)
    host, port = server.address.removeprefix("tcp://").split(":")
    client.connect((host, int(port)))
    client.sendall(encode_request(None))
    return client


@pytest.mark.slow
def test_a_slow_client_loses_the_oldest_and_slows_nobody(serve, until, caplog) -> None:
    server = serve("twin://disc?rate=2000&speed=0&noise=0", buffer=4096)
    with (
        _request(server, 4096) as slow,
        Fingertip.open(server.address, buffer=10**6) as fast,
    ):
        name = "{}:{}".format(*slow.getsockname())

        def dropped() -> int:
            return next(one.dropped for one in server.clients if one.name == name)

        frames = fast.frames(timeout=60.0)
        numbers = [next(frames).seq for _ in range(100)]
        until(lambda: dropped() > 300)
        assert fast.stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 0}
        assert np.diff(numbers).tolist() == [1] * 99
        decoder, timeline, lost = MessageDecoder(), Timeline(), 0
        end = time.monotonic() + 60.0
        while lost == 0 or lost != dropped():
            assert time.monotonic() < end, f"{lost} of {dropped()} lost frames are seen"
            for kind, payload in decoder.feed(slow.recv(4096)):
                if kind == Kind.PACKET:
                    lost += timeline.place(decode(payload, 32), time.monotonic()).lost or 0
    assert caplog.text.count("is too slow") == 1
    until(lambda: "has left" in caplog.text)
    assert re.search(rf"WARNING .*{name} has left: \d+ frames sent, [1-9]\d* drop", caplog.text)


def test_a_client_that_leaves_leaves_the_server_running(serve, until) -> None:
    server = serve()
    with Fingertip.open(server.address) as one:
        with Fingertip.open(server.address) as two:
            two.read(30.0)
            until(lambda: len(server.clients) == 2)
        until(lambda: len(server.clients) == 1)
        before = one.read(30.0).seq
        assert one.get_data(20, timeout=30.0).seq[0] == before + 1
    until(lambda: server.clients == ())
    with Fingertip.open(server.address) as three:
        three.read(30.0)


def test_a_device_that_fails_ends_every_client(serve, monkeypatch: pytest.MonkeyPatch) -> None:
    from lumitip.links import twin

    real, broken = twin.packet_at, threading.Event()

    def breaks(*arguments):
        if broken.is_set():
            raise ArithmeticError("broken")
        return real(*arguments)

    monkeypatch.setattr(twin, "packet_at", breaks)
    server = serve()
    with Fingertip.open(server.address) as one, Fingertip.open(server.address) as two:
        for tip in (one, two):
            tip.read(30.0)
        broken.set()
        for tip in (one, two):
            with pytest.raises(DeviceFailed, match="unexpected ArithmeticError: broken"):
                while True:
                    tip.read(30.0)
        with pytest.raises(LinkError, match="broken"):
            server.wait()


def test_a_server_that_comes_back_is_found_again(serve, until) -> None:
    events: list[str] = []
    server = FingertipServer("twin://disc?rate=200", port=0)
    address = server.address
    port = int(address.rpartition(":")[2])
    with Fingertip.open(address, on_event=lambda event: events.append(event.kind)) as tip:
        tip.read(30.0)
        server.close()
        until(lambda: "lost" in events)
        assert not tip.connected
        serve(port=port)
        until(lambda: tip.connected)
        before = tip.stats.received
        until(lambda: tip.stats.received > before)
        assert tip.stats.reconnects == 1


def test_other_computers_need_the_token(serve) -> None:
    server = serve(token="open sesame")
    address = server.address
    assert address.endswith("?token=open+sesame")
    with Fingertip.open(address) as tip:
        tip.read(30.0)
    for wrong in (address.partition("?")[0], address + "!"):
        for layout in (None, published_layout()):
            with pytest.raises(AccessRefused, match=r"token is missing or wrong. Open the address"):
                Fingertip.open(wrong, layout)
    assert "?token=" in serve(host="0.0.0.0").address
    with pytest.raises(SharingError, match="printable ASCII"):
        serve(token="sésame")


def test_a_port_that_is_taken_says_who_has_it(serve) -> None:
    server = serve()
    port = int(server.address.rpartition(":")[2])
    share = rf"`lumitip serve` shares twin:disc there\. Open tcp://127\.0\.0\.1:{port} instead, or"
    with pytest.raises(SharingError, match=rf"127\.0\.0\.1:{port} is taken: {share}"):
        serve(port=port)
    guarded = int(serve(token="secret").address.partition("?")[0].rpartition(":")[2])
    with pytest.raises(SharingError, match="Open the address that it has printed"):
        serve(port=guarded)
    with pytest.raises(SharingError, match="allowed are 0 to 65535"):
        serve(port=70000)


@pytest.mark.slow
def test_a_port_of_another_program_is_taken(serve) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]

        def answer() -> None:
            connection, _ = other.accept()
            with connection:
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

        threading.Thread(target=answer, daemon=True).start()
        with pytest.raises(SharingError, match=r"is taken: another program listens there. End it"):
            serve(port=port)


def test_what_is_no_server_is_an_error(unused_port: int) -> None:
    with pytest.raises(NotConnected, match=r"refused. Is `lumitip serve` running there\?"):
        Fingertip.open(f"tcp://127.0.0.1:{unused_port}")
    with pytest.raises(NotConnected, match="Is `lumitip serve` running"):
        Fingertip.open(f"tcp://localhost:{unused_port}", published_layout())
    for url in ("tcp://", "tcp://a:b", "tcp://host:0", "tcp://host:70000", "tcp://a/b:1"):
        with pytest.raises(UrlError, match="one like tcp://127"):
            Fingertip.open(url)
    with pytest.raises(UrlError, match="allowed are token"):
        Fingertip.open("tcp://localhost?tokn=1")


@pytest.fixture
def unused_port() -> int:
    """A port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port: int = listening.getsockname()[1]
    return port


@pytest.mark.parametrize(
    "options",
    [
        {"port": "8643"},
        {"host": 5},
        {"layout": 5},
        {"buffer": 0},
        {"timeout": -1},
        {"url": None},
        {"url": "twin"},
    ],
)
def test_wrong_arguments_are_one_error(options) -> None:
    with pytest.raises(LumitipError) as caught:
        FingertipServer(**{"url": "twin://disc", "port": 0, **options})
    assert "\n" not in str(caught.value)


def test_a_server_is_one_line(serve) -> None:
    server = serve()
    assert repr(server) == "<FingertipServer twin:disc at 127.0.0.1: 0 clients>"
    server.close()
    server.close()
    assert "ended" in repr(server)


def test_recordings_are_not_shared() -> None:
    with pytest.raises(SharingError, match="each program can open it without a server"):
        FingertipServer("replay://run.mcap", port=0)


def test_another_layout_is_rejected(serve, make_layout) -> None:
    server = serve()
    other = make_layout((4, 5, 4), 5.0)
    with pytest.raises(WrongDesign):
        Fingertip.open(server.address, other)
    with Fingertip.open(server.address, published_layout()) as tip:
        tip.read(30.0)


def test_faults_of_the_line_reach_the_clients(serve, until, tmp_path) -> None:
    import os

    layout, scene = published_layout(), Scene("empty", 0.0, 0.0, 100.0, 8, 0)
    port = tmp_path / "tty"
    with SerialDevice(port) as device:
        server = serve(f"serial://{port}", layout=layout)
        with Fingertip.open(server.address) as tip:
            until(lambda: len(server.clients) == 1)
            device.send(packet_at(layout, scene, 0, 1))
            os.write(device._mine, b"\0\x05abcd\0")
            device.send(packet_at(layout, scene, 3, 1))
            until(lambda: tip.stats.received == 2)
            assert tip.stats.unreadable == 1
            assert sum(tip.stats.dropped.values()) == 2
        with pytest.raises(NotConnected, match=r"program has it open.*lumitip serve serial"):
            Fingertip.open(f"serial://{port}", layout)


def test_legacy_frames_and_lost_devices_are_shared(serve, until, link) -> None:
    server = serve("ble://Published")
    with Fingertip.open(server.address) as tip:
        until(lambda: len(server.clients) == 1)
        link.deliver(Arrival(time.monotonic(), np.full(32, 55, np.uint8)))
        assert tip.wait_latest(30.0).values[0] == 200.0
        assert tip.stats.dropped is None
        link.report(LinkEvent("lost", "gone"))
        until(lambda: not tip.connected)
        with pytest.raises(LinkTimeout, match="is lost; reconnecting"):
            tip.wait_latest(0.01)
        with Fingertip.open(server.address) as late:
            until(lambda: not late.connected)
        link.report(LinkEvent("connected", "back"))
        until(lambda: tip.connected)
