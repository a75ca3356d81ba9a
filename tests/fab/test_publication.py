"""The table of the publication: every row has a command, and each is understood."""

import re
import shlex
from pathlib import Path

import pytest

from lumitip import Fingertip
from lumitip import cli as readout
from lumitip_fab import cli as fab
from lumitip_fab.config.load import load

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/publication.md"


def _commands() -> list[str]:
    lines = PAGE.read_text(encoding="utf-8").partition("\n## ")[0].splitlines()
    rows = [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")][1:]
    return [" | ".join(row[2:]).strip("`") for row in rows]


@pytest.mark.parametrize("command", _commands())
def test_the_command_of_a_row_is_understood(command: str) -> None:
    program, *arguments = shlex.split(command)
    if program == "lumitip-fab":
        options = vars(fab.command_parser().parse_args(arguments))
        if options["command"] != "channel-map":  # of a file that a build writes
            load(ROOT / options.get("file", "design/fingertip.toml"))
    elif program == "lumitip":
        readout.command_parser().parse_args(arguments)
    elif program == "python":
        assert (ROOT / arguments[0]).is_file()
    else:
        assert program == "make"
        target, *given = arguments
        assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)
        design = dict(pair.split("=") for pair in given).get("DESIGN")
        load(ROOT / (design or "design/fingertip.toml"))
    for url in re.findall(r"twin://[^\s\"]+", command):
        with Fingertip.open(url) as tip:
            assert tip.read(5.0).values.size == len(tip.layout)


def test_no_row_goes_without_a_command() -> None:
    assert len(_commands()) >= 14
    assert all(_commands())
