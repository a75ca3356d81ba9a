"""The serial line over a pseudo-terminal, pyserial as installed."""

import re
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
import serial
from serial.tools import list_ports, list_ports_common

from lumitip import Fingertip, LinkEvent
from lumitip.errors import AmbiguousDevice, DeviceNotFound, LinkTimeout, WrongDesign
from lumitip.protocol import cobs
from serial_line import Line

Until = Callable[..., None]


def test_frames_come_however_the_bytes_are_cut(line: Line, device, until: Until) -> None:
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        assert tip.device_id == f"serial:{line.path}"
        frames = []
        tip.subscribe(frames.append)
        data = b"".join(cobs.encode(device.packet(n, 2)) + b"\0" for n in range(0, 40, 2))
        for start in range(0, len(data), 17):
            line.send_bytes(data[start : start + 17])
        until(lambda: len(frames) == 40)
        assert [f.seq for f in frames] == list(range(40))
        assert all((f.raw == f.seq).all() for f in frames)
        assert sum(tip.stats.dropped.values()) == 0


def test_listening_begins_in_the_middle_of_a_packet(line: Line, device, until: Until) -> None:
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        line.send_bytes(cobs.encode(device.packet(0))[20:] + b"\0")
        line.send(device.packet(1), device.packet(2))
        until(lambda: tip.stats.received == 2)
        assert tip.stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 0}
        assert tip.stats.unreadable == 0


def test_a_device_that_sends_text_is_told(line: Line, device, until: Until) -> None:
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        for _ in range(20):
            line.send_bytes(b"12 40 255 7\r\n" * 100)
        until(lambda: tip.stats.unreadable == 1)
        with pytest.raises(LinkTimeout, match=r"without a delimiter: is this a fingertip\?"):
            tip.read(0.05)
        line.send_bytes(b"\0")
        line.send(device.packet(3))
        assert tip.read(5.0).raw[0] == 3


def test_damage_is_counted_by_its_kind_within_one_chunk(line: Line, device, until: Until) -> None:
    bad = bytearray(device.packet(2, 2))
    bad[20] ^= 0x40
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        line.send(
            device.packet(0, 2),
            bytes(bad),
            device.packet(4, 2),
            device.packet(6, 2)[:-5],
            device.packet(8, 2),
            device.packet(12, 2),
        )
        until(lambda: tip.stats.received == 8)
        assert tip.stats.dropped == {"link": 2, "queue": 0, "crc": 2, "length": 2}
        assert tip.stats.unreadable == 2


def test_repeated_and_late_packets(line: Line, device, until: Until) -> None:
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        frames = []
        tip.subscribe(frames.append)
        line.send(*(device.packet(n) for n in (65534, 65535, 65535, 65537, 65536, 65538)))
        until(lambda: len(frames) == 4)
        assert [f.seq for f in frames] == [0, 1, 3, 4]
        assert tip.stats.repeated == 2
        assert tip.stats.dropped["link"] == 1


def test_a_device_that_is_unplugged_and_comes_back(line: Line, device, until: Until) -> None:
    events: list[LinkEvent] = []
    url = f"serial://{line.path}"
    with Fingertip.open(url, device.layout, on_event=events.append) as tip:
        line.send(device.packet(3000))
        until(lambda: tip.stats.received == 1)
        line.unplug()
        until(lambda: not tip.connected)
        line.plug()
        until(lambda: tip.stats.reconnects == 1)
        line.send(device.packet(0), device.packet(1))
        until(lambda: tip.stats.received == 3)
        assert tip.stats.restarts == 1
    assert [e.kind for e in events] == ["connected", "lost", "connected", "restarted"]


def test_a_device_of_another_design(line: Line, device) -> None:
    device.design = "beef" * 16
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        line.send(device.packet(0))
        with pytest.raises(WrongDesign, match="design beef…"):
            tip.read(5.0)


@pytest.mark.parametrize("any_design", [False, True])
def test_a_device_of_another_number_of_cells(
    line: Line, device, make_layout, any_design: bool
) -> None:
    device.design = "beef" * 16
    url, other = f"serial://{line.path}", make_layout((4, 5, 4), 6.0)
    with Fingertip.open(url, other, any_design=any_design) as tip:
        line.send(device.packet(0), device.packet(1))
        told = (
            "design beef… with 32 cells; the layout has design "
            f"{other.design_hash[:4]}… with 13 cells"
        )
        with pytest.raises(WrongDesign, match=told) as caught:
            tip.read(5.0)
        assert caught.value.found == "beef…"


