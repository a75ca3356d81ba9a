"""The build: what is made again, what is left alone, and that bytes are the same anywhere."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lumitip import Layout
from lumitip_fab.cli.build import build
from lumitip_fab.errors import InputError, OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.build import locked

pytestmark = pytest.mark.slow

PUBLISHED = "presets/published.toml"


def contents(folder: Path) -> dict[str, bytes]:
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*") if f.is_file()}


def test_a_second_build_changes_nothing(design_dir: Path, damaged: Path) -> None:
    before = contents(damaged)
    report = build(design_dir / PUBLISHED, damaged)
    assert report.made == ()
    assert report.written == ()
    assert contents(damaged) == before


@pytest.mark.parametrize("lose", [True, False], ids=["missing", "edited"])
def test_a_lost_or_edited_file_is_made_again(design_dir: Path, damaged: Path, lose: bool) -> None:
    before = contents(damaged)
    victim = damaged / "mask" / "receiver_mask.svg"
    if lose:
        victim.unlink()
    else:
        victim.write_bytes(victim.read_bytes() + b"<!-- mine -->")
    report = build(design_dir / PUBLISHED, damaged)
    assert report.made == ("mask.receiver",)
    assert contents(damaged) == before


@pytest.mark.parametrize("text", ["", "[]", '{"schema_version": 1, "files": 7, "tasks": {}}'])
def test_a_spoilt_manifest_counts_as_none(tmp_path: Path, text: str) -> None:
    (tmp_path / "manifest.json").write_text(text)
    assert manifest.read(tmp_path) == manifest.Manifest({}, {})


def test_files_that_a_design_no_longer_has_are_removed(design_dir: Path, damaged: Path) -> None:
    before = manifest.read(damaged)
    stray = damaged / "mask" / "old.pdf"
    stray.write_bytes(b"old")
    own = damaged / "notes.txt"
    own.write_text("mine")
    entry = next(iter(before.files.values()))
    files = {**before.files, "mask/old.pdf": entry, "../outside.txt": entry}
    outside = damaged.parent / "outside.txt"
    outside.write_text("not ours")
    manifest.write(damaged, manifest.Manifest(files, before.tasks))
    # Both strays count as a task's files, so that task is remade and then does not have them.
    report = build(design_dir / PUBLISHED, damaged)
    assert report.removed == ("mask/old.pdf",)
    assert not stray.exists()
    assert own.exists()
    assert outside.exists()


def test_a_refused_input_writes_nothing(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "fingertip.toml"
    file.write_text(file.read_text().replace("pitch_mm = 6.0", "pitch_mm = 2.6"))
    with pytest.raises(InputError):
        build(file, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_where_a_file_belongs_is_named(design_dir: Path, tmp_path: Path) -> None:
    (tmp_path / "out" / "layout.json").mkdir(parents=True)
    with pytest.raises(OutputError, match=r"out/layout\.json: cannot be written: Is a directory"):
        build(design_dir / "fingertip.toml", tmp_path / "out")


def test_an_output_folder_that_is_a_file_is_refused(design_dir: Path, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("here already")
    with pytest.raises(OutputError, match="cannot be written"):
        build(design_dir / PUBLISHED, tmp_path / "out" / "below")
    assert (tmp_path / "out").read_text() == "here already"


def test_a_second_build_at_the_same_time_is_refused(design_dir: Path, damaged: Path) -> None:
    (damaged / "mask" / "receiver_mask.svg").unlink()
    before = contents(damaged)
    with locked(damaged), pytest.raises(OutputError, match="another build is writing there"):
        build(design_dir / PUBLISHED, damaged)
    assert contents(damaged) == before
    assert build(design_dir / PUBLISHED, damaged).written == ("mask/receiver_mask.svg",)


def test_same_bytes_in_another_folder_process_and_hash_seed(
    outputs: Path, design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "elsewhere"))
    out = tmp_path / "deeper" / "out"
    subprocess.run(
        [
            sys.executable,
            "-m",
            "lumitip_fab",
            "build",
            str(folder / PUBLISHED),
            "--out",
            str(out),
            "--quiet",
        ],
        check=True,
        env={**os.environ, "PYTHONHASHSEED": "4711"},
        cwd=tmp_path,
    )
    here, there = contents(outputs), contents(out)
    assert here.keys() == there.keys()
    assert [path for path in here if here[path] != there[path]] == []


def test_the_manifest_has_every_file_with_a_rigid_matrix(outputs: Path) -> None:
    told = manifest.read(outputs)
    assert set(told.files) == set(contents(outputs)) - {"manifest.json", ".built"}
    for path, entry in told.files.items():
        turn = np.array(entry.to_sensor)[:3, :3]
        if path.endswith((".stl", ".3mf", ".step")):
            np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-8, err_msg=path)
            assert np.linalg.det(turn) == pytest.approx(1.0)


def test_layout_is_read_with_the_designs_hash(outputs: Path) -> None:
    layout = Layout.load(outputs / "layout.json")
    told = json.loads((outputs / "manifest.json").read_text())
    assert layout.design_hash == told["design_hash"]
    assert len(layout) == 32


def test_resolved_values_build_the_same_design(outputs: Path, tmp_path: Path) -> None:
    shutil.copy(outputs / "resolved.toml", tmp_path / "again.toml")
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive
    from lumitip_fab.design.encoding import design_text

    again = json.loads(design_text(derive(load(tmp_path / "again.toml"))))
    built = json.loads((outputs / "design.json").read_text())
    assert built.pop("choices")
    assert again.pop("choices") == [], "every value in the file is concrete"
    assert again == built
