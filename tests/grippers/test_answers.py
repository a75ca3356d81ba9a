"""From the answers to an entry of the catalogue: every fault at once, and a design with it."""

import json
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pytest
import trimesh

from lumitip_fab.cli import main
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.grippers.answers import OPEN, read_answers
from lumitip_fab.grippers.figures import TEXTS, figures
from lumitip_fab.grippers.trial import example
from lumitip_fab.text import table_of


def test_every_figure_says_how_it_is_measured() -> None:
    texts, names = table_of(TEXTS), {figure.name for figure in figures()}
    assert set(texts["figures"]) == names
    assert set(texts["optional"]) | set(texts["chosen"]) < names
    assert {figure.table for figure in figures()} == {"", *texts["answers"]["tables"]}


def test_the_answers_file_asks_for_every_figure(tmp_path: Path) -> None:
    assert main(["gripper", "new", "my_jaw", "--out", str(tmp_path), "--quiet"]) == 0
    text = (tmp_path / "my_jaw.toml").read_text(encoding="utf-8")
    asked = tomllib.loads(text)
    chosen = table_of(TEXTS)["chosen"]
    for figure in figures():
        table = asked[figure.table] if figure.table else asked
        answer = table[figure.name.rpartition(".")[2]]
        if figure.name in chosen:
            assert answer["value"] == chosen[figure.name]
            assert answer["confidence"] == "assumed"
        else:
            assert answer == OPEN
        assert f"# Allowed: {figure.allowed}." in text
    assert max(map(len, text.splitlines())) <= 100
    assert not (tmp_path / "my_jaw_gauge.stl").exists()  # no figure is known yet


def test_the_line_for_a_coupling_stands_where_it_belongs(tmp_path: Path) -> None:
    assert main(["gripper", "new", "my_jaw", "--out", str(tmp_path), "--quiet"]) == 0
    text = (tmp_path / "my_jaw.toml").read_text(encoding="utf-8")
    asked = tomllib.loads(text.replace('# base = ""', 'base = "Robotiq 2F"'))
    assert asked["base"] == "Robotiq 2F"


def test_figures_of_another_gripper_stand_beside(tmp_path: Path) -> None:
    assert main(["gripper", "new", "my_jaw", "--out", str(tmp_path), "--like", "wsg50"]) == 0
    text = (tmp_path / "my_jaw.toml").read_text(encoding="utf-8")
    assert "Allowed: 0.01 to 500. (Weiss WSG 50: 21.0)\nbolt_spacing_mm" in text
    assert (tmp_path / "my_jaw_gauge.stl").is_file()


