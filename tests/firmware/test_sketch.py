"""The sketch against the Arduino interfaces it uses, and what the compiler refuses."""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.firmware.files import protocol_header, wiring_sum
from lumitip_fab.pipeline import fingerprint as toolchain

STUBS = Path(__file__).parent / "stubs"
PRESETS = sorted(f.stem for f in (Path(__file__).parents[2] / "design/presets").glob("*.toml"))
Compile = Callable[..., Any]


@pytest.fixture
def compiled(run: Callable[..., Any]) -> Compile:
    """`compiled(folder)`: the compiler's verdict on the sketch in a folder."""

    def check(folder: Path, compiler: str = "g++") -> Any:
        return run(
            compiler,
            "-std=c++14",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-fsyntax-only",
            "-I",
            STUBS,
            "-I",
            folder,
            "-x",
            "c++",
            folder / "firmware.ino",
        )

    return check


@pytest.fixture
def copied(sketch: Callable[[str], Path], tmp_path: Path) -> Path:
    """A copy of the published design's sketch, to damage."""
    return Path(shutil.copytree(sketch("published"), tmp_path / "firmware"))


@pytest.mark.slow_cases
@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("compiler", ["g++", "arm-none-eabi-g++"])
def test_the_sketch_fits_the_interfaces(
    compiler: str, preset: str, sketch: Callable[[str], Path], compiled: Compile
) -> None:
    verdict = compiled(sketch(preset), compiler)
    assert verdict.returncode == 0, verdict.stderr


@pytest.mark.parametrize("call", ["BLE.rssi()", "digitalWrite(LED_BUILTIN)", "Serial.print(1)"])
def test_a_call_that_the_interfaces_do_not_have_is_noticed(
    call: str, copied: Path, compiled: Compile
) -> None:
    edit(copied / "firmware.ino", "nano.poll();", f"nano.poll(); {call};")
    assert "error" in compiled(copied).stderr


def test_headers_of_two_designs_do_not_compile(
    copied: Path, sketch: Callable[[str], Path], compiled: Compile
) -> None:
    shutil.copy(sketch("asymmetric") / "layout.h", copied / "layout.h")
    assert "were made for two designs: build the design again" in compiled(copied).stderr


def test_a_channel_changed_by_hand_does_not_compile(copied: Path, compiled: Compile) -> None:
    first_channel(copied / "layout.h", "3")
    assert "was changed by hand: build the design again" in compiled(copied).stderr


def test_two_cells_on_one_input_do_not_compile(copied: Path, compiled: Compile) -> None:
    second = re.search(r"CHANNEL\[CELLS\] = \{\s*\d+, (\d+),", (copied / "layout.h").read_text())
    assert second
    first_channel(copied / "layout.h", second[1])
    any_sum(copied)
    assert "layout.h has two cells on one input" in compiled(copied).stderr


def test_a_channel_out_of_reach_does_not_compile(copied: Path, compiled: Compile) -> None:
    first_channel(copied / "layout.h", "8")
    any_sum(copied)
    assert "on an input that no multiplexer has" in compiled(copied).stderr


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    "defined", ["BITS=9", "PERIOD_US=70000", "SAMPLES=0", "RADIO_US=-1", "CONVERSION_US=0"]
)
def test_settings_out_of_range_do_not_compile(
    defined: str, copied: Path, compiled: Compile
) -> None:
    name, value = defined.split("=")
    edit(
        copied / "settings.h",
        f"#ifndef LUMITIP_{name}\n",
        f"#define LUMITIP_{name} {value}\n#ifndef LUMITIP_{name}\n",
    )
    verdict = compiled(copied)
    assert "static assertion failed" in verdict.stderr
    assert name in verdict.stderr


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    "given",
    ["".join(map(chr, range(0x20, 0x7F))) + "??/ \\", "Größe 7", "Палец2", "指尖", "😀1"],
)
def test_any_name_comes_out_as_it_was_given(
    given: str, design_dir: Path, tmp_path: Path, run: Callable[..., Any]
) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    header = protocol_header(
        design.layout, replace(design.controller, name=given), replace(design.title, name=given)
    )
    (tmp_path / "protocol.h").write_text(header, encoding="ascii")
    program = (
        '#include <stdio.h>\n#include "protocol.h"\nint main() { puts(LUMITIP_DEVICE_NAME); }\n'
    )
    (tmp_path / "name.cpp").write_text(program)
    made = run(
        "g++",
        "-std=c++14",
        "-Wall",
        "-Wextra",
        "-Werror",
        tmp_path / "name.cpp",
        "-o",
        tmp_path / "name",
    )
    assert made.returncode == 0, made.stderr
    assert run(str(tmp_path / "name")).stdout == given + "\n"


def test_a_changed_core_is_copied_again(copied: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A build sees that a file of the sketch changed, though it is no part of the package."""
    before = toolchain.code_hash.__wrapped__("firmware"), toolchain.whole_code_hash.__wrapped__()
    edit(copied / "scan.h", "waitUs(SETTLE_US)", "waitUs(2 * SETTLE_US)")
    shared = {file.name for file in toolchain.firmware_sources()}
    changed = tuple(sorted(f for f in copied.iterdir() if f.name in shared))
    monkeypatch.setattr(toolchain, "firmware_sources", lambda: changed)
    after = toolchain.code_hash.__wrapped__("firmware"), toolchain.whole_code_hash.__wrapped__()
    assert before[0] != after[0]
    assert before[1] != after[1]


def test_the_sum_tells_swapped_channels(design_dir: Path) -> None:
    layout = derive(load(design_dir / "presets" / "published.toml")).layout
    swapped = layout.channel.copy()
    swapped[:2] = swapped[1::-1]
    assert wiring_sum(replace(layout, channel=swapped)) != wiring_sum(layout)


def edit(file: Path, before: str, after: str) -> None:
    """Replace a text that must be there."""
    text = file.read_text()
    assert before in text
    file.write_text(text.replace(before, after, 1))


def first_channel(file: Path, value: str) -> None:
    """Put the first cell on another input."""
    text, count = re.subn(r"(CHANNEL\[CELLS\] = \{\s*)\d+", rf"\g<1>{value}", file.read_text())
    assert count == 1
    file.write_text(text)


def any_sum(folder: Path) -> None:
    """Let the sum over the wiring pass, as a careless writer would."""
    edit(folder / "wiring.h", "wiringSum() == WIRING_SUM", "wiringSum() + WIRING_SUM >= 0")
