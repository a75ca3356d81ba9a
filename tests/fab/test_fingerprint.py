"""The one hash of all that a build reads."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab.cli.build import build
from lumitip_fab.pipeline import fingerprint
from lumitip_fab.pipeline.fingerprint import input_hash


@pytest.fixture
def folder(design_dir: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(design_dir, tmp_path / "design"))


def test_it_is_the_same_in_another_folder(design_dir: Path, folder: Path) -> None:
    assert input_hash(design_dir / "fingertip.toml") == input_hash(folder / "fingertip.toml") != ""


@pytest.mark.parametrize(
    "path", ["presets/asymmetric.toml", "presets/published.toml", "parts/leds.toml"]
)
def test_each_file_that_is_read_counts(folder: Path, path: str) -> None:
    file = folder / "presets" / "asymmetric.toml"  # extends published.toml
    before = input_hash(file)
    (folder / path).write_text((folder / path).read_text() + "\n# a remark\n")
    assert input_hash(file) != before


def test_a_base_of_a_base_counts(folder: Path) -> None:
    file = folder / "mine.toml"
    file.write_text('extends = "presets/asymmetric.toml"\n')
    before = input_hash(file)
    assert before
    published = folder / "presets" / "published.toml"
    published.write_text(published.read_text() + "\n# a remark\n")
    assert input_hash(file) != before


def test_a_circle_of_bases_has_an_end(folder: Path) -> None:
    file = folder / "mine.toml"
    file.write_text('extends = "other.toml"\n')
    (folder / "other.toml").write_text('extends = "mine.toml"\n')
    assert input_hash(file)


def test_another_preset_does_not_count(folder: Path) -> None:
    file = folder / "fingertip.toml"
    before = input_hash(file)
    (folder / "presets" / "dense.toml").write_text("")
    assert input_hash(file) == before


@pytest.mark.parametrize("depends", ["whole_code_hash", "installed_hash"])
def test_code_and_tools_count(
    design_dir: Path, monkeypatch: pytest.MonkeyPatch, depends: str
) -> None:
    before = input_hash(design_dir / "fingertip.toml")
    monkeypatch.setattr(fingerprint, depends, lambda: "another")
    assert input_hash(design_dir / "fingertip.toml") != before


@pytest.mark.parametrize(
    "text", [None, "not toml", 'extends = "missing.toml"', 'extends = "\\u0000"']
)
def test_an_input_that_cannot_be_read_has_none(folder: Path, text: str | None) -> None:
    file = folder / "mine.toml"
    if text is not None:
        file.write_text(text)
    assert input_hash(file) == ""


@pytest.mark.parametrize("path", ["manifest.json", ".built", "mask/emitter_wrapping.md"])
def test_a_folder_that_was_edited_is_not_unchanged(
    design_dir: Path, damaged: Path, path: str
) -> None:
    told = input_hash(design_dir / "presets" / "published.toml")
    assert fingerprint.unchanged(damaged, told)
    (damaged / path).write_bytes((damaged / path).read_bytes() + b" ")
    assert not fingerprint.unchanged(damaged, told)


def test_a_remark_makes_nothing_again(folder: Path, damaged: Path) -> None:
    file = folder / "presets" / "published.toml"
    file.write_text(file.read_text() + "\n# a remark\n")
    report = build(file, damaged)
    assert report.made == ()
    assert report.written == ()
