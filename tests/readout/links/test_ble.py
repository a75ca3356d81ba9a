"""Bluetooth: bleak as installed against a fake `org.bluez` on a private D-Bus."""

from collections.abc import Callable
from contextlib import suppress
from itertools import count

import pytest

from bluetooth_peers import ScriptedPeer
from fake_bluez import FakeBluez
from fingertip_peers import HERE, THERE, add_fingertip, send
from lumitip import Fingertip, FingertipGroup
from lumitip.errors import AmbiguousDevice, DeviceNotFound, LinkTimeout, MtuTooSmall, WrongDesign
from lumitip.protocol.bluetooth import FRAMES, LEGACY_FRAMES, LEGACY_SERVICE, STATUS, Fault

V1 = {LEGACY_SERVICE: {LEGACY_FRAMES: ["read", "notify"]}}

Until = Callable[..., None]


def test_frames_come_in_order(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        assert tip.device_id == f"ble:{HERE}"
        assert peer.subscribed == {FRAMES, STATUS}
        assert tip.latest() is None
        frames = []
        tip.subscribe(frames.append)
        send(bluez, peer, *(device.packet(n, 3) for n in range(0, 90, 3)))
        until(lambda: len(frames) == 90)
        assert [f.seq for f in frames] == list(range(90))
        assert all((f.raw == f.seq).all() for f in frames)
        assert tip.stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 0}
    until(lambda: not bluez.connected(peer))


def test_the_published_sensor_is_read(bluez: FakeBluez, layout, until: Until) -> None:
    peer = ScriptedPeer("Old", HERE, V1)
    bluez.add(peer)
    with Fingertip.open("ble://Old", layout) as tip:
        send(bluez, peer, bytes(range(32)), uuid=LEGACY_FRAMES)
        until(lambda: tip.stats.received == 1)
        frame = tip.latest()
        assert frame.values.tolist() == [255.0 - n for n in range(32)]
        assert frame.dropped_before is None
        assert tip.stats.dropped is None


def test_short_values_of_a_small_mtu_are_told_with_both_numbers(bluez: FakeBluez, layout) -> None:
    peer = ScriptedPeer("Old", HERE, V1, mtu=23)
    bluez.add(peer)
    with Fingertip.open("ble://Old", layout) as tip:
        send(bluez, peer, bytes(20), uuid=LEGACY_FRAMES)
        with pytest.raises(MtuTooSmall, match="is 23; a frame of this layout needs 35"):
            tip.read(5.0)


def test_a_device_whose_frames_do_not_fit_is_refused(bluez: FakeBluez, device) -> None:
    device.mtu = 23
    peer = add_fingertip(bluez, device)
    with pytest.raises(MtuTooSmall) as caught:
        Fingertip.open("ble://Lumitip", device.layout)
    assert (caught.value.mtu, caught.value.needed) == (23, 51)
    assert not bluez.connected(peer)


@pytest.mark.parametrize("early_mtu", [0, 23])
def test_a_status_from_before_the_mtu_was_agreed_is_read_again(
    bluez: FakeBluez, device, until: Until, monkeypatch: pytest.MonkeyPatch, early_mtu: int
) -> None:
    monkeypatch.setattr("lumitip.links.ble_device.MTU_WAIT_S", 10.0)
    peer = add_fingertip(bluez, device)
    agreed_mtu, device.mtu = device.mtu, early_mtu
    statuses = [device.status()] * 2
    device.mtu = agreed_mtu

    async def read(_: str) -> bytes:
        return statuses.pop() if statuses else device.status()

    peer.read = read
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        assert statuses == []
        send(bluez, peer, device.packet(0))
        until(lambda: tip.stats.received == 1)


def test_an_mtu_that_shrinks_later_is_told(bluez: FakeBluez, device) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        device.mtu = 23
        send(bluez, peer, device.status(), uuid=STATUS)
        with pytest.raises(MtuTooSmall):
            tip.read(5.0)


def test_faults_of_the_status_are_logged_once(
    bluez: FakeBluez, device, until: Until, caplog: pytest.LogCaptureFixture
) -> None:
    device.faults = Fault.WATCHDOG
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout):
        assert [r.getMessage() for r in caplog.records] == [f"{HERE}: its watchdog restarted it"]
        device.faults = Fault.WATCHDOG | Fault.AMBIENT
        for _ in range(2):
            send(bluez, peer, device.status(), uuid=STATUS)
        until(lambda: len(caplog.records) > 1)
    _, bright = (record.getMessage() for record in caplog.records)
    assert "reads as covered: shade the fingers" in bright


