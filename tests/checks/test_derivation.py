"""`resolved.toml` and `design.json` are one design, also with a catalogue of the user's own."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from damages import cut_short, edit, excerpt
from lumitip_fab.checks import derivation
from lumitip_fab.checks.result import Measurement
from lumitip_fab.cli.build import build
from lumitip_fab.design.encoding import read_design

LED = "15406085BA300"


def failed(folder: Path) -> list[Measurement]:
    """Measurements of the module that fail."""
    found = list(derivation.measure(folder, read_design(folder / "design.json")))
    assert found
    return [m for m in found if not m.passed]


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """Both files of the published design, to damage."""
    return excerpt(outputs, tmp_path / "copied", "resolved.toml")


def in_design(change: Callable[[dict[str, Any]], object]) -> Callable[[Path], None]:
    """Change values of `design.json`."""

    def damage(folder: Path) -> None:
        path = folder / "design.json"
        record = json.loads(path.read_text())
        change(record)
        path.write_text(json.dumps(record))

    return damage


DAMAGES: dict[str, tuple[Callable[[Path], None], str]] = {
    "pitch": (
        lambda folder: edit(folder / "resolved.toml", "pitch_mm = 6.0", "pitch_mm = 6.1"),
        "design",
    ),
    "choice": (
        lambda folder: edit(folder / "resolved.toml", f'led = "{LED}"', 'led = "VSMY1850"'),
        "design",
    ),
    "part in a comment": (
        lambda folder: edit(folder / "resolved.toml", '# manufacturer = "Yageo"', "#"),
        "values",
    ),
    "end lost": (lambda folder: cut_short(folder / "resolved.toml", 9000), "values"),
    "text": (lambda folder: edit(folder / "resolved.toml", "[grid]", "[grid"), "design"),
    "gone": (lambda folder: (folder / "resolved.toml").unlink(), "design"),
    "switch": (in_design(lambda d: d["wiring"].update(apart=not d["wiring"]["apart"])), "design"),
    "order": (in_design(lambda d: d["cabling"]["cables"].reverse()), "design"),
    "chosen": (in_design(lambda d: d["choices"][0].update(value="9.9")), "choices"),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("case", DAMAGES)
def test_a_figure_that_was_changed_in_one_of_them(case: str, copied: Path) -> None:
    damage, name = DAMAGES[case]
    damage(copied)
    assert f"derivation.{name}" in {m.check for m in failed(copied)}


def test_the_built_design_follows(copied: Path) -> None:
    assert failed(copied) == []


def test_a_catalogue_of_the_users_own_goes_with_the_outputs(
    design_dir: Path, tmp_path: Path
) -> None:
    own = tmp_path / "own"
    (own / "parts").mkdir(parents=True)
    text = (design_dir / "parts" / "leds.toml").read_text(encoding="utf-8")
    (own / "parts" / "leds.toml").write_text(text.replace(LED, "OURS"), encoding="utf-8")
    shutil.copy(design_dir / "presets" / "published.toml", own / "finger.toml")
    edit(own / "finger.toml", 'led = "auto"', 'led = "OURS"')
    out = tmp_path / "out"
    build(own / "finger.toml", out, only=("firmware",))
    assert [f.name for f in (out / "parts").iterdir()] == ["leds.toml"]
    assert failed(out) == []
    (out / "parts" / "leds.toml").unlink()
    assert [m.check for m in failed(out)] == ["derivation.design"]


def test_a_catalogue_in_the_output_folder_is_not_an_output(
    design_dir: Path, tmp_path: Path
) -> None:
    """Outputs beside the parameter file: the user's own catalogue is neither listed nor removed."""
    (tmp_path / "parts").mkdir()
    own = tmp_path / "parts" / "leds.toml"
    text = (design_dir / "parts" / "leds.toml").read_text(encoding="utf-8")
    own.write_text(text.replace(LED, "OURS"), encoding="utf-8")
    ours, theirs = tmp_path / "ours.toml", design_dir / "presets" / "published.toml"
    shutil.copy(theirs, ours)
    edit(ours, 'led = "auto"', 'led = "OURS"')
    build(ours, tmp_path, only=("firmware",))
    assert failed(tmp_path) == []
    build(theirs, tmp_path, only=("firmware",))
    assert own.read_text(encoding="utf-8") != text


def test_a_catalogue_around_the_outputs_is_not_theirs(copied: Path) -> None:
    parts = copied.parent / "parts"
    parts.mkdir()
    (parts / "tapes.toml").write_text("half [")
    assert failed(copied) == []
