"""`lumitip scan`: what can be seen over Bluetooth and on USB."""

import pytest
from serial.tools import list_ports, list_ports_common

from bluetooth_peers import ScriptedPeer
from fake_bluez import FakeBluez
from lumitip.cli import main
from lumitip.links.scan import scan
from lumitip.protocol.bluetooth import LEGACY_SERVICE, SERVICE

ONE, TWO, THREE = (f"C0:FF:EE:00:00:0{n}" for n in (1, 2, 3))


@pytest.fixture
def _one_port(monkeypatch: pytest.MonkeyPatch) -> None:
    usb, board = (list_ports_common.ListPortInfo(path) for path in ("/dev/ttyACM3", "/dev/ttyS0"))
    usb.vid, usb.pid, usb.serial_number, usb.product = 0x2341, 0x805A, "SN1", "Nano 33 BLE"
    monkeypatch.setattr(list_ports, "comports", lambda: [board, usb])


@pytest.mark.usefixtures("_one_port")
def test_fingertips_and_usb_ports_are_listed(
    bluez: FakeBluez, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, address, service in [
        ("Lumitip", ONE, SERVICE),
        ("Old", TWO, LEGACY_SERVICE),
        ("Lumitip", THREE, SERVICE),
    ]:
        bluez.add(ScriptedPeer(name, address, {service: {}}))
    bluez.add(ScriptedPeer("Kettle", "C0:FF:EE:00:00:09", {SERVICE.replace("7d1c", "0000"): {}}))
    assert main(["scan", "--seconds", "0.3"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [
        "serial:///dev/ttyACM3",
        f"ble://{ONE}",
        f"ble://{TWO}",
        f"ble://{THREE}",
    ]
    assert "Nano 33 BLE" in lines[0]
    assert "may be a fingertip" in lines[0]
    assert "dBm, open it by this address" in lines[1]
    assert "open it by this address" not in lines[2]


@pytest.mark.usefixtures("_one_port", "bus")
def test_what_cannot_be_searched_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    result = scan(0.1)
    assert [found.url for found in result.found] == ["serial:///dev/ttyACM3"]
    assert len(result.unsearched) == 1
    assert "Is Bluetooth switched on?" in result.unsearched[0]
    assert main(["scan", "--only", "ble", "--seconds", "0.1"]) == 1
    told = capsys.readouterr().err
    assert "not searched: Bluetooth: " in told
    assert "twin://demo is a simulated one" in told


def test_an_empty_room(
    bluez: FakeBluez, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(list_ports, "comports", list)
    assert bluez
    assert scan(0.1).found == ()
    assert main(["scan", "--seconds", "0.1"]) == 1
    assert "no fingertip found" in capsys.readouterr().err
