"""Every check is run failing, through every report; a check that stops is a failed check."""

import io
import json
import math
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NoReturn
from xml.etree import ElementTree

import numpy as np
import pytest
from rich.console import Console

from damages import box, carve
from lumitip_fab.checks import run
from lumitip_fab.checks.memory import Memory
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import MODULES, Outcome, as_json, run_checks
from lumitip_fab.cli import main, report
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import mount_to_sensor
from pages import page_damage, runs

pytestmark = pytest.mark.slow

MEASURED = set(MODULES) - {"panels", "insert"}
"""The published design has neither panels nor a film in its moulds; theirs are damaged in
test_panels.py and test_insert.py."""
Reports = tuple[Outcome, list[dict[str, Any]], ElementTree.Element]


@pytest.fixture(scope="module")
def measured(outputs: Path) -> tuple[Measurement, ...]:
    """Everything that all checks measure on the published design."""
    return run_checks(outputs).measurements


def beyond(m: Measurement) -> Measurement:
    """The same measurement outside its range, with the figures that numpy makes."""
    if math.isfinite(m.high):
        value = m.high + 1.0
    else:
        value = m.low - 1.0 if math.isfinite(m.low) else math.nan
    return replace(m, measured=np.float64(value), low=np.float64(m.low), high=np.float64(m.high))


def not_measured(m: Measurement) -> Measurement:
    """The same measurement without a figure."""
    return replace(m, measured=np.float32("nan"))


def reject(constant: str) -> NoReturn:
    raise AssertionError(f"{constant} is not JSON")


def strict(text: str) -> Any:
    return json.loads(text, parse_constant=reject)


def printed(show: Callable[[Outcome, Console], None], outcome: Outcome) -> str:
    file = io.StringIO()
    show(outcome, Console(file=file, width=1000, highlight=False))
    return file.getvalue()


@pytest.mark.parametrize("fail", [beyond, not_measured])
def test_every_check_fails_in_every_report(
    measured: tuple[Measurement, ...], fail: Callable[[Measurement], Measurement]
) -> None:
    for m in measured:
        assert m.passed is True
    names = {m.check for m in measured}
    assert {name.partition(".")[0] for name in names} == MEASURED
    outcome = Outcome(tuple(map(fail, measured)))
    assert outcome.failed == outcome.measurements
    told = strict(json.dumps(as_json(outcome), allow_nan=False))
    assert [m["check"] for m in told] == [m.check for m in measured]
    assert all(m["passed"] is False for m in told)
    suite = ElementTree.fromstring(report.junit(outcome))
    assert suite.attrib["failures"] == str(len(suite.findall("testcase/failure")))
    assert {case.attrib["classname"] for case in suite.findall("testcase[failure]")} == names
    for show in (report.print_measurements, report.print_failures):
        lines = printed(show, outcome).splitlines()
        failed = {line.split()[1] for line in lines if line.startswith("FAIL")}
        assert failed == names, "each is named"
        assert not any(line.startswith("ok") for line in lines)


@pytest.mark.parametrize("fail", [beyond, not_measured])
@pytest.mark.parametrize("amount", ["--quiet", "--verbose", "--json", None])
def test_every_check_fails_through_the_command_line_and_the_memory(
    outputs: Path,
    measured: tuple[Measurement, ...],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    fail: Callable[[Measurement], Measurement],
    amount: str | None,
) -> None:
    kept = tmp_path / "memory.json"
    remember(kept, outputs, tuple(map(fail, measured)))
    xml, file = tmp_path / "junit.xml", tmp_path / "report.json"
    options = ["--out", str(outputs), "--memory", str(kept), "--junit", str(xml)]
    options += ["--report", str(file), *([amount] if amount else [])]
    assert main(["check", *options]) == 1
    text = capsys.readouterr().out
    assert len(ElementTree.parse(xml).findall("testcase/failure")) == len(measured)
    report = strict(file.read_text(encoding="utf-8"))
    failed_in_file = {m["check"] for m in report["measurements"] if m["passed"] is False}
    assert failed_in_file == {m.check for m in measured}
    if amount == "--json":
        assert strict(text) == report
    else:
        failed = len(measured if amount else {m.check for m in measured})
        assert f"{failed} FAILED" in text
    strict(kept.read_text(encoding="utf-8"))


def remember(kept: Path, outputs: Path, measurements: tuple[Measurement, ...]) -> None:
    """Write a memory in which every module measured these."""
    design = read_design(outputs / "design.json")
    memory = Memory(kept, outputs)
    for name in MODULES:
        own = tuple(m for m in measurements if m.check.startswith(f"{name}."))
        memory.keep(name, own, design, [])


def aperture_moved(folder: Path) -> None:
    def change(operations: list[Any]) -> list[Any]:
        first, last = list(runs(operations))[10]
        for operands, _ in operations[first:last]:
            operands[0] += 1
        return operations

    page_damage("mask/receiver_mask_a4.pdf", change)(folder)


def floor_thinned(folder: Path) -> None:
    design = read_design(folder / "design.json")
    carve(
        folder / "backing/receiver_backing.stl",
        lambda part: part - box((10, 0, -4.5), (13, 3, -3.8)),
        mount_to_sensor(design.mount, design.stack),
    )


