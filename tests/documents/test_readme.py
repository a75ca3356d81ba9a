"""README's promises: its code runs, its commands exist, its figures are those of the files."""

import json
import re
import tomllib

import pytest

from markdown_pages import README, ROOT, code_blocks

TEXT = README.read_text("utf-8")
FIGURES = json.loads((ROOT / "docs/site/preset_figures.json").read_text("utf-8"))
READING = (ROOT / "docs/reading.md").read_text("utf-8")
PRICE = re.compile(r"about (\d+) EUR")
NEAR = 0.05


def test_the_five_lines_of_python_run(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = code_blocks(TEXT, "python")
    assert len([line for line in code.splitlines() if line.strip()]) == 5
    exec(compile(code, "README.md", "exec"), {})
    kind, offset_mm, angle_deg, sd_mm = capsys.readouterr().out.split()
    assert kind == "cable"
    assert abs(float(offset_mm)) < 20.0
    assert abs(float(angle_deg)) <= 90.0
    assert 0.0 < float(sd_mm) < 1.0


def test_the_python_of_the_page_on_reading_runs_on_the_twin() -> None:
    """The finger that it opens is a simulated one here; all else is as it stands."""
    address = '"ble://Lumitip", layout="outputs/layout.json"'
    frames, contact = code_blocks(READING, "python")
    assert frames.count(address) == 1
    names: dict[str, object] = {}
    inside = "".join(f"    {line}" for line in contact.splitlines(keepends=True))
    code = frames.replace(address, '"twin://edge"') + inside
    exec(compile(code, "docs/reading.md", "exec"), names)
    values = names["block"].values  # type: ignore[attr-defined]
    assert values.shape[0] == 55
    assert names["contact"].shape in ("none", "edge", "covered")  # type: ignore[attr-defined]


def test_every_make_target_of_the_readme_exists_and_the_build_server_runs_its_tests() -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"^make (\w+)|`make\s(\w+)`", TEXT, re.MULTILINE))
    named = {one or other for one, other in targets}
    assert {"outputs", "readout", "test", "check"} <= named
    for target in named:
        assert re.search(rf"^{target}: .*## ", makefile, re.MULTILINE), target
    assert "\nmake test\n" in (ROOT / ".ci/run").read_text("utf-8")


@pytest.mark.parametrize("script", re.findall(r"`python ([\w/]+\.py)", TEXT))
def test_a_script_that_the_readme_names_exists(script: str) -> None:
    assert (ROOT / script).is_file()


def test_the_table_of_presets_has_every_preset() -> None:
    table = (ROOT / "docs/design.md").read_text("utf-8").partition("| preset |")[2]
    rows = [line for line in table.partition("\n\n")[0].splitlines() if ".toml" in line]
    found = [name for row in rows for name in re.findall(r"`(\w+\.toml)`", row.split(" | ")[0])]
    presets = sorted((ROOT / "design/presets").glob("*.toml"))
    assert sorted(found) == [preset.name for preset in presets]
    assert "Ten presets" in TEXT
    assert len(presets) == 10


def test_the_figures_of_poses_are_those_of_the_table() -> None:
    """Cable and edge of the second optical model, tared, rounded to the README's digits."""
    page = (ROOT / "docs/estimation.md").read_text("utf-8")
    for kind in ("cable", "edge"):
        row = re.search(rf"^\| {kind}, tared \| ([\d.]+) mm, ([\d.]+)° ", page, re.MULTILINE)
        assert row
        mm, deg = float(row[1]), float(row[2])
        assert re.search(rf"{mm:.2f} mm and {deg:.1f}°(?: rms)? for an? {kind}", TEXT), kind
        assert f"{kind}s to {mm:.2f} mm" in (ROOT / "docs/index.md").read_text("utf-8"), kind


def test_the_price_is_that_of_the_default_design() -> None:
    """`test_gallery.py` holds the gallery's price against a build's bill."""
    (stated,) = PRICE.findall(TEXT)
    assert float(stated) == pytest.approx(FIGURES["fingertip"]["price"], rel=NEAR)


def test_the_readme_of_the_package_is_this_one() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["readme"] == README.name
