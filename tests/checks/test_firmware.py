"""Damage the sketch folder, and exactly the right checks fail."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab.checks.firmware import measure
from lumitip_fab.checks.run import run_checks
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.firmware.files import firmware_files

PRESETS = sorted(f.stem for f in (Path(__file__).parents[2] / "design/presets").glob("*.toml"))
ALL = {"channels", "pins", "converter", "hash", "name", "protocol", "form", "sources"}


@pytest.fixture(scope="session")
def sketches(tmp_path_factory: pytest.TempPathFactory, design_dir: Path) -> Path:
    """The sketch folder of the published design and `design.json`. Do not change them."""
    out = tmp_path_factory.mktemp("sketches")
    d = derive(load(design_dir / "presets" / "published.toml"))
    (out / "firmware").mkdir()
    (out / "design.json").write_text(design_text(d), encoding="utf-8")
    for artefact in firmware_files(d):
        (out / artefact.path).write_bytes(artefact.data)
    return out


@pytest.fixture
def damaged_sketch(sketches: Path, tmp_path: Path) -> Path:
    """A copy, to damage."""
    return Path(shutil.copytree(sketches, tmp_path / "damaged"))


def failing(folder: Path) -> set[str]:
    """Names of the firmware's checks that fail, without `firmware.`."""
    design = read_design(folder / "design.json")
    found = {m.check for m in measure(folder, design) if not m.passed}
    return {name.removeprefix("firmware.") for name in found}


LAYOUT, PROTOCOL = "layout.h", "protocol.h"
EDITS = [
    (LAYOUT, "    4, 2, 6,", "    2, 4, 6,", {"channels"}),
    (LAYOUT, "    0, 0, 0,", "    1, 0, 0,", {"channels"}),
    (LAYOUT, "    4, 2, 6,", "    2, 6,", {"channels"}),
    (LAYOUT, "CELLS = 32;", "CELLS = 31;", {"channels", "form"}),
    (LAYOUT, "A0, A1", "A1, A0", {"pins"}),
    (LAYOUT, "A2, A3", "A2, A3, A4", {"pins"}),
    (LAYOUT, "6, 7, 8", "8, 7, 6", {"pins"}),
    (LAYOUT, "MUXES = 4;", "MUXES = 5;", {"converter"}),
    (LAYOUT, "SELECT_LINES = 3;", "SELECT_LINES = 4;", {"converter"}),
    (LAYOUT, "CHANNELS = 8;", "CHANNELS = 16;", {"converter"}),
    (LAYOUT, "ADC_BITS = 12;", "ADC_BITS = 10;", {"converter"}),
    (LAYOUT, "PULL_UP_OHM = 75000;", "PULL_UP_OHM = 7500;", {"converter"}),
    (LAYOUT, "LINE_PF = 75;", "LINE_PF = 7;", {"converter"}),
    (LAYOUT, 'LAYOUT_HASH[] = "', 'LAYOUT_HASH[] = "0', {"hash"}),
    (PROTOCOL, 'PROTOCOL_HASH[] = "', 'PROTOCOL_HASH[] = "0', {"hash"}),
    (PROTOCOL, "DESIGN_CODE = 0x", "DESIGN_CODE = 0x1", {"hash", "form"}),
    (PROTOCOL, "DESIGN_HASH[8] = {", "DESIGN_HASH[8] = {0x00, ", {"hash", "form"}),
    (PROTOCOL, '"Lumitip"', '"lumitip"', {"name"}),
    (LAYOUT, "MUXES = 4;", "MUXES = 4", {"converter", "form"}),
    (LAYOUT, "    0, 0, 0,", "    0 0, 0,", {"form"}),
    (LAYOUT, "#pragma once", "#pragma once\n#define MUXES 7", {"form"}),
    (LAYOUT, "// Multiplexer", "constexpr uint16_t CELLS = 32;\n// Multiplexer", {"form"}),
    (PROTOCOL, "MAGIC = 0x4c;", "MAGIC = 0x4d;  // MAGIC = 0x4c;", {"protocol"}),
    (LAYOUT, "}  // namespace", "  // namespace", {"form"}),
    (LAYOUT, "#pragma once", "#pragma twice", {"form"}),
    (LAYOUT, "namespace lumitip {", "namespace lumitip", {"form"}),
    (LAYOUT, "constexpr uint8_t ADC_BITS", "constexpr ADC_BITS", {"converter", "form"}),
    (PROTOCOL, "MAGIC = 0x4c", "MAGIC = 0x4d", {"protocol"}),
    (PROTOCOL, "VERSION = 2", "VERSION = 3", {"protocol"}),
    (PROTOCOL, "7d1c0002", "7d1c0004", {"protocol"}),
    (PROTOCOL, "WIRING_SUM = 0x", "WIRING_SUM = 0x1", {"protocol", "form"}),
    (PROTOCOL, '"ecbc"', '"ecbd"', {"protocol"}),
    (PROTOCOL, '"ecbc";', '"ecbc;', {"protocol", "form"}),
    (LAYOUT, "uint8_t CHANNEL[", "uint8 CHANNEL[", {"form"}),
    (LAYOUT, "uint8_t CHANNEL[", "bool CHANNEL[", {"form"}),
    (LAYOUT, "uint32_t PULL_UP_OHM", "uint8_t PULL_UP_OHM", {"form"}),
    (LAYOUT, "CHANNELS = 8;", "CHANNELS = 70000;", {"converter", "form"}),
    (LAYOUT, "ADC_BITS = 12;", "ADC_BITS = 012;", {"form"}),
    (LAYOUT, "MUXES = 4;", "MUXES = {4};", {"converter", "form"}),
    (LAYOUT, "#include <stdint.h>\n", "", {"form"}),
    (LAYOUT, "#pragma once\n", "", {"form"}),
    (LAYOUT, "#include <stdint.h>\n", "#include <stdint.h>\n#define loop loop_\n", {"form"}),
    (LAYOUT, "in frame order.", "in frame order.\\", {"channels", "form"}),
    (PROTOCOL, "uint8_t VERSION", "uint1_t VERSION", {"form"}),
    (PROTOCOL, "constexpr uint8_t VERSION = 2;", "", {"protocol", "form"}),
    ("device.h", '#include "cobs.h"', '#include "cops.h"', {"sources"}),
    ("firmware.ino", "device.poll();", "device.poll()", {"sources"}),
    ("README.md", "V", "mV", {"sources"}),
]


