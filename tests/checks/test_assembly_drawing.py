"""Assembly drawings against the boards: each damage is seen in the drawing that has it."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import excerpt, failing
from lumitip_fab.checks import assembly_drawing
from lumitip_fab.design.encoding import read_design

DRAWING = "boards/receiver/receiver_assembly_front.svg"
Change = Callable[[str], str]


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The receiver's board and its drawing, to damage."""
    return excerpt(outputs, tmp_path / "drawn", "boards/receiver/receiver.kicad_pcb", DRAWING)


def seen_in(folder: Path) -> set[str]:
    return failing(folder, "assembly_drawing", "receiver")


def sub(old: str, new: str) -> Change:
    return lambda text: re.sub(old, new, text, count=1, flags=re.DOTALL)


def exchanged(text: str) -> str:
    """The names of two parts."""
    return (
        text.replace('id="Q3"', 'id="Q0"')
        .replace('id="Q7"', 'id="Q3"')
        .replace('id="Q0"', 'id="Q7"')
    )


def mirrored(text: str) -> str:
    """As if it were seen from the back, without the words, which stay where they were."""

    def corner(found: re.Match[str]) -> str:
        return f"{found[1]}{-float(found[2]):g} "

    return re.sub(r"([ML])(-?[\d.]+) ", corner, text)


def test_the_drawings_of_a_build_hold(outputs: Path) -> None:
    found = list(assembly_drawing.measure(outputs, read_design(outputs / "design.json")))
    assert len({one.subject for one in found}) == 6
    assert [one for one in found if not one.passed] == []


@pytest.mark.parametrize(
    ("change", "seen"),
    [
        (sub(r'<g id="Q5">.*?</g></g>', ""), {"parts"}),
        (sub('id="Q5"', 'id="Q55"'), {"parts"}),
        (exchanged, {"places", "words", "marks"}),
        (sub(r'(<g id="Q5">.*?)<path class="mark"[^>]*/>', r"\1"), {"marks"}),
        (sub(r'(<g id="C1">.*?translate\()[-\d.]+', r"\g<1>0"), {"words"}),
        (sub(">Q5<", ">Q6<"), {"words"}),
        (mirrored, {"places", "words", "marks"}),
        (
            sub(r'id="board" (.*?) d="M', r'id="board" \1 d="M99 99L'),
            {"outline", "places", "marks"},
        ),
        (sub("<svg", "<svg<"), {"readable"}),
        (sub(r'<g id="Q5">', '<g id="Q4">'), {"readable"}),
    ],
    ids=lambda value: value.__name__ if callable(value) else "-".join(sorted(value)),
)
def test_damage_is_seen(copied: Path, change: Change, seen: set[str]) -> None:
    path = copied / DRAWING
    text = path.read_text()
    path.write_text(change(text))
    assert path.read_text() != text
    assert seen_in(copied) == seen


def test_a_turned_mark_is_seen(copied: Path) -> None:
    """The mark of one photodetector at its other end."""
    path = copied / DRAWING
    text = path.read_text()
    part = re.search(r'<g id="Q5">(<path [^>]*/>)(<path class="mark"[^>]*/>)', text)
    assert part is not None
    body, mark = (re.findall(r"[ML](-?[\d.]+) (-?[\d.]+)", p) for p in part.groups())
    middle = sum(float(x) for x, _ in body) / len(body)
    turned = "L".join(f"{2 * middle - float(x):.2f} {y}" for x, y in mark)
    path.write_text(text.replace(part[2], re.sub(r'd="[^"]*"', f'd="M{turned}Z"', part[2])))
    assert seen_in(copied) == {"marks"}


def test_a_missing_drawing_is_seen(copied: Path) -> None:
    (copied / DRAWING).unlink()
    assert seen_in(copied) == {"readable"}