@pytest.mark.parametrize(
    ("damage", "failed"),
    [(aperture_moved, "mask.position"), (floor_thinned, "backing.min_wall")],
)
def test_a_damaged_file_is_reported_everywhere(
    damaged: Path,
    measured: tuple[Measurement, ...],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    damage: Callable[[Path], None],
    failed: str,
) -> None:
    kept, xml = tmp_path / "memory.json", tmp_path / "junit.xml"
    damage(damaged)
    remember(kept, damaged, measured)
    forget(kept, failed.partition(".")[0])
    options = ["check", "--out", str(damaged), "--memory", str(kept), "--junit", str(xml)]
    first, again = (said(options, capsys) for _ in range(2))
    assert first == again
    assert failed in {m["check"] for m in first if m["passed"] is False}
    cases = ElementTree.parse(xml).findall("testcase[failure]")
    assert failed in {case.attrib["classname"] for case in cases}


def forget(kept: Path, module: str) -> None:
    told = json.loads(kept.read_text(encoding="utf-8"))
    del told[module]
    kept.write_text(json.dumps(told), encoding="utf-8")


def said(options: list[str], capsys: pytest.CaptureFixture[str]) -> list[dict[str, Any]]:
    assert main([*options, "--json"]) == 1
    return list(strict(capsys.readouterr().out)["measurements"])


@pytest.mark.parametrize("spoil", [lambda f: f.write_bytes(b""), Path.unlink])
def test_no_module_stops_where_every_file_is_spoilt(
    outputs: Path, tmp_path: Path, spoil: Callable[[Path], Any]
) -> None:
    folder = Path(shutil.copytree(outputs, tmp_path / "spoilt"))
    for file in (f for f in folder.rglob("*") if f.is_file() and f.name != "design.json"):
        spoil(file)
    outcome = run_checks(folder)
    assert {m.check.partition(".")[0] for m in outcome.failed} == MEASURED
    assert not [m for m in outcome.failed if m.check.endswith(f".{run.CRASH}")]
    strict(json.dumps(as_json(outcome), allow_nan=False))
    ElementTree.fromstring(report.junit(outcome))


def test_a_check_that_raises_fails_by_name_and_the_others_run(
    outputs: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def measure(_: Path, design: Design) -> Iterator[Measurement]:
        yield Measurement("mask.first", design.title.name, 1.0, 1.0, 1.0)
        raise ZeroDivisionError("no pages")

    module = run._module
    stopping = SimpleNamespace(measure=measure)
    monkeypatch.setattr(run, "_module", lambda n: stopping if n == "mask" else module(n))
    kept = tmp_path / "memory.json"
    outcome = run_checks(outputs, ["layout", "mask"], Memory(kept, outputs))
    (crash,) = outcome.failed
    assert crash.check == "mask.crash"
    assert "measure" in crash.subject
    assert "ZeroDivisionError: no pages" in crash.note
    assert "mask.first" in outcome.names, "what was measured before counts"
    assert any(name.startswith("layout.") for name in outcome.names)
    assert "ZeroDivisionError" in caplog.text, "with its traceback"
    assert "mask" not in json.loads(kept.read_text()), "it runs again next time"


def test_figures_become_python_floats() -> None:
    m = Measurement("x.y", "file", np.float32(0.5), np.int64(0), np.array(1.0))
    assert [type(v) for v in (m.measured, m.low, m.high, m.margin)] == [float] * 4
    assert m.passed is True
    assert Measurement("x.y", "file", np.True_, 0, 0).passed is False


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (("x.y", "file", "0.5"), TypeError),
        (("x.y", "file", None), TypeError),
        (("x.y", "file", 1j), TypeError),
        (("x.y", "file", np.array([1.0, 2.0])), TypeError),
        (("x.y", Path("file"), 0.5), TypeError),
        (("x.y", "file", 0.5, math.nan), ValueError),
        (("x.y", "file", 0.5, 0, np.nan), ValueError),
    ],
)
def test_a_measurement_that_is_none_is_rejected(values: Any, error: type[Exception]) -> None:
    with pytest.raises(error, match=r"x\.y"):
        Measurement(*values)


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-math.inf, math.inf), (2.0, 2.0)])
def test_nan_fails_in_every_range(low: float, high: float) -> None:
    m = Measurement("x.y", "file", math.nan, low, high)
    assert m.passed is False
    (told,) = strict(json.dumps(as_json(Outcome((m,))), allow_nan=False))
    assert told["measured"] is None and told["passed"] is False


def test_a_note_carries_nothing_that_xml_or_utf_8_cannot() -> None:
    m = Measurement("x.y", "a\udcff.pdf", 1.0, 0.0, 0.0, "mm", "read '\x00\ufffe', 5 °")
    case = ElementTree.fromstring(report.junit(Outcome((m,)))).find("testcase")
    assert case is not None and case.attrib["name"] == r"a\udcff.pdf"
    assert case.findtext("system-out", "").endswith(r"read '\x00\ufffe', 5 °")