def test_an_undamaged_sketch_passes(sketches: Path) -> None:
    assert failing(sketches) == set()


@pytest.mark.parametrize(("file", "before", "after", "fails"), EDITS)
def test_a_damage_fails_exactly_these_checks(
    file: str, before: str, after: str, fails: set[str], damaged_sketch: Path
) -> None:
    path = damaged_sketch / "firmware" / file
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after, 1))
    assert failing(damaged_sketch) == fails


def test_a_constant_that_is_used_before_it_is_there(damaged_sketch: Path) -> None:
    path, line = damaged_sketch / "firmware" / LAYOUT, "constexpr uint16_t CELLS = 32;\n"
    text = path.read_text()
    path.write_text(text.replace(line, "").replace("}  // namespace", f"{line}}}  // namespace"))
    assert failing(damaged_sketch) == {"form"}


@pytest.mark.parametrize(
    ("file", "fails"),
    [
        (LAYOUT, {"channels", "pins", "converter", "hash", "form"}),
        (PROTOCOL, {"hash", "name", "protocol", "form"}),
        ("cobs.h", {"sources"}),
        ("firmware.ino", {"sources"}),
    ],
)
def test_a_missing_file_fails_exactly_these_checks(
    file: str, fails: set[str], damaged_sketch: Path
) -> None:
    (damaged_sketch / "firmware" / file).unlink()
    assert failing(damaged_sketch) == fails


@pytest.mark.parametrize("name", ["old.cpp", "old.h", "second.ino", "src/old.c"])
def test_a_further_source_fails(name: str, damaged_sketch: Path) -> None:
    path = damaged_sketch / "firmware" / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("void setup() {}\n")
    assert failing(damaged_sketch) == {"sources"}
    path.unlink()
    (damaged_sketch / "firmware/.editor.h").write_text("")
    (damaged_sketch / "firmware/firmware.ino~").write_text("")
    assert failing(damaged_sketch) == set()


def test_a_sketch_of_another_design_fails(damaged_sketch: Path, design_dir: Path) -> None:
    d = derive(load(design_dir / "presets" / "asymmetric.toml"))
    for artefact in firmware_files(d):
        (damaged_sketch / artefact.path).write_bytes(artefact.data)
    assert failing(damaged_sketch) == ALL - {"form", "sources"}


def test_every_firmware_check_is_failed_by_some_damage(sketches: Path) -> None:
    assert run_checks(sketches, ["firmware"]).names == {f"firmware.{name}" for name in ALL}
    assert set.union(*(fails for *_, fails in EDITS)) == ALL


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_passes(preset: str, tmp_path: Path, design_dir: Path) -> None:
    d = derive(load(design_dir / "presets" / f"{preset}.toml"))
    (tmp_path / "firmware").mkdir()
    for artefact in firmware_files(d):
        (tmp_path / artefact.path).write_bytes(artefact.data)
    assert [m for m in measure(tmp_path, d) if not m.passed] == []
