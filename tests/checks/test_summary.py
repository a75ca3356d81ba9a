"""The end of a run: comparable margins, parameters to change, price, about ten lines."""

import io
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from lumitip_fab.checks.result import Measurement, relative_margin, unreadable
from lumitip_fab.checks.run import MODULES, Outcome, run_checks
from lumitip_fab.cli.summary import (
    TABLES,
    parameters_of,
    print_summary,
    tightest,
)
from lumitip_fab.config.load import load
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text
from lumitip_fab.text import table_of

pytestmark = pytest.mark.slow

WEB = Measurement("mask.web", "a.pdf", 0.5, 0.4, math.inf, "mm")
DRAFT = Measurement("mould.draft", "m.stl", 3.0, 2.0, 4.0, "°")
SHIFT = Measurement("mask.position", "a.pdf", 0.01, 0, 0.02, "mm")
COUNT = Measurement("mask.count", "a.pdf", 32, 32, 32)
TRACK = Measurement("board.track_width", "b.kicad_pcb", 0.2, 0.2, math.inf, "mm")
THIN = Measurement("mask.web", "d.pdf", 0.1, 0.4, math.inf, "mm", note="between two apertures")
LOST = unreadable("layout.hash", "layout.json", "no such file")


def lines_of(out: Path, *measurements: Measurement, width: int = 120) -> list[str]:
    file = io.StringIO()
    print_summary(Outcome(measurements), out, out / "checks.json", Console(file=file, width=width))
    return file.getvalue().splitlines()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An output folder with a bill and a manual, and a hidden file."""
    (tmp_path / "manual").mkdir()
    (tmp_path / "manual" / "manual.html").write_text("<p>")
    (tmp_path / ".checked.json").write_text("{}")
    (tmp_path / "bom.csv").write_text(
        "group,item,manufacturer,part,for,quantity,unit,unit_price,price\n"
        "electronics,LED,W,1,32 on emitter,32,piece,0.3,9.60\n"
        'total,,,,"EUR, 2026-11, assumed: no offer was asked for",,,,83.71\n'
    )
    (tmp_path / "order.csv").write_text(
        "item,manufacturer,part,needed,unit,pack,confidence,packs,pack_price,price\n"
        "to buy for one pair of fingers,,,,,,,,,455.02\n"
    )
    return tmp_path


@pytest.mark.parametrize(
    ("measurement", "share"),
    [
        (WEB, 0.25),  # 0.1 mm of 0.4 mm
        (DRAFT, 1.0),  # in the middle
        (SHIFT, 0.5),
        (THIN, -0.75),
        (Measurement("a.b", "f", 90, -math.inf, 100), 0.1),
        (COUNT, None),
        (LOST, None),
        (Measurement("a.b", "f", 1, 0, math.inf), None),
        (Measurement("a.b", "f", 1), None),
    ],
)
def test_margins_of_different_units_have_one_scale(
    measurement: Measurement, share: float | None
) -> None:
    found = relative_margin(measurement)
    assert found == (None if share is None else pytest.approx(share))


def test_the_tightest_of_each_check_without_what_is_drawn_at_its_limit() -> None:
    looser = Measurement("mask.web", "b.pdf", 0.9, 0.4, math.inf, "mm")
    found = tightest([looser, DRAFT, SHIFT, COUNT, TRACK, WEB, THIN, LOST], 2)
    assert [m for _, m in found] == [WEB, SHIFT]


def test_a_run_without_failures_ends_in_few_lines(folder: Path) -> None:
    lines = lines_of(folder, WEB, DRAFT, SHIFT, COUNT, TRACK)
    assert lines[0].endswith(": 3 files in 2 folders, 0.0 MB")
    assert lines[1] == "5 checks passed"
    assert [line.split()[:3] for line in lines[3:6]] == [
        ["25.0", "%", "mask.web"],
        ["50.0", "%", "mask.position"],
        ["100.0", "%", "mould.draft"],
    ]
    assert "83.71 EUR (2026-11, assumed), 455.02 EUR in whole packs" in lines[6]
    assert "manual.html" in lines[7]
    assert "checks.json" in lines[7]
    assert len(lines) == 8


@pytest.mark.parametrize(
    ("closes_n", "text"),
    [
        (235.0, "an estimate; the gripper closes with up to 235 N: limit it"),
        (20.0, "an estimate"),
        (0.0, "an estimate; the gripper's force is not known: limit it"),
    ],
)
def test_the_end_names_what_the_fingers_bear(
    folder: Path, design_dir: Path, closes_n: float, text: str
) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    strength = replace(design.strength, gripper_n=closes_n)
    file = folder / "design.json"
    file.write_text(design_text(replace(design, strength=strength)), encoding="utf-8")
    assert f"rated force: 40 N at each tip, {text}" in lines_of(folder, WEB)


def test_what_rounding_puts_beyond_its_limit_has_no_margin(folder: Path) -> None:
    lines = lines_of(folder, replace(WEB, measured=0.4 - 1e-12))
    assert next(line for line in lines if "mask.web" in line).split()[0] == "0.0"


def test_a_failure_names_the_parameter_to_change(folder: Path) -> None:
    lines = lines_of(folder, WEB, THIN, DRAFT)
    at = lines.index("  FAIL  mask.web  0.1 mm, ≥ 0.4  d.pdf")
    assert lines[1] == "1 checks passed, 1 FAILED"
    assert lines[at + 1].strip() == "between two apertures"
    assert lines[at + 2].strip() == "change mask.hole_mm or grid.pitch_mm"
    assert not any("fault of Lumitip" in line for line in lines)


def test_a_failure_without_a_parameter_says_so(folder: Path) -> None:
    lines = lines_of(folder, WEB, LOST)
    assert any("no parameter named" in line for line in lines)
    assert any("no such file" in line for line in lines)


def test_many_failures_stay_short(folder: Path) -> None:
    failed = [Measurement(f"mask.no{i}", "a.pdf", 1, 2, 3) for i in range(30)]
    lines = lines_of(folder, *failed)
    assert sum("FAIL  " in line for line in lines) == 10
    assert "  and 20 more checks: check --verbose" in lines


def test_lines_stay_within_a_terminal(folder: Path) -> None:
    long = Measurement("mask.web", "folder/" * 30, 0.5, 0.4, math.inf, "mm")
    (line,) = (line for line in lines_of(folder, long, width=80) if "mask.web" in line)
    assert len(line) == 80
    assert line.endswith("…")


@pytest.mark.parametrize("name", ["bom.csv", "order.csv"])
@pytest.mark.parametrize("text", ["torn", "", "item,price\ntotal,\n"])
def test_without_a_total_there_is_no_price(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(text)
    assert any(f"{folder / name} has no total" in line for line in lines_of(folder, WEB))


def test_every_parameter_that_is_named_exists() -> None:
    tables = Parameters.model_fields
    for fields in table_of(TABLES)["parameters"].values():
        for table, _, field in (name.partition(".") for name in fields):
            assert field in tables[table].annotation.model_fields, f"{table}.{field}"  # type: ignore[union-attr]


def test_every_check_that_is_named_exists(
    outputs: Path, built: Callable[[str], Path], panelled: Path
) -> None:
    known = run_checks(outputs, MODULES).names | run_checks(built("asymmetric"), MODULES).names
    known |= run_checks(panelled, ["panels"]).names
    assert {*table_of(TABLES)["parameters"], *table_of(TABLES)["drawn_at_the_limit"]} <= known
    assert parameters_of("no.such_check") == ()
