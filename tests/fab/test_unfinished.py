"""Builds that were interrupted: what they left is cleared away, and old reports do not stay."""

from pathlib import Path

import pytest

from lumitip_fab.design import Design
from lumitip_fab.pipeline import build as builds
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.pipeline.build import Report, build
from lumitip_fab.pipeline.workers import Step

BROKEN = (Step("broken", "docs.gone.away"),)
OLD_PAGE = "<p>950 checks pass</p>"


@pytest.fixture
def made(designs: dict[str, Design], tmp_path: Path) -> "Made":
    """`made({"a.txt": "one"})`: a build that writes such files into one folder."""
    return Made(designs["published"], tmp_path / "out")


class Made:
    """Builds of files that stand in for a design's."""

    def __init__(self, design: Design, out: Path) -> None:
        self.out, self._design = out, design

    def __call__(self, texts: dict[str, str], steps: tuple[Step, ...] = ()) -> Report:
        files = tuple(Artefact(path, text.encode()) for path, text in texts.items())
        return build(repr(texts), lambda: (self._design, files), self.out, steps)

    def names(self) -> set[str]:
        """Files that are no marks of the build itself."""
        there = {p.relative_to(self.out).as_posix() for p in self.out.rglob("*") if p.is_file()}
        return there - {manifest.NAME, ".built"}


def interrupted(made: Made, texts: dict[str, str]) -> None:
    with pytest.raises(ImportError):
        made(texts, BROKEN)


def test_what_an_interrupted_build_left_is_removed(made: Made) -> None:
    made({"a.txt": "one"})
    interrupted(made, {"a.txt": "one", "b.txt": "two", "board/order.zip": "three"})
    assert made.names() == {"a.txt", "b.txt", "board/order.zip"}
    report = made({"a.txt": "one"})
    assert made.names() == {"a.txt"}
    assert report.removed == ("b.txt", "board/order.zip")


def test_a_file_of_the_user_stays(made: Made) -> None:
    made({"a.txt": "one"})
    (made.out / "notes.txt").write_text("mine")
    interrupted(made, {"a.txt": "one", "b.txt": "two"})
    made({"a.txt": "one"})
    assert made.names() == {"a.txt", "notes.txt"}


def test_a_file_that_an_interrupted_build_changed_is_made_again(made: Made) -> None:
    made({"a.txt": "one"})
    interrupted(made, {"a.txt": "two"})
    assert made({"a.txt": "one"}).written == ("a.txt",)
    assert (made.out / "a.txt").read_text() == "one"
    assert made({"a.txt": "one"}).written == ()


@pytest.mark.parametrize("ends", [True, False], ids=["to its end", "interrupted"])
def test_a_build_that_changes_a_file_voids_page_and_results(made: Made, ends: bool) -> None:
    made({"a.txt": "one"})
    reports = {made.out / name: text for name, text in zip(manifest.REPORTS, "1234", strict=True)}
    for path, text in reports.items():
        path.write_text(text)
    (made.out / manifest.PAGE).write_text(OLD_PAGE)
    made({"a.txt": "one"})
    assert (made.out / manifest.PAGE).read_text() == OLD_PAGE, "nothing has changed"
    if ends:
        made({"a.txt": "two"})
    else:
        interrupted(made, {"a.txt": "two"})
    page = (made.out / manifest.PAGE).read_text()
    assert "checks pass" not in page and "make outputs" in page
    assert not any((made.out / name).exists() for name in manifest.RESULTS)
    assert (made.out / manifest.STAMP).exists(), "an open page waits for the next one"


def test_a_folder_without_a_page_gets_none(made: Made) -> None:
    made({"a.txt": "one"})
    made({"a.txt": "two"})
    assert made.names() == {"a.txt"}


def test_files_of_another_program_stay(made: Made) -> None:
    made.out.mkdir()
    mine = {name: made.out / name for name in ("index.html", "checks.json", "checks.xml")}
    for path in mine.values():
        path.write_text("mine")
    made({"a.txt": "one"})
    assert all(path.read_text() == "mine" for path in mine.values())


def test_the_lock_is_there_while_marks_are_written(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two builds at a time would remove each other's files."""
    held = []
    real = manifest.write

    def write(out: Path, record: manifest.Manifest) -> None:
        with pytest.raises(builds.OutputError, match="another build"), builds.locked(out):
            pass
        held.append(out)
        real(out, record)

    monkeypatch.setattr(manifest, "write", write)
    made({"a.txt": "one"})
    assert held
