"""The core on the chips of the Arduino Nanos, and the sketch against each board's interfaces."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.catalogue.controllers import Controller
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.firmware.files import firmware_files

HERE = Path(__file__).parent
STRICT = ("-std=c++14", "-Wall", "-Wextra", "-Werror")
ARM, XTENSA = 40, 94  # as ELF numbers the machines
CORES = {
    "nrf52840": (ARM, "arm-none-eabi-g++", "-mcpu=cortex-m4", "-mthumb"),
    "rp2040": (ARM, "arm-none-eabi-g++", "-mcpu=cortex-m0plus", "-mthumb"),
    # Debian has Xtensa compilers for the ESP8266 alone: the same instruction set, an older core.
    "esp32s3": (XTENSA, "xtensa-lx106-elf-g++", "-isystem", "/usr/lib/xtensa-lx106-elf/include"),
}
STUBS = HERE / "stubs"
RP2040 = ("-DARDUINO_ARCH_RP2040", "-I", HERE / "stubs_rp2040")
ESP32 = ("-DARDUINO_ARCH_ESP32", "-I", HERE / "stubs_esp32")
BOARDS = {
    "arduino_nano_33_ble": [()],
    "arduino_nano_rp2040_connect": [RP2040],
    "arduino_nano_esp32": [(*ESP32, f"-DESP_IDF_VERSION_MAJOR={idf}") for idf in (4, 5)],
}
CASES = [(board, options) for board, several in BOARDS.items() for options in several]


@pytest.fixture
def sketch_for(design_dir: Path, tmp_path: Path) -> Callable[[str], Path]:
    """`sketch_for("arduino_nano_esp32")`: the published design's sketch for another controller."""

    def write(board: str) -> Path:
        base = (design_dir / "presets" / "published.toml").read_text(encoding="utf-8")
        file = tmp_path / "mine.toml"
        file.write_text(base.replace("arduino_nano_33_ble", board), encoding="utf-8")
        design = derive(load(file))
        (tmp_path / "firmware").mkdir()
        for artefact in firmware_files(design):
            (tmp_path / artefact.path).write_bytes(artefact.data)
        return tmp_path / "firmware"

    return write


@pytest.mark.slow_cases
@pytest.mark.parametrize("chip", CORES)
@pytest.mark.parametrize("preset", ["published", "dense"])
def test_the_core_compiles_for_the_chip(
    chip: str,
    preset: str,
    sketch: Callable[[str], Path],
    run: Callable[..., Any],
    tmp_path: Path,
) -> None:
    machine, compiler, *options = CORES[chip]
    out = tmp_path / "core.o"
    done = run(
        compiler,
        *STRICT,
        *options,
        "-Os",
        "-fno-exceptions",
        "-fno-rtti",
        "-I",
        sketch(preset),
        "-c",
        HERE / "host" / "core.cpp",
        "-o",
        out,
    )
    assert done.returncode == 0, done.stderr
    assert struct.unpack_from("<H", out.read_bytes(), 18) == (machine,)


@pytest.mark.slow_cases
@pytest.mark.parametrize(("board", "options"), CASES)
def test_the_sketch_fits_the_boards_interfaces(
    board: str,
    options: tuple[Any, ...],
    sketch_for: Callable[[str], Path],
    run: Callable[..., Any],
) -> None:
    folder = sketch_for(board)
    done = run(
        "g++",
        *STRICT,
        "-fsyntax-only",
        *options,
        "-I",
        STUBS,
        "-I",
        folder,
        "-x",
        "c++",
        folder / "firmware.ino",
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("options", "foreign"), [(RP2040, "NRF_WDT"), (ESP32, "NRF_WDT")])
def test_a_board_does_not_ask_for_another_chips_registers(
    options: tuple[Any, ...], foreign: str, sketch: Callable[[str], Path], run: Callable[..., Any]
) -> None:
    folder = sketch("published")
    done = run(
        "g++",
        "-std=c++14",
        "-E",
        *options,
        "-I",
        STUBS,
        "-I",
        folder,
        "-x",
        "c++",
        folder / "firmware.ino",
    )
    assert done.returncode == 0, done.stderr
    assert foreign not in done.stdout


def test_every_board_that_plugs_in_has_its_chip(design_dir: Path) -> None:
    boards: dict[str, Controller] = dict(load(design_dir / "fingertip.toml").catalogue.controllers)
    assert set(BOARDS) == {name for name, board in boards.items() if board.plug is not None}
