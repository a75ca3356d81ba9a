"""MTU and GATT over a real ATT peer (bumble), bleak as installed between."""

from collections.abc import Callable

import pytest

from bumble_peer import BumblePeer
from fake_bluez import FakeBluez
from lumitip import Fingertip
from lumitip.errors import MtuTooSmall
from lumitip.protocol.bluetooth import FRAMES, LEGACY_FRAMES, LEGACY_SERVICE, SERVICE, STATUS
from lumitip.protocol.packet import largest_batch

HERE = "C0:FF:EE:00:00:09"
Until = Callable[..., None]


def _device(bluez: FakeBluez, mtu: int, legacy: bool = False) -> BumblePeer:
    if legacy:
        peer = BumblePeer("Lumitip", HERE, LEGACY_SERVICE, {LEGACY_FRAMES: ["read", "notify"]}, mtu)
    else:
        kinds = {FRAMES: ["notify"], STATUS: ["read", "notify"]}
        peer = BumblePeer("Lumitip", HERE, SERVICE, kinds, mtu)
    bluez.run(peer.power_on())
    bluez.add(peer)
    return peer


class Live(dict):
    """Values that tell the MTU of the moment, as firmware does."""

    def __init__(self, device, peer: BumblePeer) -> None:
        self._device, self._peer = device, peer

    def __getitem__(self, uuid: str) -> bytes:
        self._device.mtu = self._peer.mtu
        return self._device.status()


@pytest.mark.parametrize("mtu", [51, 158, 247])
def test_packets_of_the_largest_batch_come_whole(
    bluez: FakeBluez, device, until: Until, mtu: int
) -> None:
    peer = _device(bluez, mtu)
    peer.values = Live(device, peer)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        assert peer.mtu == mtu
        batch = largest_batch(mtu, 32, 8)
        assert batch == {51: 1, 158: 4, 247: 7}[mtu]
        for n in range(5):
            bluez.run(peer.notify(FRAMES, device.packet(n * batch, batch)))
        until(lambda: tip.stats.received == 5 * batch)
        assert sum(tip.stats.dropped.values()) == 0


@pytest.mark.parametrize("mtu", [23, 50])
def test_a_connection_that_takes_no_frame_is_refused(bluez: FakeBluez, device, mtu: int) -> None:
    peer = _device(bluez, mtu)
    peer.values = Live(device, peer)
    with pytest.raises(MtuTooSmall) as caught:
        Fingertip.open("ble://Lumitip", device.layout)
    assert (caught.value.mtu, caught.value.needed) == (mtu, 51)


def test_a_packet_cut_off_by_the_connection_is_counted(
    bluez: FakeBluez, device, until: Until
) -> None:
    peer = _device(bluez, 60)
    peer.values = Live(device, peer)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        for n, frames in [(0, 1), (1, 3), (4, 1)]:
            bluez.run(peer.notify(FRAMES, device.packet(n, frames)))
        until(lambda: tip.stats.received == 2)
        assert tip.stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 3}


def test_the_published_sensor_at_the_default_mtu_gives_twenty_bytes_and_is_refused(
    bluez: FakeBluez, layout
) -> None:
    peer = _device(bluez, 23, legacy=True)
    with Fingertip.open("ble://Lumitip", layout) as tip:
        bluez.run(peer.notify(LEGACY_FRAMES, bytes(32)))
        with pytest.raises(MtuTooSmall) as caught:
            tip.read(5.0)
        assert (caught.value.mtu, caught.value.needed) == (23, 35)


def test_the_published_sensor_at_a_larger_mtu(bluez: FakeBluez, layout, until: Until) -> None:
    peer = _device(bluez, 35, legacy=True)
    with Fingertip.open("ble://Lumitip", layout) as tip:
        bluez.run(peer.notify(LEGACY_FRAMES, bytes(range(32))))
        until(lambda: tip.stats.received == 1)
        assert tip.latest().raw.tolist() == list(range(32))


def test_a_connection_that_the_device_ends(bluez: FakeBluez, device, until: Until) -> None:
    peer = _device(bluez, 247)
    peer.values = Live(device, peer)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        bluez.run(peer.notify(FRAMES, device.packet(0)))
        until(lambda: tip.stats.received == 1)
        bluez.run(peer.disconnect())
        until(lambda: tip.stats.reconnects == 1)
        bluez.run(peer.notify(FRAMES, device.packet(9, time_us=5_000_000)))
        until(lambda: tip.stats.received == 2)
        assert tip.stats.dropped["link"] == 8
