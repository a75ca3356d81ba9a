"""A controller that names its design is opened without a file, once its layout was used here."""

import dataclasses
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from bluetooth_peers import ScriptedPeer
from fake_bluez import FakeBluez
from fingertip_peers import HERE, THERE, add_fingertip, send
from lumitip import Fingertip, FingertipGroup, Layout
from lumitip.calibration import user_folder
from lumitip.errors import DeviceNotFound, LayoutError, LinkTimeout, WrongDesign
from lumitip.known_layouts import recall, remember
from lumitip.protocol.bluetooth import LEGACY_FRAMES, LEGACY_SERVICE
from lumitip.protocol.packet import decode, encode
from serial_line import Line

V1 = {LEGACY_SERVICE: {LEGACY_FRAMES: ["read", "notify"]}}
Until = Callable[..., None]


@pytest.fixture
def other(make_layout: Callable[..., Layout]) -> Layout:
    return make_layout((4, 5, 4))


def test_bluetooth_needs_the_file_once(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout):
        pass
    until(lambda: not bluez.connected(peer))
    with Fingertip.open("ble://Lumitip") as tip:
        assert tip.layout == device.layout
        assert tip.device_id == f"ble:{HERE}"
        send(bluez, peer, device.packet(7, 1))
        until(lambda: tip.stats.received == 1)
        assert (tip.latest().raw == 7).all()
    until(lambda: not bluez.connected(peer))


def test_of_several_layouts_the_devices_own_is_taken(
    bluez: FakeBluez, device, other: Layout
) -> None:
    remember("ble:a", other)
    remember("ble:b", device.layout)
    add_fingertip(bluez, device)
    add_fingertip(bluez, type(device)(other), THERE, "Other")
    with FingertipGroup.open({"one": f"ble://{HERE}", "two": "ble://Other"}) as group:
        assert group.tips["one"].layout == device.layout
        assert group.tips["two"].layout == other


def test_an_unknown_design_asks_for_its_file(bluez: FakeBluez, device, until: Until) -> None:
    peer = add_fingertip(bluez, device)
    with pytest.raises(LayoutError) as caught:
        Fingertip.open("ble://Lumitip")
    assert f"{HERE} has 32 cells of design {device.design[:16]}" in str(caught.value)
    assert "--layout outputs/layout.json" in str(caught.value)
    until(lambda: not bluez.connected(peer))


def test_the_published_firmware_names_no_design(bluez: FakeBluez, layout: Layout) -> None:
    remember(f"ble:{HERE}", layout)
    bluez.add(ScriptedPeer("Old", HERE, V1))
    with pytest.raises(LayoutError, match="published firmware, which does not name its design"):
        Fingertip.open("ble://Old")


def test_another_device_is_no_fingertip(bluez: FakeBluez) -> None:
    bluez.add(ScriptedPeer("Lamp", HERE, {}))
    with pytest.raises(DeviceNotFound, match="is not a fingertip"):
        Fingertip.open("ble://Lamp")


@pytest.mark.usefixtures("bluez")
def test_a_device_that_is_not_there_ends_in_time() -> None:
    began = time.monotonic()
    with pytest.raises(LinkTimeout, match="ble://Lumitip: no answer"):
        Fingertip.open("ble://Lumitip", timeout=0.3)
    assert time.monotonic() - began < 5.0


@pytest.mark.parametrize(("bits", "kind"), [(8, np.uint8), (12, np.uint16)])
def test_a_serial_line_needs_the_file_once(
    line: Line, device, until: Until, bits: int, kind: type
) -> None:
    url = f"serial://{line.path}"
    stop = threading.Event()

    def sending() -> None:
        first = 0
        while not stop.wait(0.01):
            packet = decode(device.packet(first, 5), 32)
            values = packet.values.astype(kind)
            line.send(encode(dataclasses.replace(packet, bits=bits, values=values)))
            first += 5

    thread = threading.Thread(target=sending)
    thread.start()
    try:
        with Fingertip.open(url, device.layout) as tip:
            until(lambda: tip.stats.received)
        with Fingertip.open(url) as tip:
            assert tip.layout == device.layout
            until(lambda: tip.stats.received > 5)
    finally:
        stop.set()
        thread.join()


