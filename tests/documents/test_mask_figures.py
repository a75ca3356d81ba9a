"""The table of the three routes to a mask in docs/making.md has what its command prints."""

import csv
import re
import shlex
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from markdown_pages import ROOT

pytestmark = pytest.mark.slow
PAGE = ROOT / "docs" / "making.md"
_ROW = re.compile(
    r"^\| ([^|]*?), [\d.]+ mm \| ([\d.]+) mm, ([\d.]+)° \| ([\d.]+) mm \|$", re.MULTILINE
)
ROWS = {
    "film": {"mask.route": "film"},
    "sheet of one layer": {"mask.route": "tpu", "mask.layers": "1"},
    "sheet of two layers": {"mask.route": "tpu", "mask.layers": "2"},
    "cut vinyl": {"mask.route": "cut"},
}


def commands(text: str) -> list[list[str]]:
    """The two commands of the section, as their words."""
    section = text.partition("## Three routes to a mask")[2].partition("\n## ")[0]
    blocks = re.findall(r"```sh\n(.*?)```", section, re.DOTALL)
    lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
    return [shlex.split(line) for line in lines if line.startswith("lumitip-fab explore")]


def test_each_route_has_the_errors_that_its_command_gives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = PAGE.read_text(encoding="utf-8")
    monkeypatch.chdir(ROOT)
    found: list[dict[str, str]] = []
    for number, (_, *words) in enumerate(commands(text)):
        out = tmp_path / str(number)
        words[words.index("--out") + 1] = str(out)
        assert main([*words, "--quiet"]) == 0
        with (out / "designs.csv").open(encoding="utf-8", newline="") as file:
            found += csv.DictReader(file)
    shown = {name: figures for name, *figures in _ROW.findall(text)}
    assert shown.keys() == ROWS.keys()
    for name, wanted in ROWS.items():
        row = next(row for row in found if all(row.get(k) == v for k, v in wanted.items()))
        for figure, column in zip(shown[name], ("error_mm", "error_deg", "bound_mm"), strict=True):
            digits = len(figure.partition(".")[2])
            assert f"{float(row[column]):.{digits}f}" == figure, (name, column)