def test_repeated_late_and_damaged_packets(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    first = 2**16 - 8
    wrap_us = 2**32 - 9000
    sent = {n: device.packet(first + n, 2, wrap_us + n * 2000) for n in range(0, 16, 2)}
    damaged = bytes([*sent[6][:-1], sent[6][-1] ^ 1])
    order = [sent[0], sent[2], sent[2], sent[8], sent[4], damaged, sent[10][:20], sent[14]]
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        frames = []
        tip.subscribe(frames.append)
        send(bluez, peer, *order)
        until(lambda: len(frames) == 8)
        assert [f.seq for f in frames] == [0, 1, 2, 3, 8, 9, 14, 15]
        assert [f.dropped_before for f in frames] == [0, 0, 0, 0, 4, 0, 4, 0]
        assert frames[-1].t_device - frames[0].t_device == pytest.approx(0.03)
        stats = tip.stats
        assert stats.dropped == {"link": 4, "queue": 0, "crc": 0, "length": 4}
        assert (stats.repeated, stats.unreadable) == (4, 2)


def test_a_device_of_another_design_is_refused(bluez: FakeBluez, device, until: Until) -> None:
    device.design = "beef" * 16
    peer = add_fingertip(bluez, device)
    with pytest.raises(WrongDesign, match="design beefbeefbeefbeef; the layout has"):
        Fingertip.open("ble://Lumitip", device.layout)
    with Fingertip.open("ble://Lumitip", device.layout, any_design=True) as tip:
        send(bluez, peer, device.packet(0))
        until(lambda: tip.stats.received == 1)


def test_a_device_of_other_cells_is_always_refused(bluez: FakeBluez, device, make_layout) -> None:
    add_fingertip(bluez, device)
    with pytest.raises(WrongDesign):
        Fingertip.open("ble://Lumitip", make_layout((4, 5, 4), 6.0), any_design=True)


def test_two_devices_at_once(bluez: FakeBluez, device, until: Until) -> None:
    left = add_fingertip(bluez, device, HERE, "Left")
    right = add_fingertip(bluez, device, THERE, "Right")
    urls = {"left": "ble://Left", "right": f"ble://{THERE.lower()}"}
    with FingertipGroup.open(urls, device.layout) as group:
        assert group.tips["left"].device_id != group.tips["right"].device_id
        for tip in group.tips.values():
            with pytest.raises(LinkTimeout):
                tip.read(0.0)
        numbers, moments = count(), []

        def ten_moments() -> bool:
            # Packets that a busy computer delivers late shift one device's clock against the
            # other's: some of its frames then have no partner, so the devices go on sending.
            n = next(numbers)
            send(bluez, left, device.packet(n))
            send(bluez, right, device.packet(n + 100))
            with suppress(LinkTimeout):
                moments.append(group.read(0.05))
            return len(moments) == 10

        until(ten_moments)
        for name, tip in group.tips.items():
            assert {moment[name].device_id for moment in moments} == {tip.device_id}
        bluez.cut(left)
        send(bluez, right, device.packet(next(numbers) + 100))
        assert group.tips["right"].connected


def test_two_devices_of_one_name_are_refused_with_their_addresses(bluez: FakeBluez, device) -> None:
    add_fingertip(bluez, device, HERE)
    add_fingertip(bluez, device, THERE)
    with pytest.raises(AmbiguousDevice, match=f"Open one of ble://{HERE}, ble://{THERE}") as told:
        Fingertip.open("ble://Lumitip", device.layout)
    assert told.value.addresses == (HERE, THERE)
    with pytest.raises(AmbiguousDevice, match="the address has no name"):
        Fingertip.open("ble://", device.layout)
    with Fingertip.open(f"ble://{THERE}", device.layout) as tip:
        assert tip.device_id == f"ble:{THERE}"


def test_a_device_that_is_not_there(bluez: FakeBluez, device) -> None:
    add_fingertip(bluez, device, name="Other")
    with pytest.raises(
        DeviceNotFound, match=r"'Lumitip' was not found in 0\.2 s; found were Other"
    ):
        Fingertip.open("ble://Lumitip?scan=0.2", device.layout)
    with pytest.raises(DeviceNotFound, match=THERE):
        Fingertip.open(f"ble://{THERE}?scan=0.2", device.layout)


def test_a_device_that_is_no_fingertip(bluez: FakeBluez, layout) -> None:
    battery = "0000180f-0000-1000-8000-00805f9b34fb"
    bluez.add(ScriptedPeer("Lumitip", HERE, {battery: {battery.replace("180f", "2a19"): ["read"]}}))
    with pytest.raises(DeviceNotFound, match="is not a fingertip"):
        Fingertip.open("ble://Lumitip", layout)
    with pytest.raises(DeviceNotFound, match="'any fingertip' was not found"):
        Fingertip.open("ble://?scan=0.2", layout)
