"""A file that is no file, or holds what no engineer would write, is refused in words: exit code 2,
each fault with its place, no traceback, nothing written, and no waiting for a pipe or device."""

import os
import re
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.errors import Problem

ROOT = Path(__file__).parents[2]
LONGEST_S = 60
PLACES = ("mine.toml", "presets/published.toml", "parts/leds.toml", "parts/prices.toml")
"""Parameter file, its base, and two files of the catalogue."""


def _loop(path: Path) -> None:
    path.symlink_to(path.name)


def _two_links(path: Path) -> None:
    path.symlink_to("other.toml")
    path.with_name("other.toml").symlink_to(path.name)


def _endless(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(3_000_000_000)  # takes no room


MADE: dict[str, Callable[[Path], object]] = {
    "link to itself": _loop,
    "two links in a circle": _two_links,
    "link to nothing": lambda path: path.symlink_to("gone.toml"),
    "pipe": os.mkfifo,
    "zeros without end": lambda path: path.symlink_to("/dev/zero"),
    "random bytes without end": lambda path: path.symlink_to("/dev/urandom"),
    "empty device": lambda path: path.symlink_to("/dev/null"),
    "folder": Path.mkdir,
    "3 GB": _endless,
}
WRITTEN: dict[str, bytes] = {
    "binary": bytes(range(256)) * 40,
    "UTF-16": "[grid]\n".encode("utf-16"),
    "Latin-1": "# Größe\n[grid]\n".encode("latin-1"),
    "zero bytes": bytes(100),
    "lists in lists": b"a = " + b"[" * 5000 + b"]" * 5000,
    "tables in tables": b"a = " + b"{b=" * 5000 + b"1" + b"}" * 5000,
    "long number": b"a = " + b"9" * 5000,
    "long text": b'a = "' + b"x" * 190_000 + b'"',
    "JSON": b'{"grid": 1}',
    "many keys": b"".join(b"k%d = 1\n" % number for number in range(2000)),
}
VALUES = ("nan", "-nan", "inf", "-inf", "-1.0", '"0.1"', "true", "[]", "{}", "1e400", "1979-05-27")
NAMES = (
    r'"a\nb"',
    "'..'",
    "'../x'",
    r'"a\"b"',
    '"it\'s"',
    "''",
    "' '",
    r'"\u0000"',
    f'"{"n" * 300}"',
    '"\u202eabc"',  # turns the direction of writing
    '"<b>"',
    "'`x`'",
    '"a__b"',
    '"%s"',
    '"{0}"',
)


class LateError(BaseException):
    """No `OSError`, which would be reported as a file that cannot be read."""


@pytest.fixture
def design(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the design folder with a user's file, in the working folder; a test that waits for
    ever is ended."""
    shutil.copytree(ROOT / "design", tmp_path / "design")
    mine = tmp_path / "design" / "mine.toml"
    mine.write_text('extends = "presets/published.toml"\n[grid]\npitch_mm = 6.2\n')
    monkeypatch.chdir(tmp_path)

    def late(*_: object) -> None:
        raise LateError(f"not refused in {LONGEST_S} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(LONGEST_S)
    yield tmp_path / "design"
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def _refused(design: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """Everything that `build` prints about the user's file, which it must refuse."""
    before = sorted(design.parent.rglob("*"))
    code = main(["build", "design/mine.toml", "--out", "out"])
    printed = capsys.readouterr()
    assert code == 2
    assert sorted(design.parent.rglob("*")) == before
    text = printed.out + printed.err
    assert "Traceback" not in text
    assert all(c.isprintable() or c == "\n" for c in text), "a terminal would act on it"
    assert text.strip()
    return text


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kind", MADE)
def test_what_is_no_plain_file_is_refused(
    place: str, kind: str, design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (design / place).unlink()
    MADE[kind](design / place)
    assert Path(place).name in _refused(design, capsys)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kind", WRITTEN)
def test_what_is_no_parameter_or_catalogue_file_is_refused(
    place: str, kind: str, design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (design / place).write_bytes(WRITTEN[kind])
    assert re.search(rf"{Path(place).name}(:\d+)?: ", _refused(design, capsys))


@pytest.mark.parametrize("make", [Path.touch, _loop], ids=["file", "link to itself"])
def test_what_stands_in_the_place_of_the_catalogue_is_refused(
    make: Callable[[Path], object], design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(design / "parts")
    make(design / "parts")
    assert "design/parts: is no folder" in _refused(design, capsys)


def test_a_broken_catalogue_above_the_file_is_refused(
    design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(design / "parts")
    _loop(design / "parts")
    assert main(["build", "design/presets/published.toml", "--out", "out"]) == 2
    assert "design/parts: is no folder" in capsys.readouterr().err


def test_a_base_that_is_a_pipe_is_named(design: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(design / "base.toml")
    (design / "mine.toml").write_text('extends = "base.toml"\n')
    assert "extends is 'base.toml', which is a pipe or device" in _refused(design, capsys)


def test_wide_spaces_are_shown_as_they_are() -> None:
    spaces = "a\u00a0b\u3000c"
    assert str(Problem("f.toml", 1, "grid", f"{spaces}\x1b")) == f"f.toml:1: grid: {spaces}\\x1b"


def test_an_empty_catalogue_names_what_it_lacks(
    design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (design / "parts" / "leds.toml").write_text("")
    text = _refused(design, capsys)
    assert "which does not exist" in text
    assert "Names in parts/leds.toml: none" in text


@pytest.mark.parametrize("value", VALUES)
def test_a_price_that_is_none_is_refused_on_its_line(
    value: str, design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = design / "parts" / "prices.toml"
    lines = file.read_text(encoding="utf-8").split("\n")
    at = next(k for k, line in enumerate(lines) if line.startswith("H5VUD5U = "))
    lines[at] = f"H5VUD5U = {value}"
    file.write_text("\n".join(lines), encoding="utf-8")
    assert f"prices.toml:{at + 1}: " in _refused(design, capsys)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_no_part_may_have_is_refused_on_its_line(
    name: str, design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = design / "parts" / "leds.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(f"{text}\n[{name}]\nsource = 1\n", encoding="utf-8")
    line = text.count("\n") + 2
    assert re.search(rf"leds\.toml:({line}|{line + 1}|1): ", _refused(design, capsys))


@pytest.mark.parametrize("written", ["extends = {}", "[emitter]\nled = {}", "[grid]\n{} = 1"])
@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_nothing_has_is_refused(
    written: str, name: str, design: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    base = "" if written.startswith("extends") else 'extends = "presets/published.toml"\n'
    text = base + written.replace("{}", name) + "\n"
    (design / "mine.toml").write_text(text, encoding="utf-8")
    assert re.search(r"mine\.toml:\d+: ", _refused(design, capsys))
