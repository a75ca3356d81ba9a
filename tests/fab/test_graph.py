"""Which change makes which task run again."""

import ast
import json
import re
import shutil
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import pytest

from lumitip_fab.cli.build import build
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import fingerprint as toolchain
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.artefact import Files, Made
from lumitip_fab.pipeline.dependencies import Dependencies, FieldHashes, RecordedDesign
from lumitip_fab.pipeline.workers import tasks

PACKAGE = toolchain.PACKAGE
EARLY = tuple(step for step in STEPS if not step.late)
LATE = tuple(step for step in STEPS if step.late)
Keys = Callable[..., dict[str, str]]


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the package's code, which `toolchain` takes for the package."""
    copied = tmp_path / "package"
    shutil.copytree(PACKAGE, copied, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(toolchain, "PACKAGE", copied)
    return copied


@pytest.fixture
def keys(outputs: Path, design_dir: Path, tmp_path: Path) -> Keys:
    """Key of every early task of the published design with some lines added, with what that task
    read when the design was built."""
    ran = manifest.read(outputs).tasks

    def of(text: str = "") -> dict[str, str]:
        file = tmp_path / "presets" / "changed.toml"
        file.parent.mkdir(exist_ok=True)
        published = design_dir / "presets" / "published.toml"
        (file.parent / "published.toml").write_bytes(published.read_bytes())
        (tmp_path / "parts").mkdir(exist_ok=True)
        file.write_text('extends = "published.toml"\n' + text)
        design = derive(load(file))
        hashes = FieldHashes(design)
        return {
            task.name: ran[task.name].dependencies.key(hashes, {}, *task.fixed())
            for task in tasks(EARLY, design)
        }

    return of


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    assert before.keys() == after.keys()
    return {name.partition(".")[0] for name in before if before[name] != after[name]}


def test_controller_name_touches_the_firmware_alone(keys: Keys) -> None:
    assert changed(keys(), keys('[controller]\nname = "Other"\n')) == {"firmware"}


def test_mask_hole_touches_the_mask_and_what_reads_the_layout(keys: Keys) -> None:
    assert changed(keys(), keys("[mask]\nhole_mm = 2.0\n")) == {
        "mask",
        "mask_sheet",
        "coupon",
        "creasing",
        "firmware",
        "gauge_card",
        "slicer",  # its note lists the gauge card, whose window is round the holes
    }


def test_waste_of_silicone_touches_the_mould_and_what_shares_its_figures(keys: Keys) -> None:
    assert "backing" not in changed(keys(), keys("[mould]\nwaste_fraction = 0.5\n"))


def test_pitch_touches_everything_of_the_fingers(keys: Keys) -> None:
    # What holds the controller and the flange's circuit know nothing of the cells. The slicer's
    # note lists the clamp, for which not every grid has room. There is no insert.
    outside = {
        "holder",
        "insert",
        "flange",
        "models",
        "supply_spice",
        "plug_in_spice",
        "discharge_spice",
    }
    assert (
        changed(keys(), keys("[grid]\npitch_mm = 6.1\n")) == {step.name for step in EARLY} - outside
    )


def test_what_is_outside_touches_no_finger(keys: Keys) -> None:
    after = keys("[breakout]\nhole_spacing_mm = 34.0\n")
    boards = {"other_board", "models", "wiring"}  # all boards are read there
    assert changed(keys(), after) == {*boards, "holder"}
    assert changed(keys(), keys("[holder]\nbody_mm = 76.0\n")) == {"holder"}


def test_lengths_of_wires_touch_the_wiring_alone(keys: Keys) -> None:
    assert changed(keys(), keys("[wiring]\nslack_mm = 45.0\n")) == {"wiring"}


def test_wires_longer_than_a_channel_is_made_for_touch_its_circuit_and_its_wait(keys: Keys) -> None:
    longer = changed(keys(), keys("[wiring]\ncontroller_mm = 500.0\n"))
    assert {"wiring", "finger_spice", "firmware"} <= longer
    assert not {"finger_board", "other_board", "backing", "mask"} & longer


def test_the_sheet_that_schematics_grow_from_touches_the_boards(package: Path) -> None:
    def hashes() -> list[str]:
        whole = toolchain.whole_code_hash.__wrapped__()
        return [code_hash("boards"), whole, code_hash("mask")]

    before = hashes()
    sheet = package / "boards/kicad/schematic/template.kicad_sch"
    sheet.write_text(sheet.read_text(encoding="utf-8").replace("passive", "input"), "utf-8")
    assert [a == b for a, b in zip(before, hashes(), strict=True)] == [False, False, True]


def code_hash(folder: str) -> str:
    """What is kept of a generator's code, read anew."""
    return toolchain.code_hash.__wrapped__(folder)


def imported(file: Path) -> set[Path]:
    """The modules of the package that a module imports, itself and theirs too, but for what
    `derive` imports: that reaches a generator in the design."""
    found, ahead = set(), [file]
    while ahead:
        module = ahead.pop()
        if module in found or not module.is_file():
            continue
        found.add(module)
        if PACKAGE / "derive" in module.parents:
            continue
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("lumitip_fab"):
                base = PACKAGE.joinpath(*str(node.module).split(".")[1:])
                ahead += [base.with_suffix(".py"), base / "__init__.py"]
                ahead += [base / f"{alias.name}.py" for alias in node.names]
    return found


@pytest.mark.slow
def test_whatever_a_generator_imports_makes_it_run_again(package: Path) -> None:
    steps = {step.room: set[Path]() for step in STEPS}
    for step in STEPS:
        steps[step.room] |= imported(
            PACKAGE.joinpath(*step.module.split(".")[1:]).with_suffix(".py")
        )
    assert PACKAGE / "text.py" in steps["docs"]
    unseen = []
    for folder, files in steps.items():
        before = code_hash(folder)
        for file in files - {PACKAGE / "__init__.py"}:
            copy = package / file.relative_to(PACKAGE)
            code = copy.read_text(encoding="utf-8")
            copy.write_text(code + "ANOTHER = 1\n", "utf-8")
            unseen += [f"{folder}: {copy.name}"] if code_hash(folder) == before else []
            copy.write_text(code, "utf-8")
    assert unseen == []


def test_every_step_has_its_function_and_a_task_for_each_item(keys: Keys, design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    for step in STEPS:
        assert callable(getattr(import_module(step.module), step.function.split(".")[-1]))
    items = [len(getattr(design, step.each)) if step.each else 1 for step in EARLY]
    assert len(keys()) == sum(items)
    assert len({step.name for step in STEPS}) == len(STEPS)


def test_what_uses_files_of_others_runs_again_when_those_or_their_facts_change(
    outputs: Path,
) -> None:
    built = manifest.read(outputs)
    design = derive(load(outputs / "resolved.toml"))
    hashes = FieldHashes(design)
    late = {task.name: task for task in tasks(LATE, design)}

    def all_keys(versions: dict[str, str]) -> dict[str, str]:
        return {
            name: built.tasks[name].dependencies.key(hashes, versions, *task.fixed())
            for name, task in late.items()
        }

    versions = {path: entry.version for path, entry in built.files.items()}
    before = all_keys(versions)
    assert changed(before, all_keys(versions | {"backing/emitter_backing.stl": "x"})) == {"bom"}
    assert changed(before, all_keys(versions | {"flange/another.stl": "x"})) == {"bom"}
    assert changed(before, all_keys(versions | {"assembly/assembly.glb": "x"})) == {
        "system",
        "work",
    }
    assert changed(before, all_keys(versions | {"mask/emitter_mask.svg": "x"})) == {
        "manual",
        "work",
        "wrapping",
    }
    entry = built.files["backing/emitter_backing.stl"]
    heavier = manifest.Entry(**vars(entry) | {"facts": {"volume_mm3": 1.0}})
    assert heavier.version != entry.version


def test_what_a_step_uses_of_others_is_recorded(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("a", encoding="utf-8")
    made = {"a.txt": Made("1", {"count": 3}), "b.csv": Made("2", {})}
    files = Files(tmp_path, made)
    assert files.text("a.txt") == "a"
    assert files.facts("a.txt") == {"count": 3}
    assert files.like("*.csv") == ("b.csv",)
    assert files.used == {"a.txt", "*.csv"}
    with pytest.raises(LookupError, match=r"c.txt: no earlier step made it"):
        files.read("c.txt")
    assert Files.of(files).used == set()


def test_what_is_read_of_a_design_is_recorded(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    seen = RecordedDesign(design)
    assert seen.stack == design.stack
    assert seen.fingers == design.fingers
    assert seen.fields == {"stack", "fingers"}


def test_a_key_follows_what_was_read_and_nothing_else(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    hashes, needs = FieldHashes(design), Dependencies(("stack",), ("a/*",))
    before = needs.key(hashes, {"a/b": "1", "c": "1"}, "code")
    assert needs.key(hashes, {"a/b": "1", "c": "2"}, "code") == before
    assert needs.key(hashes, {"a/b": "2", "c": "1"}, "code") != before
    assert needs.key(hashes, {"a/b": "1", "a/d": "1", "c": "1"}, "code") != before
    assert needs.key(hashes, {"a/b": "1", "c": "1"}, "other code") != before
    assert Dependencies(("tip",), ("a/*",)).key(hashes, {"a/b": "1", "c": "1"}, "code") != before


_MASK = re.compile(r"(mask/(emitter|receiver)_(?!sheet|wrapping)|manual/\w+_mask\.svg)")


@pytest.mark.slow
def test_only_the_steps_asked_for_run(design_dir: Path, damaged: Path) -> None:
    before = manifest.read(damaged)
    file = design_dir / "presets" / "dense.toml"
    masks = {"mask.emitter", "mask.receiver"}
    report = build(file, damaged, only=["mask", "bom"])
    assert set(report.made) == masks | {"bom"} and report.kept == ()
    again = build(file, damaged, only=["mask"])
    assert again.made == () and set(again.kept) == masks
    after = manifest.read(damaged)
    assert after.tasks.keys() == before.tasks.keys()
    same = {path for path in before.files if after.files[path].sha256 == before.files[path].sha256}
    assert before.files.keys() - same == {
        *(path for path in before.files if _MASK.match(path)),
        *("bom.csv", "order.csv"),
        *("design.json", "layout.json", "resolved.toml"),
    }
    assert after.origin == manifest.Origin()  # it is no whole build of either design
    whole = json.loads((damaged / "design.json").read_text(encoding="utf-8"))
    assert whole["title"]["name"] != "Lumitip published"
    whole_again = build(design_dir / "presets" / "published.toml", damaged)
    assert set(whole_again.made) == masks | {"bom"}
    assert manifest.read(damaged) == before


def test_a_step_that_is_not_there_is_named_with_those_that_are(
    design_dir: Path, tmp_path: Path
) -> None:
    with pytest.raises(
        OutputError, match=r"no step is called colour; the steps are mask, creasing"
    ):
        build(design_dir / "fingertip.toml", tmp_path / "out", only=["mask", "colour"])
    assert not (tmp_path / "out").exists()
