"""Printed parts of the default and of the compliant design go through Debian's PrusaSlicer."""

import csv
import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from damages import excerpt
from lumitip_fab.cli import main
from lumitip_fab.errors import BuildError
from lumitip_fab.parts import slicing
from programs import program

CODE = """
;TYPE:Custom
G1 X0 Y0 F9000
;LAYER_CHANGE
;Z:0.2
;TYPE:Skirt/Brim
G1 X90 Y0 E5
G92 E0
;TYPE:External perimeter
G1 X0 Y0
G1 X10 Y0 E1 F1200
;LAYER_CHANGE
;Z:0.4
G1 X10 Y3 F9000
G1 X0 Y3 E2
G1 E1.2
;TYPE:Support material
G1 X0 Y50 E4
; total filament used [g] = 7.24
; estimated printing time (normal mode) = 1d 2h 3m 4s
"""


def test_layers_are_of_the_part_alone() -> None:
    found = slicing.layers_of(CODE)
    assert [layer.z_mm for layer in found] == [0.2, 0.4]
    assert [layer.length_mm for layer in found] == pytest.approx([10.0, 10.0])
    assert np.ptp(found[0].points_mm, axis=0).tolist() == pytest.approx([10.0, 0.0])
    assert slicing.reach_mm(found) == pytest.approx((3.0, 0.4))
    assert slicing.seconds(CODE) == 93784 and slicing.grams(CODE) == 7.24
    with pytest.raises(BuildError, match="no time"):
        slicing.seconds("")
    with pytest.raises(BuildError, match="no mass"):
        slicing.grams("")


BILLED = re.compile(r"(?:(\d+) times, each )?some (\d+) min, .*")


def assert_times_are_billed(outputs: Path, parts: dict[str, dict[str, float]]) -> None:
    """The bill's times and masses against the slicer's own."""
    with (outputs / "bom.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["group"] == "prints"]
    assert len(rows) >= 7
    for row in rows:
        part = parts[row["item"].removesuffix("stl") + "3mf"]
        times, minutes = BILLED.fullmatch(row["for"]).groups()
        assert (times == "2") == (row["item"] in ("mould/clamp.stl", "mould/prop.stl")), row["item"]
        assert 60 * int(minutes) == pytest.approx(part["seconds"], rel=0.25), row["item"]
        grams = int(times or 1) * part["solid_g"]
        assert float(row["quantity"]) == pytest.approx(grams, rel=0.01), row["item"]


def test_a_finger_slices_without_support(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of one part, for a quick look; the slow test has all of them."""
    program("prusa-slicer")
    part = "backing/emitter_backing.3mf"
    folder = excerpt(outputs, tmp_path / "one", "print", part)
    manifest = json.loads((outputs / "manifest.json").read_text(encoding="utf-8"))
    manifest["files"] = {k: v for k, v in manifest["files"].items() if (folder / k).exists()}
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    assert main(["slice", "--out", str(folder), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["parts"]
    assert found["part"] == part and found["warnings"] == []
    assert found["layers"] == 273 and found["reach_mm"] < 3.0


FLEX = {"backing/emitter_backing.3mf": 10, "interface/emitter_interface.3mf": 130}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("preset", "layers", "filament"),
    [("published", {"backing/emitter_backing.3mf": 273}, "PETG"), ("flex", FLEX, "TPU 98A")],
    ids=["published", "flex"],
)
def test_every_part_slices_without_support(
    preset: str,
    layers: dict[str, int],
    filament: str,
    built: Callable[[str], Path],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    program("prusa-slicer")
    outputs = built(preset)
    assert main(["slice", "--out", str(outputs), "--gcode", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    parts = {part["part"]: part for part in found["parts"]}
    assert set(parts) == {p.relative_to(outputs).as_posix() for p in outputs.rglob("*.3mf")}
    assert {"backing/emitter_backing.3mf", "mould/receiver_mould.3mf"} <= set(parts)
    for name, part in parts.items():
        assert part["warnings"] == [], name
        # The brim, and lines that are a little wider than their gap.
        small = name.startswith(("fit/", "mould/prop"))  # thin, and much brim
        most = 1.25 if small else 1.10
        assert 0.97 < part["grams"] / part["solid_g"] < most, name
        assert part["reach_mm"] < 3.0, name  # a bridge of 6 mm at most; PETG holds over 15
        assert part["first_layer_mm2"] > 150.0 and part["seconds"] > 3 * 60, name
        assert (tmp_path / f"{Path(name).stem}.gcode").stat().st_size > 10_000
        own = {"backing": filament, "mask": "TPU 95A"}
        assert part["filament"] == own.get(name.partition("/")[0], "PETG")
    assert_times_are_billed(outputs, parts)
    assert {name: parts[name]["layers"] for name in layers} == layers
    assert parts["fit/fit_plate.3mf"]["seconds"] <= 20 * 60
    twice = {"mould/clamp.3mf", "mould/prop.3mf"}
    for name, part in parts.items():
        number = 0 if name.startswith("mask/") else 2 if name in twice else 1
        assert part["number"] == number, name
    for figure in ("grams", "seconds"):
        whole = sum(p["number"] * p[figure] for p in parts.values())
        assert found[figure] == pytest.approx(whole, abs=0.01)


def test_a_folder_that_was_not_built_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert main(["slice", "--out", str(tmp_path)]) == 2
    assert "none of prusa-slicer, PrusaSlicer" in capsys.readouterr().err
    monkeypatch.setattr(shutil, "which", lambda _: "/bin/false")
    assert main(["slice", "--out", str(tmp_path)]) == 2
    assert "design.json" in capsys.readouterr().err