def test_a_packet_of_the_design_but_not_of_its_cells_is_a_fault(
    line: Line, device, make_layout, until: Until
) -> None:
    other = make_layout((4, 5, 4), 6.0)
    device.design = other.design_hash
    with Fingertip.open(f"serial://{line.path}", other) as tip:
        line.send(device.packet(0), device.packet(1))
        until(lambda: tip.stats.unreadable == 1)
        with pytest.raises(LinkTimeout, match=r"13 cells.*comes from a fingertip of 32 cells"):
            tip.read(0.0)


def test_two_devices_at_once(line: Line, device, tmp_path: Path, until: Until) -> None:
    other = Line(tmp_path / "ttyACM1")
    with (
        Fingertip.open(f"serial://{line.path}", device.layout) as one,
        Fingertip.open(f"serial://{other.path}", device.layout) as two,
    ):
        line.send(device.packet(0))
        other.send(device.packet(7), device.packet(8))
        until(lambda: (one.stats.received, two.stats.received) == (1, 2))
        assert one.latest().raw[0] == 0
        assert two.latest().raw[0] == 8
    other.unplug()


def test_nothing_is_lost_while_the_reader_sleeps(line: Line, device) -> None:
    with Fingertip.open(f"serial://{line.path}", device.layout) as tip:
        with pytest.raises(LinkTimeout):
            tip.read(0.0)
        # Far more than a pseudo-terminal holds: the link reads whether or not anyone else does.
        sender = threading.Thread(
            target=lambda: [line.send(device.packet(n, 2)) for n in range(0, 1500, 2)]
        )
        sender.start()
        sender.join()
        assert [tip.read(5.0).seq for _ in range(1500)] == list(range(1500))


def test_a_port_that_is_not_there_or_not_allowed(device, tmp_path: Path) -> None:
    with pytest.raises(DeviceNotFound, match="there is no such port; the ports are:"):
        Fingertip.open(f"serial://{tmp_path / 'ttyACM7'}", device.layout)


@pytest.mark.parametrize("name", ["notes.txt", "."])
@pytest.mark.parametrize("knows_layout", [True, False])
def test_a_path_that_is_no_port(device, tmp_path: Path, name: str, knows_layout: bool) -> None:
    (tmp_path / "notes.txt").write_text("", encoding="utf-8")
    layout = device.layout if knows_layout else None
    with pytest.raises(DeviceNotFound, match="this is no serial port; the ports are:"):
        Fingertip.open(f"serial://{tmp_path / name}", layout)


def test_without_a_port_the_only_usb_device_is_taken(
    line: Line, device, monkeypatch: pytest.MonkeyPatch, until: Until
) -> None:
    def usb(path: str, number: str) -> list_ports_common.ListPortInfo:
        port = list_ports_common.ListPortInfo(path)
        port.vid, port.pid, port.serial_number = 0x2341, 0x805A, number
        return port

    there = [usb(str(line.path), "SN1")]
    monkeypatch.setattr(list_ports, "comports", lambda: there)
    with Fingertip.open("serial://", device.layout) as tip:
        assert tip.device_id == "serial:SN1"
        line.send(device.packet(0))
        until(lambda: tip.stats.received == 1)
        # It comes back under another name.
        line.unplug()
        line.path = line.path.with_name("ttyACM5")
        line.plug()
        there[:] = [usb(str(line.path), "SN1")]
        until(lambda: tip.stats.reconnects == 1)
        line.send(device.packet(1))
        until(lambda: tip.stats.received == 2)
    there.append(usb("/dev/ttyACM9", "SN2"))
    with pytest.raises(AmbiguousDevice, match=re.escape("serial:///dev/ttyACM9")):
        Fingertip.open("serial://", device.layout)
    there.clear()
    with pytest.raises(DeviceNotFound, match="Plug the device in"):
        Fingertip.open("serial://", device.layout)


def test_a_port_in_use_is_told(line: Line, device) -> None:
    from lumitip.errors import LinkError

    with (
        serial.Serial(str(line.path), exclusive=True),
        pytest.raises(LinkError, match="ttyACM0"),
    ):
        Fingertip.open(f"serial://{line.path}", device.layout)
