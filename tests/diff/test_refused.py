"""Inputs of `lumitip-fab diff` that cannot be compared: one clear error, and nothing is written."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli import main

pytestmark = pytest.mark.slow


def _cut(path: str) -> Callable[[Path], None]:
    def cut(out: Path) -> None:
        file = out / path
        file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])

    return cut


def _edit(path: str, old: str, new: str) -> Callable[[Path], None]:
    def edit(out: Path) -> None:
        text = (out / path).read_text(encoding="utf-8")
        assert old in text
        (out / path).write_text(text.replace(old, new), encoding="utf-8")

    return edit


def _frame(out: Path) -> None:
    """Stretch the frame of a board."""
    record = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
    record["files"]["boards/emitter/emitter.kicad_pcb"]["to_sensor"][0][0] = 2.0
    (out / "manifest.json").write_text(json.dumps(record), encoding="utf-8")


def _open(out: Path) -> None:
    """Take one triangle out of an STL."""
    file = out / "mould/prop.stl"
    data = file.read_bytes()
    count = int.from_bytes(data[80:84], "little") - 1
    file.write_bytes(data[:80] + count.to_bytes(4, "little") + data[84 : 84 + 50 * count])


DAMAGES: dict[str, tuple[Callable[[Path], None], str]] = {
    "no manifest": (lambda out: (out / "manifest.json").unlink(), "no usable manifest.json"),
    "foreign": (lambda out: (out / "manifest.json").write_text("[]"), "no usable manifest.json"),
    "a file less": (lambda out: (out / "mould/clamp.stl").unlink(), "such as mould/clamp.stl"),
    "design": (_cut("design.json"), "not a design of this version"),
    "parameters": (_cut("resolved.toml"), "resolved.toml: cannot be read"),
    "bill": (_cut("bom.csv"), "bom.csv: cannot be read"),
    "order": (_cut("order.csv"), "order.csv: cannot be read"),
    "cables": (_cut("wiring/cables.csv"), "wiring/cables.csv: cannot be read"),
    "mesh": (_cut("mould/prop.stl"), "mould/prop.stl: cannot be read"),
    "open mesh": (_open, "mould/prop.stl: cannot be read"),
    "price": (_edit("bom.csv", ",0.20\n", ",much\n"), "bom.csv: cannot be read"),
    "column": (_edit("bom.csv", "quantity", "number"), "no row with quantity"),
    "no rows": (lambda out: (out / "order.csv").write_text("item,price\n"), "no row with price"),
    "total": (_edit("bom.csv", "total,", "sum,"), "bom.csv: cannot be read (no total)"),
    "endless": (_edit("wiring/cables.csv", ",260,", ",inf,"), "length_mm is inf"),
    "facts": (_edit("manifest.json", '"mix_ml"', '"mix"'), "manifest.json: cannot be read"),
    "frame": (_frame, "to_sensor is no rotation"),
    "board": (_cut("boards/flange/flange.kicad_pcb"), "flange.kicad_pcb: cannot be read"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_folder_is_named_and_nothing_is_written(
    damage: str,
    outputs: Path,
    damaged: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    change, reason = DAMAGES[damage]
    change(damaged)
    out = tmp_path / "diff"
    for pair in ((damaged, outputs), (outputs, damaged)):
        assert main(["diff", *map(str, pair), "--out", str(out), "--no-checks"]) == 2
        printed = capsys.readouterr()
        assert printed.err.count("\n") == 1
        assert reason in printed.err
        assert str(damaged) in printed.err
        assert printed.out == ""
        assert not out.exists()


def test_a_path_that_is_nothing_is_named(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["diff", str(outputs), str(tmp_path / "gone"), "--out", str(tmp_path / "d")]) == 2
    assert f"B: is {tmp_path / 'gone'}, which does not exist" in capsys.readouterr().err


def test_a_parameter_file_that_is_rejected_says_why(
    outputs: Path, design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(design_dir, tmp_path / "design")
    file = tmp_path / "design" / "fingertip.toml"
    file.write_text(file.read_text().replace("pitch_mm = 6.0", "pitch_mm = -6.0"))
    assert main(["diff", str(file), str(outputs), "--out", str(tmp_path / "d")]) == 2
    assert "grid.pitch_mm" in capsys.readouterr().err
    assert not (tmp_path / "d").exists()


def test_the_page_is_not_written_into_a_design(
    edited: Path, outputs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["diff", str(outputs), str(edited), "--out", str(edited / "diff")]) == 2
    assert "is inside" in capsys.readouterr().err
    assert not (edited / "diff").exists()


def test_a_folder_that_cannot_be_written_is_named(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    out = tmp_path / "file" / "diff"
    assert main(["diff", str(outputs), str(outputs), "--out", str(out)]) == 2
    assert f"--out: is {out}, which cannot be written" in capsys.readouterr().err
