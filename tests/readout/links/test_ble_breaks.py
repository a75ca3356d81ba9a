"""Bluetooth links that break, wait or end: bleak as installed against a fake `org.bluez`."""

import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from fake_bluez import FakeBluez
from fingertip_peers import HERE, THERE, add_fingertip, send
from lumitip import Fingertip, LinkEvent
from lumitip.errors import FingertipClosed, LinkTimeout, NotConnected

Until = Callable[..., None]


def test_a_cut_link_is_made_again(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    events: list[LinkEvent] = []
    with Fingertip.open("ble://Lumitip", device.layout, on_event=events.append) as tip:
        send(bluez, peer, device.packet(0, 4))
        until(lambda: tip.stats.received == 4)
        peer.refuse = 1
        bluez.cut(peer)
        until(lambda: not tip.connected)
        with pytest.raises(LinkTimeout, match="is lost; reconnecting"):
            tip.read(0.0)
        until(lambda: tip.stats.reconnects == 1)
        # A device time at which neither a quick nor a slow reconnection looks like a restart.
        send(bluez, peer, device.packet(10, 2, 5_000_000))
        assert tip.read(5.0).dropped_before == 6
        assert tip.stats.reconnects == 1
        assert tip.stats.dropped["link"] == 6
    assert [e.kind for e in events] == ["connected", "lost", "connected"]
    assert "disconnected" in events[1].detail


def test_a_cut_link_goes_back_to_the_same_device(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        namesake = add_fingertip(bluez, device, THERE)
        bluez.cut(peer)
        until(lambda: tip.stats.reconnects == 1)
        assert (peer.connections, namesake.connections) == (2, 0)


def test_a_device_that_is_switched_off_and_on_starts_anew(
    bluez: FakeBluez, device, until: Until
) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip?scan=0.3", device.layout) as tip:
        send(bluez, peer, device.packet(5000, 4))
        until(lambda: tip.stats.received == 4)
        bluez.remove(peer)
        until(lambda: not tip.connected)
        bluez.add(peer)
        until(lambda: tip.stats.reconnects == 1)
        send(bluez, peer, device.packet(0, 2))
        until(lambda: tip.stats.received == 6)
        assert tip.stats.restarts == 1
        assert tip.latest().seq == 5
        assert tip.latest().t_device == pytest.approx(0.002)


def test_firmware_that_starts_anew_under_a_link_that_stands(
    bluez: FakeBluez, device, until: Until
) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        send(bluez, peer, device.packet(60_000, 2), device.packet(0, 2), device.packet(2, 2))
        until(lambda: tip.stats.received == 6)
        stats = tip.stats
        assert (stats.restarts, stats.reconnects, stats.dropped["link"]) == (1, 0, 0)


@pytest.mark.slow_cases
@pytest.mark.parametrize("after", range(6))
def test_disconnected_at_any_moment(bluez: FakeBluez, device, after: int) -> None:
    """The link falls before the n-th of: connect, read, two subscriptions, first frames."""
    peer = add_fingertip(bluez, device)
    count = 0

    def falls() -> None:
        nonlocal count
        count += 1
        if count == after + 1:
            bluez._lost(f"/org/bluez/hci0/dev_{HERE.replace(':', '_')}")

    real_read, real_subscribe = peer.read, peer.subscribe

    async def read(uuid: str) -> bytes:
        falls()
        return await real_read(uuid)

    async def subscribe(uuid: str) -> None:
        falls()
        await real_subscribe(uuid)

    peer.read, peer.subscribe = read, subscribe
    connected = True
    try:
        tip = Fingertip.open("ble://Lumitip", device.layout)
    except NotConnected:
        assert after < 3, "it had connected"
        connected = False
        tip = Fingertip.open("ble://Lumitip", device.layout)
    with tip:
        for n in range(3):
            if after >= 3:
                bluez.call(falls)
            came = tip.stats.received
            while tip.stats.received == came:
                send(bluez, peer, device.packet(n))
                time.sleep(0.005)
        assert tip.latest().seq == 2
        assert tip.stats.reconnects == connected


@pytest.mark.slow
def test_nothing_is_lost_while_the_reader_sleeps_for_three_seconds(
    bluez: FakeBluez, device
) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        with pytest.raises(LinkTimeout):
            tip.read(0.0)

        def run() -> None:
            for n in range(0, 1500, 10):
                send(bluez, peer, *(device.packet(n + k, 2) for k in range(0, 10, 2)))
                time.sleep(0.02)

        sender = threading.Thread(target=run)
        sender.start()
        time.sleep(3.0)
        sender.join()
        assert [tip.read(5.0).seq for _ in range(1500)] == list(range(1500))
        assert sum(tip.stats.dropped.values()) == 0


@pytest.mark.usefixtures("bluez")
def test_closing_does_not_wait_for_a_scan(layout) -> None:
    began = time.monotonic()
    with pytest.raises(LinkTimeout, match=r"no connection after 0\.2 s"):
        Fingertip.open("ble://Lumitip?scan=60", layout, timeout=0.2)
    assert time.monotonic() - began < 30


def test_closing_wakes_a_reader(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    tip = Fingertip.open("ble://Lumitip", device.layout)
    errors: list[NotConnected] = []

    def read() -> None:
        try:
            tip.read(None)
        except NotConnected as error:
            errors.append(error)

    reader = threading.Thread(target=read)
    reader.start()
    tip.close()
    reader.join()
    assert isinstance(errors[0], FingertipClosed)
    until(lambda: not bluez.connected(peer))


@pytest.mark.slow
def test_a_program_that_ends_without_closing_disconnects(
    bluez: FakeBluez, device, until: Until, tmp_path: Path
) -> None:
    peer = add_fingertip(bluez, device)
    (tmp_path / "layout.json").write_text(device.layout.to_json(), encoding="utf-8")
    code = (
        "import sys; from lumitip import Fingertip; "
        f"tip = Fingertip.open('ble://Lumitip', {str(tmp_path / 'layout.json')!r})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert peer.connections == 1
    until(lambda: not bluez.connected(peer))


@pytest.mark.usefixtures("bus")
def test_without_bluetooth(layout) -> None:
    with pytest.raises(NotConnected, match="Is Bluetooth switched on"):
        Fingertip.open("ble://Lumitip", layout)
