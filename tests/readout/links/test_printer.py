"""A printer as a positioning stage: what it is sent, and what its answers mean."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from lumitip.errors import DeviceNotFound, LinkTimeout, UrlError
from lumitip.links import printer as module
from lumitip.links.printer import Printer, PrinterError
from printer_stand_in import StandIn

Start = Callable[..., tuple[StandIn, str]]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    begun = []

    def begin(**options: Any) -> tuple[StandIn, str]:
        begun.append(StandIn(tmp_path / "tty", **options))
        return begun[0], f"serial://{tmp_path / 'tty'}"

    yield begin
    for stand_in in begun:
        stand_in.close()


@pytest.fixture(autouse=True)
def impatience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_QUIET_S", 0.05)


def test_moves_are_relative_and_end_when_the_head_stands(start: Start) -> None:
    stand_in, address = start()
    stand_in.place_mm["Z"] = 37.5
    with Printer(address) as printer:
        assert printer.firmware == "Marlin 2.1.2.4 (Jan  3 2024 10:00:00)"
        printer.move("Z", -1.0)
        assert stand_in.place_mm["Z"] == 36.5
        assert printer.place_mm("Z") == 36.5
        printer.move("Y", 2.25)
    stand_in.close()
    assert stand_in.place_mm == {"X": 0.0, "Y": 2.25, "Z": 36.5}
    moves = [c for c in stand_in.commands if c not in ("M114", "M115")]
    assert moves == ["G21", "G91", "G1 Z-1.000 F300", "M400", "G1 Y2.250 F300", "M400", "G90"]


@pytest.mark.parametrize(
    ("answer", "place_mm"),
    [
        ("X:1.00 Y:2.00 Z:-3.50 E:0.00 Count X:80 Y:160 Z:-1400\nok\n", -3.5),
        ("ok X:0.0 Y:0.0 Z:4.0 E:0.0 Count: A:0 B:0 C:400\n", 4.0),
        ("ok C: X:1.0000 Y:2.0000 Z:3.0000 E:0.0000\n", 3.0),
        ("X:1.000 Y:2.000 Z:7 E:0.000\nok\n", 7.0),
    ],
    ids=["marlin", "octoprint", "smoothie", "klipper"],
)
def test_the_place_is_read_from_the_answers_of_several_firmwares(
    start: Start, answer: str, place_mm: float
) -> None:
    _, address = start(answers={"M114": answer})
    with Printer(address) as printer:
        assert printer.place_mm("Z") == place_mm


def test_a_head_that_stops_at_the_end_of_its_axis_is_an_error(start: Start) -> None:
    _, address = start(range_mm=(0.0, 200.0))
    with Printer(address) as printer, pytest.raises(PrinterError) as error:
        printer.move("Z", -1.0)
    assert "at Z 0.00 mm; it was sent to -1.00 mm" in str(error.value)


@pytest.mark.parametrize("said", ["!! Must home axis first\nok\n", "Error:Printer halted\n"])
def test_a_command_that_is_refused_is_an_error(start: Start, said: str) -> None:
    stand_in, address = start(answers={"G1": said})
    with Printer(address) as printer, pytest.raises(PrinterError) as error:
        printer.move("X", 1.0)
    assert said.splitlines()[0] in str(error.value)
    assert stand_in.commands[-1] in ("G90", "G1 X1.000 F300")


def test_a_board_that_starts_anew_is_asked_again(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_ASK_AGAIN_S", 0.1)
    stand_in, address = start(deaf_to=3)
    with Printer(address) as printer:
        assert printer.firmware.startswith("Marlin")
    assert stand_in.commands[:1] == ["M115"]


def test_words_without_end_are_no_answer(start: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_ANSWER_S", 0.3)
    _, address = start(answers={"M400": "wait\n" * 500})
    with Printer(address) as printer, pytest.raises(LinkTimeout, match="not answered M400"):
        printer.move("X", 1.0)


def test_a_port_without_a_printer_is_named(start: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_ASK_AGAIN_S", 0.05)
    monkeypatch.setattr(module, "_BOOT_S", 0.2)
    _, address = start(answers={"M115": None})
    with pytest.raises(LinkTimeout, match=r"no printer answered in 0\.2 s\. Is this its port"):
        Printer(address)


@pytest.mark.parametrize("address", ["ble://Lumitip", "serial:///dev/ttyUSB0?speed=9600"])
def test_an_address_of_another_kind_is_refused(address: str) -> None:
    with pytest.raises(UrlError):
        Printer(address)


def test_a_port_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(DeviceNotFound, match="there is no such port"):
        Printer(f"serial://{tmp_path / 'none'}")