def test_open_answers_are_all_reported_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["gripper", "new", "my_jaw", "--out", str(tmp_path), "--quiet"])
    file = tmp_path / "my_jaw.toml"
    assert main(["gripper", "new", "my_jaw", "--answers", str(file)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == len(figures()) - len(table_of(TEXTS)["chosen"])
    number = 1 + file.read_text(encoding="utf-8").splitlines().index('stroke_mm = "?"')
    assert f'{file}:{number}: stroke_mm is "?"; 0.01 to 500 is needed. Open the gripper' in lines[0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["my_jaw.html", "my_jaw.toml"]


def test_an_entry_from_the_answers_is_that_gripper(fill: Any, config: Input) -> None:
    for name, gripper in {"jaw": example(config.catalogue), **config.catalogue.grippers}.items():
        based = {"base": gripper.base} if gripper.base else {}
        read = read_answers(fill(name, gripper, title="My jaw", **based))
        own = {"source", "confidence", "title", "origin"}
        assert read.model_dump(exclude={*own, "envelope"}) == gripper.model_dump(
            exclude={*own, "envelope"}
        )
        assert read.envelope.model_dump(exclude=own) == gripper.envelope.model_dump(exclude=own)
        assert (read.source, read.confidence) == ("measured with calipers by its user", "measured")
        assert (read.unsure, read.title) == ({}, "My jaw")


NOSE = {"front_width_mm": 12.0, "front_w_mm": 3.0, "half_angle_deg": 40.0, "height_mm": 2.5}
FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "range": ({"land_mm": 700.0}, "land_mm is 700.0; at most 500 is allowed"),
    "pitch": (
        {"bolt": "M4x0.7"},
        """bolt is 'M4x0.7'; M and the diameter of a metric thread, as in "M4" or "M2.5",""",
    ),
    "text": ({"stroke_mm": "60 mm"}, "stroke_mm is '60 mm'; a number is needed: write 60"),
    "unknown": ({"bold": 1}, "bold is not a known key. Did you mean 'bolt'?"),
    "open": ({"bolt": OPEN}, 'bolt is "?"; a metric thread such as "M4" is needed. Outside jaws'),
    "source": (
        {"land_mm": {"value": 4.5, "source": "a guess", "confidence": "sure"}},
        "land_mm.confidence is 'sure'; 'datasheet', 'measured', 'inferred' or 'assumed' is allowed",
    ),
    "wall": ({"bolt_spacing_mm": 8.5}, "whose block has 0.50 mm of wall between its counterbores"),
    "pins": (
        {"pins": {"hole_mm": 3.0, "spacing_mm": 40.0, "depth_mm": 2.6}},
        "whose block has -7.50 mm of wall beside its pins",
    ),
    "pins_at_the_side": (
        {"pins": {"hole_mm": 3.0, "spacing_mm": 27.0, "depth_mm": 2.6}},
        "whose block has -1.00 mm of wall beside its pins",
    ),
    "pins_together": (
        {"pins": {"hole_mm": 3.0, "spacing_mm": 2.0, "depth_mm": 2.6}},
        "whose block has -1.00 mm of wall between its pins",
    ),
    "sleeves": (
        {"pins": {"hole_mm": 3.0, "spacing_mm": 16.0, "depth_mm": 2.6}},
        "is for sleeves round them; more than bolt_hole_mm = 4.4 is needed",
    ),
    "nose": (
        {"nose": NOSE | {"front_width_mm": 40.0}},
        "whose nose is 40.4 mm wide at the front of its block; less than block_width_mm = 28",
    ),
    "nose_before_the_block": (
        {"nose": NOSE | {"front_w_mm": -20.0}},
        "whose nose is 51.0 mm wide at the front of its block",
    ),
    "bolt": ({"bolt": "M5"}, "whose bolt_hole_mm = 4.4 is not a clearance hole for an M5"),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_answers_is_refused_and_nothing_is_written(
    fault: str, fill: Any, config: Input, capsys: pytest.CaptureFixture[str]
) -> None:
    changes, message = FAULTS[fault]
    file = fill("my_jaw", config.catalogue.grippers["two_hole_jaw"], **changes)
    assert main(["gripper", "new", "my_jaw", "--answers", str(file)]) == 2
    assert message in capsys.readouterr().err
    assert not (file.parent / "my_jaw_entry.toml").exists()


def test_faults_of_several_answers_come_together(
    fill: Any, config: Input, capsys: pytest.CaptureFixture[str]
) -> None:
    jaw = config.catalogue.grippers["two_hole_jaw"]
    file = fill("my_jaw", jaw, land_mm=-1.0, bolt=OPEN, bold=2, tilt_deg=20.0)
    assert main(["gripper", "new", "my_jaw", "--answers", str(file), "--json"]) == 2
    printed = json.loads(capsys.readouterr().out)
    assert [p["field"] for p in printed["problems"]] == ["tilt_deg", "bolt", "land_mm", "bold"]


def test_the_weakest_source_of_a_table_is_that_of_the_table(fill: Any, config: Input) -> None:
    jaw = example(config.catalogue)
    file = fill("my_jaw", jaw)
    text = file.read_text(encoding="utf-8")
    guess = '{ value = 2.6, source = "seen from outside", confidence = "assumed" }'
    assert "depth_mm = 2.6" in text
    file.write_text(text.replace("depth_mm = 2.6", f"depth_mm = {guess}"), encoding="utf-8")
    read = read_answers(file)
    assert list(read.unsure) == ["pins"]
    assert read.origin["pins"].source.endswith("; depth_mm: seen from outside")
    assert read.pins == jaw.pins


@pytest.mark.slow
def test_a_design_is_derived_with_the_new_entry(
    fill: Any, config: Input, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    jaw = config.catalogue.grippers["two_hole_jaw"]
    answers = str(fill("my_jaw", jaw, bolt_spacing_mm=17.0))
    assert main(["init", str(tmp_path / "mine"), "--quiet"]) == 0
    own, parts = tmp_path / "mine/fingertip.toml", tmp_path / "mine/parts/grippers.toml"
    before = parts.read_text(encoding="utf-8")
    command = ["gripper", "new", "my_jaw", "--answers", answers, "--file", str(own), "--add"]
    assert main(command) == 0
    printed = capsys.readouterr().out
    assert 'coupling.gripper = "my_jaw"' in printed
    assert f"lumitip-fab schema {own} > {own.parent}/schema.json" in printed
    after = parts.read_text(encoding="utf-8")
    assert after.startswith(before.rstrip())
    assert (Path(answers).parent / "my_jaw_entry.toml").read_text(encoding="utf-8") in after
    held = tmp_path / "mine/held.toml"
    held.write_text('extends = "presets/published.toml"\n[coupling]\ngripper = "my_jaw"\n')
    mount = derive(load(held)).mount
    assert (mount.gripper, mount.bolt_u_mm) == ("my_jaw", (-8.5, 8.5))

    assert main(command) == 2  # never twice
    assert "has an entry 'my_jaw' already" in capsys.readouterr().err
    assert parts.read_text(encoding="utf-8") == after
    file = Path(answers)
    file.write_text(file.read_text().replace("bolt_spacing_mm = 17.0", "bolt_spacing_mm = 18.0"))
    assert main([*command, "--replace"]) == 0
    assert load(held).catalogue.grippers["my_jaw"].bolt_spacing_mm == 18.0
    assert len(load(held).catalogue.grippers) == len(config.catalogue.grippers) + 1


def test_a_folder_without_a_catalogue_gets_the_packaged_one_and_the_entry(
    fill: Any, config: Input, tmp_path: Path, design_dir: Path
) -> None:
    answers = str(fill("my_jaw", config.catalogue.grippers["two_hole_jaw"]))
    own = tmp_path / "own/presets/published.toml"
    own.parent.mkdir(parents=True)
    own.write_bytes((design_dir / "presets/published.toml").read_bytes())
    add = ["--file", str(own), "--add", "--quiet"]
    assert main(["gripper", "new", "my_jaw", "--answers", answers, *add]) == 0
    assert "my_jaw" in load(own).catalogue.grippers
    assert set(config.catalogue.grippers) < set(load(own).catalogue.grippers)


def test_no_file_is_lost(fill: Any, config: Input, capsys: pytest.CaptureFixture[str]) -> None:
    file = fill("my_jaw", config.catalogue.grippers["two_hole_jaw"])
    mine = file.read_bytes()
    assert main(["gripper", "new", "my_jaw", "--out", str(file.parent)]) == 2
    assert capsys.readouterr().err == (
        f"{file}: exists, and its content differs. Choose another folder, or add --replace.\n"
    )
    assert file.read_bytes() == mine


def test_a_gauge_of_another_finger_takes_the_place_of_the_last(
    fill: Any, config: Input, design_dir: Path, tmp_path: Path
) -> None:
    """The entry is added with the user's file, after a gauge of the published finger was tried."""
    file = fill("my_jaw", config.catalogue.grippers["two_hole_jaw"])
    command = ["gripper", "new", "my_jaw", "--answers", str(file), "--quiet"]
    assert main(command) == 0
    gauge, entry = (file.with_name(f"my_jaw_{name}") for name in ("gauge.stl", "entry.toml"))
    first = gauge.read_bytes()
    shutil.copytree(design_dir, tmp_path / "own")
    own = tmp_path / "own/thick.toml"
    own.write_text('extends = "presets/published.toml"\n[stack]\nfloor_mm = 1.5\n')
    assert main([*command, "--file", str(own), "--add"]) == 0
    assert gauge.read_bytes() != first
    entry.write_text(entry.read_text() + "# mine\n")
    assert main([*command, "--file", str(own)]) == 2, "an entry may have been edited"


def test_usage(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out = ["--out", str(tmp_path / "out")]
    assert main(["gripper", "new", "My/jaw", "--add", *out]) == 2
    printed = capsys.readouterr().err
    assert "NAME is 'My/jaw'; lowercase letters, digits" in printed
    assert "--add: needs --answers" in printed
    assert "--add: needs --file" in printed
    both = ["--like", "wsg50", "--answers", "jaw.toml"]
    assert main(["gripper", "new", "jaw", *both, *out]) == 2
    assert "--like: cannot be combined with --answers" in capsys.readouterr().err
    assert main(["gripper", "new", "jaw", "--like", "wsg5", *out]) == 2
    assert (
        "--like is 'wsg5', which does not exist. Did you mean 'wsg50'?" in capsys.readouterr().err
    )
    assert not (tmp_path / "out").exists()


def test_the_gauge_is_that_of_the_answers(fill: Any, config: Input) -> None:
    jaw = config.catalogue.grippers["two_hole_jaw"]
    file = fill("my_jaw", jaw, land_mm=5.0)
    assert main(["gripper", "new", "my_jaw", "--answers", str(file), "--quiet"]) == 0
    gauge = trimesh.load(file.parent / "my_jaw_gauge.stl")
    assert gauge.is_watertight
    assert gauge.bounds[:, 0] == pytest.approx([-14.0, 14.0], abs=0.01)
    assert gauge.bounds[1, 1] == pytest.approx(jaw.block_back_w_mm, abs=0.01)
    assert gauge.bounds[:, 2] == pytest.approx([0.0, 8.0], abs=0.01)