def test_a_serial_line_without_packets_says_so(line: Line) -> None:
    line.send_bytes(b"hello\0world\0")
    with pytest.raises(LinkTimeout, match=r"no packet in 0\.5 s"):
        Fingertip.open(f"serial://{line.path}", timeout=0.5)


def with_depth(layout: Layout, depth_mm: float) -> Layout:
    """The same cells and wiring, which have the same design hash, under other optics."""
    optics = dataclasses.replace(layout.optics, detector_depth_mm=depth_mm)
    return dataclasses.replace(layout, optics=optics)


def depth_mm(device_id: str, layout: Layout) -> float | None:
    found = recall(device_id, layout.design_hash[:16], len(layout))
    return found.optics.detector_depth_mm if found else None


def test_the_optics_are_those_of_the_device(layout: Layout) -> None:
    remember("left", with_depth(layout, 1.0))
    assert depth_mm("right", layout) == 1.0
    remember("right", with_depth(layout, 2.0))
    assert (depth_mm("left", layout), depth_mm("right", layout)) == (1.0, 2.0)
    assert depth_mm("third", layout) is None
    remember("left", with_depth(layout, 3.0))
    assert depth_mm("left", layout) == 3.0


def test_a_device_that_was_not_reached_changes_nothing(layout: Layout, tmp_path: Path) -> None:
    device_id = f"serial:{tmp_path}/ttyACM0"
    remember(device_id, layout)
    with pytest.raises(DeviceNotFound):
        Fingertip.open(f"serial://{tmp_path}/ttyACM0", with_depth(layout, 2.0))
    assert depth_mm(device_id, layout) == layout.optics.detector_depth_mm


def test_a_device_of_another_design_is_not_remembered(
    bluez: FakeBluez, device, make_layout: Callable[..., Layout]
) -> None:
    turned = make_layout()
    turned = dataclasses.replace(turned, channel=turned.channel[::-1])
    add_fingertip(bluez, device)
    with pytest.raises(WrongDesign):
        Fingertip.open("ble://Lumitip", turned)
    with Fingertip.open("ble://Lumitip", turned, any_design=True):
        pass
    assert not (user_folder() / "layouts").exists()


def test_few_digits_choose_by_the_number_of_cells(
    tmp_path: Path, layout: Layout, other: Layout
) -> None:
    remember("a", layout, tmp_path)
    remember("b", other, tmp_path)
    assert recall("c", layout.design_hash[:4], len(layout), tmp_path) == layout
    assert recall("c", layout.design_hash[:4], len(other), tmp_path) is None


@pytest.mark.parametrize("damage", [b"", b'{"cut', b"\xff\xfe\x80"])
def test_a_damaged_file_is_passed_over_and_replaced(layout: Layout, damage: bytes) -> None:
    remember("a", layout)
    (kept,) = (user_folder() / "layouts").iterdir()
    kept.write_bytes(damage)
    (kept.parent / f"odd.{layout.design_hash[:4]}.json").write_bytes(damage)
    assert depth_mm("a", layout) is None
    remember("a", layout)
    assert depth_mm("a", layout) == layout.optics.detector_depth_mm
    assert recall("c", layout.design_hash[:4], len(layout)) == layout


def test_programs_that_keep_at_the_same_time_do_not_meet(layout: Layout) -> None:
    remember("a", layout)
    stop = threading.Event()

    def keep(depth_mm: float) -> None:
        while not stop.is_set():
            remember("a", with_depth(layout, depth_mm))

    writers = [threading.Thread(target=keep, args=(depth,)) for depth in (1.0, 2.0)]
    for writer in writers:
        writer.start()
    found = [depth_mm("a", layout) for _ in range(200)]
    stop.set()
    for writer in writers:
        writer.join()
    assert None not in found
    assert [path.suffix for path in (user_folder() / "layouts").iterdir()] == [".json"]


def test_a_folder_that_cannot_be_written_does_no_harm(bluez: FakeBluez, device) -> None:
    user_folder().mkdir(parents=True)
    (user_folder() / "layouts").touch()
    add_fingertip(bluez, device)
    with Fingertip.open("ble://Lumitip", device.layout) as tip:
        assert tip.layout == device.layout
    assert recall(f"ble:{HERE}", device.design, 32) is None
