"""The tutorials: their commands run in order, and print what the pages show."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

from markdown_pages import ROOT
from programs import program

TUTORIALS = sorted((ROOT / "docs/tutorials").glob("*.md"))
Step = tuple[str, list[str]]
"""Commands, and what stands on the page that they print."""


def steps(text: str) -> list[Step]:
    """The blocks of commands of a page, each with the lines of output behind it."""
    found: list[Step] = []
    for token in MarkdownIt("commonmark").parse(text):
        if token.type == "fence" and token.info == "sh":
            found.append((token.content, []))
        elif token.type == "fence" and token.info == "text":
            found[-1][1].extend(token.content.splitlines())
    return found


def missing(shown: list[str], printed: str) -> Iterator[str]:
    """Parts of shown lines, between `…`, that were not printed."""
    together = " ".join(printed.split())
    for line in shown:
        for part in line.split("…"):
            if " ".join(part.split()) not in together:
                yield part


def run(commands: str, folder: Path) -> str:
    """What commands print, in a folder that is set up as a user's."""
    packages = os.pathsep.join(str(ROOT / name) for name in ("generators", "readout"))
    environment = os.environ | {"PYTHONPATH": packages, "HOME": str(folder), "COLUMNS": "400"}
    environment.pop("XDG_DATA_HOME", None)  # else a calibration would go into the user's own
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", commands],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{commands}\n{done.stdout}"
    return done.stdout


@pytest.fixture
def user(tmp_path: Path, outputs: Path) -> Path:
    """A user's folder after `make outputs`."""
    for name in ("design", "examples"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copytree(outputs, tmp_path / "outputs")
    # The whole environment: Python looks for its packages beside the folder of its programs.
    (tmp_path / ".venv").symlink_to(sys.prefix)
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda page: page.stem)
def test_the_commands_print_what_the_page_shows(tutorial: Path, user: Path) -> None:
    text = tutorial.read_text("utf-8")
    if "lumitip-fab slice" in text:
        program("prusa-slicer")
    for commands, shown in steps(text):
        printed = run(commands, user)
        assert list(missing(shown, printed)) == [], printed


def test_each_tutorial_says_what_it_needs_and_has_commands() -> None:
    assert len(TUTORIALS) == 8
    for tutorial in TUTORIALS:
        text = tutorial.read_text("utf-8")
        assert "**You need:**" in text
        assert len(steps(text)) >= 2
        assert any(shown for _, shown in steps(text))


def test_a_wrong_output_is_found() -> None:
    assert list(missing(["price: … EUR"], "price:  12.5 EUR\n")) == []
    assert list(missing(["price: … USD"], "price:  12.5 EUR\n")) == [" USD"]
