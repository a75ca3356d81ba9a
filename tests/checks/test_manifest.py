"""Damage the manifest, or a file behind its back, and the right checks fail."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks.run import run_checks
from lumitip_fab.pipeline.manifest import sha256_of


def failing(folder: Path) -> set[str]:
    return {m.check for m in run_checks(folder, ["manifest"]).failed}


@pytest.mark.parametrize(
    "path", ["resolved.toml", "assembly/receiver_exploded.svg", "mask/emitter_wrapping.md"]
)
@pytest.mark.parametrize("damage", [Path.unlink, lambda f: f.write_text("edited")])
def test_a_file_lost_or_edited_behind_its_back(
    damaged: Path, path: str, damage: Callable[[Path], Any]
) -> None:
    damage(damaged / path)
    assert failing(damaged) == {"manifest.files"}


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("path", "row", "column", "value"),
    [
        ("backing/emitter_backing.stl", 1, 3, 40.0),
        ("backing/receiver_backing.stl", 0, 0, -1.0),
        ("mould/receiver_mould.stl", 2, 3, 0.0),
        ("mould/emitter_mould.stl", 0, 3, 0.2),
        ("mould/emitter_mould.3mf", 0, 3, 0.2),
        ("mould/clamp.step", 0, 3, 37.0),
        ("holder/holder.stl", 0, 3, 37.0),
        ("holder/holder.3mf", 2, 3, -11.0),
        ("holder/holder.step", 1, 3, -11.0),
        ("flange/flange_lower.stl", 0, 3, 37.0),
        ("flange/flange_upper.stl", 2, 3, -11.0),
        ("fit/fit_plate.stl", 0, 3, 37.0),
        ("mask/coupon.stl", 0, 3, 37.0),
        ("assembly/assembly.glb", 0, 3, 500.0),
        ("assembly/assembly.glb", 0, 0, 1.0),
        ("assembly/assembly.step", 1, 3, 500.0),
        ("assembly/system.glb", 2, 3, 500.0),
        ("boards/flange/flange.kicad_pcb", 0, 3, 0.0),
        ("mask/emitter_cut.dxf", 0, 0, 1.0),
        ("robot/meshes/emitter_film.stl", 0, 3, 37.0),
    ],
)
def test_a_matrix_that_puts_a_part_elsewhere(
    damaged: Path, path: str, row: int, column: int, value: float
) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    record["files"][path]["to_sensor"][row][column] = value
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.frames"}


@pytest.mark.parametrize("frame", ["sensor", ""])
def test_a_part_in_another_frame(damaged: Path, frame: str) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    record["files"]["holder/holder.stl"]["frame"] = frame
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.frames"}


@pytest.mark.parametrize(
    ("name", "check"),
    [
        ("backing/emitter_backing.gcode", "endings"),
        ("backing/old_backing.stl", "frames"),
        ("print/emitter_backing.gcode", "endings"),
        ("firmware/old.cpp", "endings"),
        ("old/notes.md", "endings"),
        ("boards/emitter/Makefile", "endings"),
    ],
)
def test_a_listed_file_that_no_step_writes(damaged: Path, name: str, check: str) -> None:
    (damaged / name).parent.mkdir(exist_ok=True)
    (damaged / name).write_text("of another design")
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    record["files"][name] = record["files"]["bom.csv"] | {
        "sha256": sha256_of(damaged / name),
        "bytes": (damaged / name).stat().st_size,
        "facts": {},
    }
    file.write_text(json.dumps(record))
    assert failing(damaged) == {f"manifest.{check}"}


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("name", "seen"),
    [
        ("backing/old_backing.stl", True),
        ("order_copy.csv", True),
        ("boards/emitter/order/jlcpcb_emitter_old.zip", True),
        ("firmware/crc_copy.h", True),
        ("boards/emitter/_autosave-emitter.kicad_pcb", False),
        ("boards/emitter/~emitter.kicad_pcb.lck", False),
        ("boards/emitter/emitter.kicad_prl", False),
        ("boards/emitter/emitter-backups/emitter-2026.zip", False),
        ("boards/emitter/fp-info-cache", False),
        ("boards/emitter/emitter.kicad_pcb-bak", False),
        ("firmware/firmware.ino~", False),
        (".built", False),
        (".page.js", False),
        ("README.md", False),
        ("index.html", False),
        ("checks.json", False),
        ("checks.xml", False),
        ("bench-tasks/tasks.svg", False),
        ("parts/prices.toml", False),
        ("parts/x.toml", True),
        ("print/emitter_backing.gcode", True),
        ("boards/emitter/order/emitter.GTL", True),
        ("boards/emitter/order/emitter-F_Cu.gbr", True),
        ("boards/emitter/emitter.srdf", True),
        ("boards/receiver_old/receiver.kicad_sch", True),
        ("firmware/scan.cpp", True),
        ("firmware/config.hpp", True),
        ("firmware/firmware.bin", True),
        ("firmware/old/layout.h", True),
        ("firmware/README", True),
        ("backing/emitter_backing.obj", True),
        ("mask/emitter_mask.ai", True),
        ("manual/drawing.dwg", True),
        ("layout_old.json", True),
        ("wiring/README.md", True),
        ("mine/emitter_backing.stl", True),
        ("mine/notes.md", True),
    ],
)
def test_a_file_of_no_build(damaged: Path, name: str, seen: bool) -> None:
    (damaged / name).parent.mkdir(parents=True, exist_ok=True)
    (damaged / name).write_text("of another design")
    assert failing(damaged) == ({"manifest.strays"} if seen else set())


def test_other_outputs_inside_are_theirs(damaged: Path) -> None:
    (damaged / "flex/backing").mkdir(parents=True)
    (damaged / "flex/manifest.json").write_text("{}")
    (damaged / "flex/backing/emitter_backing.stl").write_text("of another design")
    assert failing(damaged) == set()


def test_a_file_that_the_manifest_does_not_list(damaged: Path) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    del record["files"]["holder/holder.stl"]
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.strays"}


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("bom.csv", {"sha256": None}),
        ("bom.csv", {"frame": 3}),
        ("../bom.csv", {}),
        ("/dev/zero", {}),
        ("bom\0.csv", {}),
    ],
)
def test_a_manifest_that_no_build_writes(
    damaged: Path, path: str, values: dict[str, object]
) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    record["files"][path] = record["files"].pop("bom.csv") | values
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.strays"}  # bom.csv is in no list that counts


@pytest.mark.parametrize(
    ("row", "column", "value"),
    [(0, 3, float("nan")), (3, 3, 0.9), (3, 0, 1.0), (0, 1, 0.2), (0, 0, "1")],
)
def test_a_matrix_that_is_no_motion(
    damaged: Path, row: int, column: int, value: float | str
) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    record["files"]["mask/emitter_sheet.3mf"]["to_sensor"][row][column] = value
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.matrices"}


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("path", "keys", "value"),
    [
        ("backing/emitter_backing.stl", ("volume_mm3",), 6600.0),
        ("holder/holder.stl", ("height_mm",), 38.2),
        ("mould/clamp.stl", ("side_mm2",), 2500.0),
        ("mould/prop.stl", ("base_mm2",), 190.0),
        ("fit/fit_plate.stl", ("top_mm2",), 0.0),
        ("mould/receiver_mould.stl", ("cast_ml",), 3.8),
        ("mould/emitter_casting.md", ("part_b_g",), 25.0),
        ("mould/emitter_casting.md", ("mix_ml",), "much"),
        ("bom.csv", ("lines", 3, "quantity"), 7),
        ("bom.csv", ("lines", 3, "part"), "none"),
        ("bom.csv", ("total",), 1.0),
        ("order.csv", ("lines", 2, "packs"), 7),
        ("order.csv", ("single",), 7.0),
        ("boards/receiver/receiver.kicad_pcb", ("parts", 0, "part"), "none"),
        ("robot/lumitip.urdf", ("emitter_g",), 10.0),
        ("mask/emitter_mask.svg", ("apertures",), 31),
        ("mask/receiver_mask.svg", ("flaps", 0, "width_mm"), 7.0),
    ],
)
def test_a_fact_that_the_file_has_not(
    damaged: Path, path: str, keys: tuple[str | int, ...], value: object
) -> None:
    file = damaged / "manifest.json"
    record = json.loads(file.read_text())
    facts: Any = record["files"][path]["facts"]
    for key in keys[:-1]:
        facts = facts[key]
    assert facts[keys[-1]] != value
    facts[keys[-1]] = value
    file.write_text(json.dumps(record))
    assert failing(damaged) == {"manifest.facts"}


def test_no_manifest(damaged: Path) -> None:
    (damaged / "manifest.json").unlink()
    assert failing(damaged) == {"manifest.files", "manifest.frames"}


def test_every_check_passes_undamaged(outputs: Path) -> None:
    outcome = run_checks(outputs, ["manifest"])
    names = ("kinds", "files", "strays", "matrices", "facts", "frames", "endings")
    assert outcome.names == {f"manifest.{name}" for name in names}
    assert outcome.failed == ()
