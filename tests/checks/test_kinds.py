"""Outputs with a pipe, a device or a folder where a file belongs: found once, never opened."""

import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lumitip_fab.checks.memory import Memory
from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli import check, main
from lumitip_fab.cli.build import build
from lumitip_fab.errors import OutputError

LONGEST_S = 180
NESTED = "[" * 200_000
MADE: dict[str, Callable[[Path], object]] = {
    "pipe": os.mkfifo,
    "zeros without end": lambda path: path.symlink_to("/dev/zero"),
    "folder": Path.mkdir,
}


@pytest.fixture(autouse=True)
def _in_time() -> Iterator[None]:
    """What waits for a pipe is stopped."""
    signal.alarm(LONGEST_S)
    yield
    signal.alarm(0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", MADE)
@pytest.mark.parametrize(
    ("path", "others"),
    [
        ("bom.csv", {"bom.kinds", "packs.kinds"}),
        ("firmware/layout.h", {"firmware.kinds", "wiring.kinds"}),
        ("holder/holder.stl", {"bom.kinds"}),
        ("manual/manual.html", {"heat.kinds"}),
    ],
)
def test_no_module_opens_what_is_no_file(
    damaged: Path, kind: str, path: str, others: set[str]
) -> None:
    (damaged / path).unlink()
    MADE[kind](damaged / path)
    outcome = run_checks(damaged, ["manifest", "bom", "packs", "firmware", "wiring", "heat"])
    assert {m.check for m in outcome.failed} == {"manifest.kinds", "manifest.files"} | others
    assert "manifest.frames" in outcome.names, "what else there is was measured"


@pytest.mark.parametrize("kind", MADE)
@pytest.mark.parametrize("path", ["manifest.json", "layout.json"])
def test_build_refuses_to_write_over_it(
    damaged: Path, design_dir: Path, kind: str, path: str
) -> None:
    (damaged / path).unlink()
    MADE[kind](damaged / path)
    files = {f: f.stat().st_mtime_ns for f in damaged.rglob("*") if f.is_file()}
    with pytest.raises(OutputError, match=f"{path}: is a pipe, device or folder"):
        build(design_dir / "fingertip.toml", damaged)
    assert {f: f.stat().st_mtime_ns for f in damaged.rglob("*") if f.is_file()} == files


@pytest.mark.parametrize("kind", MADE)
@pytest.mark.parametrize("path", ["design.json", "manifest.json", "bom.csv"])
def test_the_command_ends(
    damaged: Path, kind: str, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(check, "MODULES", ("manifest", "layout", "packs"))
    (damaged / path).unlink()
    MADE[kind](damaged / path)
    assert main(["check", "--out", str(damaged)]) in (1, 2)


def test_a_pipe_more_is_seen_whatever_is_remembered(damaged: Path, tmp_path: Path) -> None:
    path = tmp_path / "memory.json"
    assert not run_checks(damaged, ["manifest"], Memory(path, damaged)).failed
    os.mkfifo(damaged / "firmware/more.h")
    outcome = run_checks(damaged, ["manifest"], Memory(path, damaged))
    assert {m.check for m in outcome.failed} == {"manifest.kinds", "manifest.strays"}


def test_lists_in_lists(damaged: Path, tmp_path: Path) -> None:
    (damaged / "manifest.json").write_text(NESTED)
    (tmp_path / "memory.json").write_text(NESTED)
    outcome = run_checks(damaged, ["manifest"], Memory(tmp_path / "memory.json", damaged))
    assert {m.check for m in outcome.failed} == {"manifest.files", "manifest.frames"}


def test_build_over_lists_in_lists(tmp_path: Path, design_dir: Path) -> None:
    (tmp_path / "manifest.json").write_text(NESTED)
    report = build(design_dir / "fingertip.toml", tmp_path, only=["firmware"])
    assert "firmware/layout.h" in report.written


@pytest.mark.parametrize("kind", MADE)
def test_a_memory_that_is_no_file_remembers_nothing(
    outputs: Path, tmp_path: Path, kind: str
) -> None:
    MADE[kind](tmp_path / "memory.json")
    assert Memory(tmp_path / "memory.json", outputs)._known == {}
