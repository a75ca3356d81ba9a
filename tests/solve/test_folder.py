"""Folder of a study: what is replaced or removed, what stays, and what is refused."""

import hashlib
import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from goals_file import PUBLISHED, write_goals
from lumitip_fab import derived
from lumitip_fab.cli import main
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.solve import files
from lumitip_fab.solve.folder import STUDY, outdated, require_own
from lumitip_fab.solve.goals import Task, read_goals
from lumitip_fab.solve.judge import Reference
from lumitip_fab.solve.judged import Judged
from lumitip_fab.solve.search import Search
from lumitip_fab.solve.study import Options, Point, Study

GOALS = """\
[goals]
edge_mm = 0.2
[vary]
mask.hole_mm = [2.4, 2.5, 2.6]
"""


def _study(task: Task, points: int) -> Study:
    """A study with so many points, as if they had been found."""
    found = [Judged((("mask.hole_mm", 2.4 + 0.1 * n),), (), {}, (), 0.0) for n in range(points)]
    errors = {"edge_mm": 0.1, "gross_percent": 0.0}
    made = [
        Point(f"point-{n}", one, errors, (), SimpleNamespace())  # type: ignore[arg-type]
        for n, one in enumerate(found, 1)
    ]
    base = Point("base", found[0], errors, (), SimpleNamespace())  # type: ignore[arg-type]
    search = Search(found[0], tuple(found), True, 0, Reference(1.0, False))
    return Study(task, Options(), search, (base, *made))


@pytest.fixture(autouse=True)
def _without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "_drawn", lambda _: {})


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "out"


@pytest.fixture
def task(tmp_path: Path) -> Task:
    return read_goals(write_goals(tmp_path, GOALS))


def test_a_study_removes_points_that_it_wrote_and_no_other(task: Task, out: Path) -> None:
    files.write(_study(task, 3), out)
    mine = out / "point-mine.toml"
    shutil.copy(out / "point-1.toml", mine)
    files.write(_study(task, 2), out)
    assert {f.name for f in out.glob("point-*")} == {"point-1.toml", "point-2.toml", mine.name}
    record = json.loads((out / STUDY).read_text())["files"]
    assert record == {
        name: hashlib.sha256((out / name).read_bytes()).hexdigest()
        for name in ("point-1.toml", "point-2.toml")
    }


@pytest.mark.parametrize("forgotten", [False, True])
def test_an_edited_point_is_refused_before_the_search(
    forgotten: bool,
    task: Task,
    out: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("lumitip_fab.cli.design.study", None)
    files.write(_study(task, 2), out)
    edited = out / "point-2.toml"
    edited.write_text(edited.read_text() + "# mine\n")
    if forgotten:
        (out / STUDY).unlink()
    kept = edited.read_bytes()
    assert main(["design", str(out.parent / "goals.toml"), "--out", str(out)]) == 2
    text = capsys.readouterr().err
    assert f"{edited}: is not as lumitip-fab design wrote it last" in text
    assert "Move it to another folder or name to keep it" in text
    assert ("point-1.toml" in text) is forgotten
    with pytest.raises(OutputError, match=r"point-2\.toml: is not as"):
        files.write(_study(task, 1), out)
    assert edited.read_bytes() == kept


def test_a_figure_that_cannot_be_written_is_one_error(task: Task, out: Path) -> None:
    (out / "front.csv").mkdir(parents=True)
    with pytest.raises(OutputError, match=r"front\.csv: cannot be written: "):
        files.write(_study(task, 1), out)


def _with_parts(folder: Path) -> Task:
    """A task whose base has a catalogue of its own."""
    (folder / "own/parts").mkdir(parents=True)
    shutil.copy(PUBLISHED, folder / "own/base.toml")
    shutil.copy(PUBLISHED.parents[1] / "parts/fasteners.toml", folder / "own/parts")
    file = write_goals(folder / "own", GOALS)
    file.write_text(file.read_text().replace(PUBLISHED.as_posix(), "base.toml"))
    return read_goals(file)


def test_parts_of_an_earlier_base_are_removed(task: Task, out: Path, tmp_path: Path) -> None:
    files.write(_study(_with_parts(tmp_path), 1), out)
    assert (out / "parts/fasteners.toml").exists()
    files.write(_study(task, 1), out)
    assert not list(out.glob("parts/*"))


def test_parts_that_no_study_wrote_are_refused(task: Task, out: Path) -> None:
    (out / "parts").mkdir(parents=True)
    (out / "parts/leds.toml").write_text("")
    with pytest.raises(OutputError, match=r"leds\.toml: is no file of the base's catalogue"):
        require_own(out, files.catalogue(task.base))


def test_a_study_in_the_folder_of_its_base_leaves_the_catalogue_there(tmp_path: Path) -> None:
    own = _with_parts(tmp_path)
    for _ in range(2):
        files.write(_study(own, 1), tmp_path / "own")
        with (tmp_path / "own/parts/fasteners.toml").open("a") as parts:
            parts.write("# mine\n")
    text = (tmp_path / "own/parts/fasteners.toml").read_text()
    assert text.count("# mine") == 2


@pytest.mark.slow
def test_folders_that_were_built_of_another_design_are_named(task: Task, out: Path) -> None:
    files.write(_study(task, 2), out)
    (out / "point-9").mkdir()
    for name in ("point-1", "point-2", "point-3"):
        origin = manifest.Origin("", derived(out / "point-1.toml").parameters_hash)
        entry = manifest.Entry("", 0, "", "", [], {})
        (out / name).mkdir()
        manifest.write(out / name, manifest.Manifest({"a.txt": entry}, {}, origin))
    assert [folder.name for folder in outdated(out)] == ["point-2", "point-3"]
