"""Which change makes which task run again."""

import ast
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli.steps import STEPS
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.pipeline import fingerprint as toolchain
from lumitip_fab.pipeline.artefact import Made
from lumitip_fab.pipeline.graph import EACH, argument_names, late_steps, late_task, tasks

PACKAGE = toolchain.PACKAGE
EARLY = {step.name for step in STEPS if not step.reads}
Keys = Callable[..., dict[str, str]]


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the package's code, which `toolchain` takes for the package."""
    copied = tmp_path / "package"
    shutil.copytree(PACKAGE, copied, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(toolchain, "PACKAGE", copied)
    return copied


@pytest.fixture
def keys(design_dir: Path, tmp_path: Path) -> Keys:
    """Key of every task of the published design with some lines added."""

    def of(text: str = "") -> dict[str, str]:
        file = tmp_path / "presets" / "changed.toml"
        file.parent.mkdir(exist_ok=True)
        published = design_dir / "presets" / "published.toml"
        (file.parent / "published.toml").write_bytes(published.read_bytes())
        (tmp_path / "parts").mkdir(exist_ok=True)
        file.write_text('extends = "published.toml"\n' + text)
        return {task.name: task.key for task in tasks(STEPS, derive(load(file)))}

    return of


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    assert before.keys() == after.keys()
    return {name.partition(".")[0] for name in before if before[name] != after[name]}


def test_controller_name_touches_the_firmware_alone(keys: Keys) -> None:
    assert changed(keys(), keys('[controller]\nname = "Other"\n')) == {"firmware_files"}


def test_mask_hole_touches_the_mask_and_what_reads_the_layout(keys: Keys) -> None:
    assert changed(keys(), keys("[mask]\nhole_mm = 2.0\n")) == {"mask_files", "firmware_files"}


def test_waste_of_silicone_touches_the_mould_and_what_shares_its_figures(keys: Keys) -> None:
    assert "backing" not in changed(keys(), keys("[mould]\nwaste_fraction = 0.5\n"))


def test_pitch_touches_everything_of_the_fingers(keys: Keys) -> None:
    # What the slicer is told, what holds the controller, and wires know nothing of the cells.
    outside = {
        "holder_files",
        "flange_files",
        "print_settings",
        "supply_simulation",
        "wiring_files",
    }
    assert changed(keys(), keys("[grid]\npitch_mm = 6.1\n")) == EARLY - outside


def test_what_is_outside_touches_no_finger(keys: Keys) -> None:
    after = keys("[breakout]\nhole_spacing_mm = 34.0\n")
    assert changed(keys(), after) == {"carrier_files", "holder_files"}
    assert changed(keys(), keys("[holder]\nbody_mm = 76.0\n")) == {"holder_files"}


def test_lengths_of_wires_touch_the_wiring_alone(keys: Keys) -> None:
    assert changed(keys(), keys("[wiring]\nslack_mm = 60.0\n")) == {"wiring_files"}


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
    `derive` imports: that reaches a generator as its arguments."""
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


def test_whatever_a_generator_imports_makes_it_run_again(package: Path) -> None:
    steps = {step.room: set[Path]() for step in STEPS}
    for step in STEPS:
        steps[step.room] |= imported(PACKAGE / step.room / f"{step.module}.py")
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


def test_every_step_names_real_arguments(keys: Keys, design_dir: Path) -> None:
    assert all(argument_names(step) for step in STEPS)
    design = derive(load(design_dir / "presets" / "published.toml"))
    runs = 0
    for step in (step for step in STEPS if not step.reads):
        each = next((name for name in argument_names(step) if name in EACH), None)
        runs += len(getattr(design, EACH[each])) if each else 1
    assert len(keys()) == runs


def test_what_reads_others_files_runs_again_when_those_change(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))

    def late(files: dict[str, str]) -> dict[str, str]:
        made = Made(Path(), files)
        return {step.name: late_task(step, design, made).key for step in late_steps(STEPS)}

    before = late({"backing/emitter_backing.stl": "1", "mask/emitter_mask.svg": "1"})
    assert "bill_of_materials" in before
    other = late({"backing/emitter_backing.stl": "2", "mask/emitter_mask.svg": "1"})
    assert changed(before, other) >= {"bill_of_materials"}
    unread = late({"backing/emitter_backing.stl": "1", "mask/emitter_mask.svg": "2"})
    assert before["bill_of_materials"] == unread["bill_of_materials"]


def test_a_step_reads_no_more_than_it_says(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("a", encoding="utf-8")
    made = Made(tmp_path, {"a.txt": "1", "b.csv": "2"}).only(("*.txt",))
    assert made.text("a.txt") == "a"
    with pytest.raises(LookupError, match=r"b.csv: was not made"):
        made.read("b.csv")
