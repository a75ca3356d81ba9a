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
from lumitip.errors import DeviceNotFound, LayoutError, LinkTimeout
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
    remember(other)
    remember(device.layout)
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
    remember(layout)
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
    with Fingertip.open(url, device.layout):
        pass
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


def test_the_last_optics_replace_those_before(layout: Layout) -> None:
    thicker = dataclasses.replace(
        layout, optics=dataclasses.replace(layout.optics, detector_depth_mm=2.0)
    )
    assert thicker == layout  # the same cells and wiring
    for used in (layout, thicker):
        remember(used)
        found = recall(layout.design_hash[:16], len(layout))
        assert found.to_json() == used.to_json()


def test_too_few_digits_choose_nothing(tmp_path: Path, layout: Layout, other: Layout) -> None:
    remember(layout, tmp_path)
    remember(other, tmp_path)
    assert recall(layout.design_hash[:4], len(layout), tmp_path) == layout
    assert recall(layout.design_hash[:4], len(other), tmp_path) is None
    assert recall("", len(layout), tmp_path) == layout
    again = dataclasses.replace(layout, x_mm=layout.x_mm + 0.5)
    remember(again, tmp_path)
    assert recall("", len(layout), tmp_path) is None


def test_a_damaged_file_is_passed_over(layout: Layout) -> None:
    remember(layout)
    (kept,) = (user_folder() / "layouts").iterdir()
    kept.write_text(kept.read_text()[:100])
    assert recall(layout.design_hash[:16], len(layout)) is None
    remember(layout)
    assert recall(layout.design_hash[:16], len(layout)) == layout


def test_a_folder_that_cannot_be_written_does_no_harm(line: Line, device) -> None:
    user_folder().mkdir(parents=True)
    (user_folder() / "layouts").touch()
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        assert tip.layout == device.layout
    assert recall(device.design, 32) is None
