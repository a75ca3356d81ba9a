"""The manual's pages: a step on each, in the order of the work, and none that is half empty."""

import re
from collections.abc import Callable
from html import unescape
from itertools import pairwise
from pathlib import Path

import numpy as np
import pikepdf
import pytest

from lumitip_fab.design.encoding import read_design
from manual_reader import read_pdf

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
HTML, PDF = "manual/manual.html", "manual/manual.pdf"
LIST_ROWS = 21
"""Rows of tables, at most, of a step that is no list."""
PRESETS = sorted(file.stem for file in (ROOT / "design/presets").glob("*.toml"))


def lowest_of(page: pikepdf.Page) -> float:
    """Height of the lowest words of a page over its edge, without the two at its foot (points)."""
    now, kept, heights = np.eye(3), [np.eye(3)], list[float]()
    line = np.eye(3)
    for operands, operator in pikepdf.parse_content_stream(page):
        match str(operator):
            case "q":
                kept.append(now)
            case "Q":
                now = kept.pop()
            case "cm" | "Tm" as kind:
                a, b, c, d, e, f = map(float, operands)
                matrix = np.array([[a, b, 0], [c, d, 0], [e, f, 1]])
                now, line = (matrix @ now, line) if kind == "cm" else (now, matrix)
            case "Tj":
                heights.append(float((line @ now)[2, 1]))
    return min(heights[2:])


def _plain(text: str) -> str:
    bare = re.sub(r"<style>.*?</style>|<[^>]*>", " ", text, flags=re.DOTALL)
    return " ".join(unescape(bare).split())


@pytest.mark.parametrize("preset", PRESETS)
def test_each_step_has_a_page(built: Callable[[str], Path], preset: str) -> None:
    """But lists. Some short steps share one; no page but the last is half empty."""
    sheets, _ = read_pdf(built(preset) / PDF)
    text = (built(preset) / HTML).read_text(encoding="utf-8")
    found = re.findall(r"<h2>(\d+\. .*?)</h2>(.*?)(?=<h2>|</body>)", text, re.DOTALL)
    assert len(found) > 20
    appendix = re.search(r"<h2>(Parts of the \w+ board)</h2>", text)
    assert appendix is not None
    parts = next(n for n, s in enumerate(sheets) if s.startswith(appendix[1].replace(" ", "")))
    heads = [unescape(title).replace(" ", "") for title, _ in found]
    begins = [next(n for n, sheet in enumerate(sheets) if head in sheet) for head in heads]
    lists = {n for n, (_, step) in enumerate(found[:2]) if step.count("<tr>") > LIST_ROWS}
    assert 0 in lists
    ends = {parts - 1, len(sheets) - 1} | {begins[n + 1] - 1 for n in lists}
    for n, (begin, after) in enumerate(pairwise(begins)):
        if n not in lists:
            assert after == begin or sheets[after].startswith(heads[n + 1]), heads[n]
            assert after - begin <= 1, heads[n]
    assert begins[-1] == parts - 1
    with pikepdf.open(built(preset) / PDF) as document:
        margin, high = 51.0, float(document.pages[0].mediabox[3])
        for number, page in enumerate(document.pages):
            blank = (lowest_of(page) - margin) / (high - 2 * margin)
            assert blank < 0.51 or number in ends, f"page {number + 1}"


@pytest.mark.parametrize("preset", PRESETS)
def test_each_step_but_the_list_of_parts_has_a_picture(
    built: Callable[[str], Path], preset: str
) -> None:
    text = (built(preset) / HTML).read_text(encoding="utf-8")
    steps = re.findall(r"<h2>\d+\. (.*?)</h2>(.*?)(?=<h2>|</body>)", text, re.DOTALL)
    assert [unescape(title) for title, step in steps if "<img" not in step] == ["Parts"]


@pytest.mark.parametrize("preset", PRESETS)
def test_steps_have_the_order_of_the_work(built: Callable[[str], Path], preset: str) -> None:
    text = (built(preset) / HTML).read_text(encoding="utf-8")
    titles = re.findall(r"<h2>\d+\. (.*?)</h2>", text)
    bought = ["Parts", "Measure your gripper", "Look at the coupling", "Order the boards"]
    made = ["Solder the boards", "Print", "Cut the wires", "Solder the wires", "Load the firmware"]
    cast = ["First test", "Put the board in", "Try the mould", "Fill the mould", "Wrap the finger"]
    mounted = ["Put the flange in", "Mount the fingers", "Warm-up and calibration", "What wears"]
    order = [*bought, *made, *cast, *mounted]
    assert [title for title in titles if title in order] == [o for o in order if o in titles]
    design = read_design(built(preset) / "design.json")
    of_flange = {"Look at the coupling", "Put the flange in"}
    assert {*order} - {*titles} == (set() if design.flanges else of_flange)
    if design.flanges:
        own = any(board.name == "breakout" for board in design.auxiliary_boards)
        after = "Wrap the finger" if own else "Solder the boards"
        assert titles.index("Try the flange board") == titles.index(after) + 1


@pytest.mark.parametrize("preset", PRESETS)
def test_steps_that_are_named_are_there(built: Callable[[str], Path], preset: str) -> None:
    text = (built(preset) / HTML).read_text(encoding="utf-8")
    titles = re.findall(r"<h2>\d+\. (.*?)</h2>", text)
    notes = [path.read_text(encoding="utf-8") for path in built(preset).glob("*/*.md")]
    bills = [
        (built(preset) / f"{name}.csv").read_text(encoding="utf-8") for name in ("bom", "order")
    ]
    texts = [_plain(text), *(" ".join(note.split()) for note in notes)]
    named = {step for text in texts for step in re.findall(r'\bstep "([^"]+)"', text)}
    named |= {step for bill in bills for step in re.findall(r'length by step ([^",\n]+)', bill)}
    assert len(named) > 3
    assert named <= {*titles}
