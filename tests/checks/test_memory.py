"""What was measured before is told again only while everything that it depends on is the same."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks import memory, run
from lumitip_fab.checks.memory import Memory, reads
from lumitip_fab.checks.run import MODULES, run_checks
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.dependencies import RecordedDesign

pytestmark = pytest.mark.slow


@pytest.fixture
def kept(damaged: Path) -> Path:
    """The file in which one run over `damaged` has remembered the layout and the masks."""
    path = damaged / ".checked.json"
    run_checks(damaged, ["layout", "mask"], Memory(path, damaged))
    return path


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the modules that measure, as they do."""
    names: list[str] = []
    module = run._module

    def noted(name: str) -> Any:
        names.append(name)
        return module(name)

    monkeypatch.setattr(run, "_module", noted)
    return names


def test_nothing_is_measured_twice(damaged: Path, kept: Path, measured: list[str]) -> None:
    again = run_checks(damaged, ["layout", "mask"], Memory(kept, damaged))
    assert measured == []
    assert again == run_checks(damaged, ["layout", "mask"])


def test_without_a_memory_every_file_is_read(
    damaged: Path, kept: Path, measured: list[str]
) -> None:
    assert kept.is_file()
    run_checks(damaged, ["layout", "mask"])
    assert measured == ["layout", "mask"]


def test_a_changed_file_is_measured_again_and_no_other(
    damaged: Path, kept: Path, measured: list[str]
) -> None:
    file = damaged / "layout.json"
    file.write_text(file.read_text().replace('"x_mm": [', '"x_mm": [0.5, ', 1))
    outcome = run_checks(damaged, ["layout", "mask"], Memory(kept, damaged))
    assert measured == ["layout"]
    assert {m.check.split(".")[0] for m in outcome.failed} == {"layout"}


@pytest.mark.parametrize(
    ("field", "value", "again"),
    [
        ("controller", {"name": "Other"}, []),
        ("optics", {"film_mm": 0.2}, ["layout"]),
        ("mask", {"holes_mm": [2.4] * 32}, ["layout", "mask"]),
        ("stack", {"film_mm": 0.2}, ["mask"]),
    ],
)
def test_the_design_counts_where_it_was_read(
    damaged: Path,
    kept: Path,
    measured: list[str],
    field: str,
    value: dict[str, Any],
    again: list[str],
) -> None:
    file = damaged / "design.json"
    told = json.loads(file.read_text())
    (told["layout"][field] if field == "optics" else told[field]).update(value)
    file.write_text(json.dumps(told))
    run_checks(damaged, ["layout", "mask"], Memory(kept, damaged))
    assert measured == again


@pytest.mark.parametrize("depends", ["whole_code_hash", "installed_hash"])
def test_other_code_or_tools_measure_again(
    damaged: Path,
    kept: Path,
    measured: list[str],
    monkeypatch: pytest.MonkeyPatch,
    depends: str,
) -> None:
    monkeypatch.setattr(memory, depends, lambda: "another")
    run_checks(damaged, ["layout"], Memory(kept, damaged))
    assert measured == ["layout"]


def _cut(file: Path) -> None:
    file.write_text(file.read_text()[:-9])


def _empty_entry(file: Path) -> None:
    file.write_text(json.dumps({"layout": {"key": 7, "fields": [], "measurements": [{}]}}))


def _unknown_field(file: Path) -> None:
    file.write_text(json.dumps({"layout": {"key": 7, "fields": ["colour"], "measurements": []}}))


@pytest.mark.parametrize("spoil", [Path.unlink, _cut, _empty_entry, _unknown_field])
def test_a_spoilt_memory_remembers_nothing(
    damaged: Path, kept: Path, measured: list[str], spoil: Callable[[Path], Any]
) -> None:
    spoil(kept)
    run_checks(damaged, ["layout"], Memory(kept, damaged))
    assert measured == ["layout"]


def test_a_memory_that_cannot_be_written_is_one_error(damaged: Path, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    kept = Memory(blocked / "memory.json", damaged)
    with pytest.raises(OutputError, match=r"memory\.json: cannot be written"):
        run_checks(damaged, ["layout"], kept)


def test_reports_written_among_the_outputs_do_not_count_as_changes(
    damaged: Path, measured: list[str]
) -> None:
    path, report = damaged / ".checked.json", damaged / "checks.json"
    run_checks(damaged, ["manifest"], Memory(path, damaged, [report]))
    report.write_text("[]")
    run_checks(damaged, ["manifest"], Memory(path, damaged, [report]))
    assert measured == ["manifest"]


def test_what_a_module_reads_is_what_its_source_says() -> None:
    for name in MODULES:
        assert reads(name) == run._module(name).READS


def test_every_check_is_remembered(outputs: Path, tmp_path: Path, measured: list[str]) -> None:
    path = tmp_path / "checked.json"
    first = run_checks(outputs, MODULES, Memory(path, outputs))
    assert sorted(measured) == sorted(MODULES) and not first.failed
    again = run_checks(outputs, MODULES, Memory(path, outputs))
    assert len(measured) == len(MODULES) and again == first


def test_a_check_that_would_read_unnoted_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Design, "thinnest", lambda self: self.stack, raising=False)
    with pytest.raises(TypeError, match=r"Design\.thinnest is a method"):
        _ = RecordedDesign(object.__new__(Design)).thinnest
