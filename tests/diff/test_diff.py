"""`lumitip-fab diff` on built designs with known differences."""

import csv
import json
import math
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import pytest
import trimesh

from lumitip_fab.checks.memory import Memory
from lumitip_fab.checks.run import MODULES, run_checks
from lumitip_fab.cli import main
from lumitip_fab.diff.checks import MEMORY

pytestmark = pytest.mark.slow

Diff = Callable[..., dict[str, Any]]
SECTIONS = ("parameters", "facts", "solids", "copper")


def test_equal_folders_have_no_difference(
    outputs: Path, edited: Path, diff: Diff, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = diff(outputs, edited)
    assert not any(found[name] for name in SECTIONS)
    assert found["bill"]["lines"] == []
    assert not any(found["files"].values())
    assert "all           no difference" in capsys.readouterr().out
    page = (tmp_path / "diff" / "diff.html").read_text(encoding="utf-8")
    assert "no difference" in page
    assert "<section id=" not in page


def test_a_pitch_that_changed_is_followed_through_the_design(
    outputs: Path, other: Path, diff: Diff, capsys: pytest.CaptureFixture[str]
) -> None:
    found = diff(outputs, other, "--no-checks")
    (pitch,) = (e for e in found["parameters"] if e["name"] == "grid.pitch_mm")
    assert pitch == {"name": "grid.pitch_mm", "unit": "mm", "a": 6.0, "b": 5.5}
    values = {e["name"]: (e["a"], e["b"]) for e in found["facts"]}
    assert values["sensorised area"] == ("38.1 x 30.0 mm", "34.9 x 27.5 mm")
    for at, out in enumerate((outputs, other)):
        with (out / "bom.csv").open(encoding="utf-8", newline="") as file:
            *_, total = csv.reader(file)
        assert values["sum of the bill, as used"][at] == float(total[-1])
        assert found["bill"]["total"]["ab"[at]] == float(total[-1])
    assert values["mass of the emitter finger"][0] > values["mass of the emitter finger"][1] > 5
    sizes = {e["name"]: e for e in found["solids"]}
    for out, side in ((outputs, "a"), (other, "b")):
        mesh = trimesh.load(out / "backing/emitter_backing.stl", force="mesh")
        backing = sizes["backing/emitter_backing.stl"]
        assert backing[f"{side}_mm3"] == pytest.approx(mesh.volume, rel=1e-4)
    assert backing["a_mm3"] - backing["only_a_mm3"] == pytest.approx(
        backing["b_mm3"] - backing["only_b_mm3"], abs=0.1
    )
    assert "holder/holder.stl" not in sizes  # the same file
    layers = {e["name"]: e["xor_mm2"] for e in found["copper"]}
    assert layers["emitter F.Cu"] > 100
    assert layers["breakout F.Cu"] == layers["breakout B.Cu"] == 0
    assert found["checks"] is None
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 12
    assert any(line.startswith("parameters    ") and "6 → 5.5 mm" in line for line in lines)


def test_the_same_folders_elsewhere_give_the_same_bytes(
    outputs: Path, edited: Path, tmp_path: Path
) -> None:
    (edited / "mask" / "coupon.stl").write_bytes((edited / "mould" / "prop.stl").read_bytes())
    written = []
    for place in ("one", "two"):
        a, b = tmp_path / place / "a", tmp_path / place / "b"
        shutil.copytree(outputs, a)
        shutil.copytree(edited, b)
        out = tmp_path / place / "diff"
        assert main(["diff", str(a), str(b), "--out", str(out), "--no-checks", "--quiet"]) == 0
        written.append({file.name: file.read_bytes() for file in out.iterdir()})
    assert written[0] == written[1]
    assert sorted(written[0]) == ["diff.html", "diff.json"]
    assert not any(str(tmp_path).encode() in data for data in written[0].values())


def test_lines_of_the_bill_are_found_again(outputs: Path, edited: Path, diff: Diff) -> None:
    file = edited / "bom.csv"
    head, *lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    led = next(line for line in lines if line.startswith("electronics,LED 15406085BA300"))
    gone = next(line for line in lines if line.startswith("fasteners,4 x 12 parallel pin"))
    lines[lines.index(led)] = led.replace(",32,piece,0.3,9.60", ",30,piece,0.3,9.00")
    lines[lines.index(gone)] = "tools,tweezers,,T-1,by hand,1,piece,2.5,2.50\n"
    file.write_text("".join((head, *lines)), encoding="utf-8")
    found = diff(outputs, edited, "--no-checks")
    by_item = {line["item"]: line for line in found["bill"]["lines"]}
    assert sorted(by_item) == ["4 x 12 parallel pin", "LED 15406085BA300", "tweezers"]
    led_line = by_item["LED 15406085BA300"]
    assert (led_line["a"]["price"], led_line["b"]["price"]) == ("9.60", "9.00")
    assert by_item["4 x 12 parallel pin"]["b"] is None
    assert by_item["tweezers"]["a"] is None
    assert found["files"]["changed"] == ["bom.csv"]
    assert found["b"]["edited"] == ["bom.csv"]


def _drill(file: Path, x_mm: float, y_mm: float, radius_mm: float) -> None:
    """Drill a hole through a part."""
    mesh = trimesh.load(file, force="mesh")
    body = manifold3d.Manifold(
        manifold3d.Mesh64(mesh.vertices.astype(np.float64), mesh.faces.astype(np.uint64))
    )
    tool = manifold3d.Manifold.cylinder(100.0, radius_mm, radius_mm, 256)
    drilled = body - tool.translate([x_mm, y_mm, -50.0])
    assert drilled.volume() < body.volume()
    made = drilled.to_mesh()
    trimesh.Trimesh(made.vert_properties[:, :3], made.tri_verts).export(file)


def test_a_hole_that_moved_has_its_volume_on_both_sides(
    outputs: Path, edited: Path, diff: Diff, tmp_path: Path
) -> None:
    before = Path(shutil.copytree(outputs, tmp_path / "before"))
    part, radius_mm, moved_mm = "mask/coupon.stl", 2.0, 1.0
    height_mm = float(np.ptp(trimesh.load(outputs / part, force="mesh").bounds[:, 2]))
    _drill(before / part, 0.0, 0.0, radius_mm)
    _drill(edited / part, moved_mm, 0.0, radius_mm)
    half = moved_mm / 2
    common_mm2 = 2 * (
        radius_mm**2 * math.acos(half / radius_mm) - half * math.sqrt(radius_mm**2 - half**2)
    )
    moon_mm3 = (math.pi * radius_mm**2 - common_mm2) * height_mm
    (found,) = diff(before, edited, "--no-checks")["solids"]
    assert found["name"] == part
    assert found["only_a_mm3"] == pytest.approx(moon_mm3, rel=0.01)
    assert found["only_b_mm3"] == pytest.approx(moon_mm3, rel=0.01)
    assert found["xor_mm3"] == pytest.approx(2 * moon_mm3, rel=0.01)
    page = (tmp_path / "diff" / "diff.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == 2


def test_a_track_that_was_added_has_its_area(
    outputs: Path, edited: Path, diff: Diff, tmp_path: Path
) -> None:
    file = edited / "boards/emitter/emitter.kicad_pcb"
    text = file.read_text(encoding="utf-8").rstrip().removesuffix(")")
    length_mm, width_mm = 5.0, 0.5  # beside the board
    track = (
        f'(segment (start 190 90) (end 190 {90 + length_mm}) (width {width_mm}) (layer "B.Cu") '
        '(net 1) (uuid "00000000-0000-4000-8000-000000000001"))'
    )
    file.write_text(f"{text}  {track}\n)\n", encoding="utf-8")
    found = {e["name"].split()[1]: e for e in diff(outputs, edited, "--no-checks")["copper"]}
    area_mm2 = length_mm * width_mm + math.pi * width_mm**2 / 4
    assert found["B.Cu"]["only_b_mm2"] == pytest.approx(area_mm2, rel=0.02)
    assert found["B.Cu"]["only_a_mm2"] == 0
    assert found["F.Cu"]["xor_mm2"] == 0
    page = (tmp_path / "diff" / "diff.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 1
    assert page.count('class="ring"') == 1  # small: there is a ring round it


def test_what_one_alone_has_is_listed(outputs: Path, edited: Path, diff: Diff) -> None:
    shutil.copyfile(edited / "mask/coupon.stl", edited / "mask/spare.stl")
    shutil.copytree(edited / "boards/flange", edited / "boards/spare")
    (edited / "boards/spare/flange.kicad_pcb").rename(edited / "boards/spare/spare.kicad_pcb")
    found = diff(outputs, edited, "--no-checks")
    (part,) = found["solids"]
    assert (part["name"], part["a_mm3"]) == ("mask/spare.stl", None)
    assert part["only_b_mm3"] == pytest.approx(621.7, abs=1)
    assert {(e["name"], e["a_mm2"]) for e in found["copper"]} == {
        ("spare F.Cu", None),
        ("spare B.Cu", None),
    }
    assert "mask/spare.stl" in found["files"]["only_b"]
    assert found["files"]["changed"] == found["files"]["only_a"] == []


def test_a_check_that_fails_in_one_alone_is_first_and_kept_results_are_used(
    edited: Path,
    outputs: Path,
    diff: Diff,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = Path(shutil.copytree(outputs, tmp_path / "before"))
    run_checks(before, MODULES, Memory(before / MEMORY, before))
    layout = edited / "layout.json"
    layout.write_text(layout.read_text().replace('"channel": [', '"channel": [9, ', 1))
    measured: list[str] = []
    whole = run_checks.__globals__["_measured"]

    def noted(out: Path, design: object, names: list[str], cores: int) -> object:
        measured.extend(names)
        return whole(out, design, names, cores)

    monkeypatch.setitem(run_checks.__globals__, "_measured", noted)
    found = diff(before, edited)["checks"]
    assert "layout.wiring" in [e["check"] for e in found["fails_b"]]
    assert found["fails_a"] == []
    assert "layout" in measured
    assert not {"board", "orders", "mould", "backing"} & set(measured)
    page = (tmp_path / "diff" / "diff.html").read_text(encoding="utf-8")
    assert "Fails in B alone" in page
    assert str(tmp_path) not in page + json.dumps(found)  # notes name files by their paths
    assert "channel: a list of" in page
    lines = capsys.readouterr().out.splitlines()
    assert lines[2].startswith("checks        B alone FAILS ")


def test_a_parameter_file_is_built_first(
    outputs: Path, design_dir: Path, diff: Diff, capsys: pytest.CaptureFixture[str]
) -> None:
    found = diff(design_dir / "presets" / "published.toml", outputs)
    assert not any(found["files"].values())
    assert found["a"]["name"] == "published.toml"
    assert "no difference" in capsys.readouterr().out


def test_json_is_the_file(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "diff"
    assert main(["diff", str(outputs), str(outputs), "--json", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert printed == (out / "diff.json").read_text(encoding="utf-8")
    assert json.loads(printed)["a"] == json.loads(printed)["b"]
