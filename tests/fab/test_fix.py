"""`fix` changes the values that it must, and nothing else of a file."""

import json
import stat
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.fix import changed_text, fix
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.remedies import Plan, Remedy, Step
from lumitip_fab.errors import OutputError

pytestmark = pytest.mark.slow

WIDE = "[mask]\nhole_mm = 5.8   # too wide\n"


def _fixed(path: Path, data: bytes) -> bytes:
    path.write_bytes(data)
    assert fix(path)[0].complete
    derive(load(path))
    return path.read_bytes()


@pytest.mark.parametrize(
    "text",
    [
        "# mine é\r\n[mask]\r\nhole_mm = 5.8   # too wide\r\n\r\n",
        "\ufeff[mask]\nhole_mm = 5.8\n",
        "mask = { hole_mm = 5.8 }  # in one line\n",
        "mask.hole_mm = 5.8  # dotted",
        "mask.hole_mm = 5.8\ngrid.pitch_mm = 6.0\nmask.film = 'TPU 100um'\n",
        "[ mask ]\n\t'hole_mm'  =  5.8",
    ],
)
def test_every_other_byte_stays(file: Any, text: str) -> None:
    ends = "\r\n" if "\r\n" in text else "\n"
    mark = "\ufeff" if text.startswith("\ufeff") else ""
    whole = mark + 'extends = "presets/published.toml"' + ends + text.removeprefix(mark)
    assert _fixed(file(""), whole.encode()) == whole.replace("5.8", "5.6").encode()


def test_a_table_that_is_added_ends_its_lines_like_the_file() -> None:
    plan = Plan((Step("", (Remedy("mask.hole_mm", 5.6, 5.8),)),), True)
    assert changed_text('name = "A"\r\n', plan) == 'name = "A"\r\n\r\n[mask]\r\nhole_mm = 5.6\r\n'
    mixed = 'name = "A"\r\nrevision = "B"\n[mask]\nhole_mm = 5.8\n'
    assert changed_text(mixed, plan) == mixed.replace("5.8", "5.6")


def test_a_link_stays_and_the_file_to_which_it_leads_is_changed(file: Any) -> None:
    path = file(WIDE)
    real = path.with_name("real.toml")
    path.rename(real)
    path.symlink_to(real.name)
    assert fix(path)[0].complete
    assert path.is_symlink()
    assert "hole_mm = 5.6   # too wide" in real.read_text(encoding="utf-8")


def test_permissions_stay(file: Any) -> None:
    path = file(WIDE)
    path.chmod(0o600)
    assert fix(path)[0].complete
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_read_only_file_is_left_as_it_is(file: Any) -> None:
    path = file(WIDE)
    path.chmod(0o444)
    before = path.read_bytes()
    with pytest.raises(OutputError, match="read-only"):
        fix(path)
    assert path.read_bytes() == before


@pytest.mark.parametrize("option", ["", "--json", "--quiet"])
def test_faults_and_partial_changes_are_named_when_it_gives_up(
    option: str, file: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = file(WIDE)
    before = path.read_bytes()
    part = Plan((Step("too wide", (Remedy("mask.hole_mm", 5.5, 5.8),)),), False)
    monkeypatch.setattr("lumitip_fab.cli.fix.plan_of", lambda _: part)
    assert main(["fix", str(path), *([option] if option else [])]) == 2
    written = capsys.readouterr()
    assert "not changed; no small changes were found" in written.err
    assert "mine.toml:3: mask.hole_mm is 5.8" in written.err
    assert "  mask.hole_mm = 5.5 (now 5.8)" in written.err
    assert "These do not mend every fault: the others need another design." in written.err
    assert path.read_bytes() == before
    if option == "--json":
        record = json.loads(written.out)
        assert not record["written"]
        assert [problem["field"] for problem in record["problems"]] == ["mask.hole_mm"]
