"""Pictures of the boards against the boards: each damage is seen in the file that has it."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from damages import cut_short, edit, excerpt, failing
from lumitip_fab.checks import pictures
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.encoding import read_design

FRONT = "boards/receiver/receiver_front"
Damage = Callable[[Path], None]


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The receiver's board and its pictures, to damage."""
    ends = (".kicad_pcb", "_front.svg", "_front.png", "_back.svg", "_back.png")
    paths = (f"boards/receiver/receiver{end}" for end in ends)
    return excerpt(outputs, tmp_path / "pictures", *paths)


def svg(old: str, new: str) -> Damage:
    def damage(folder: Path) -> None:
        path = folder / f"{FRONT}.svg"
        text = path.read_text()
        changed = re.sub(old, new, text, count=1)
        assert changed != text
        path.write_text(changed)

    return damage


def png(change: Callable[[PIL.Image.Image], PIL.Image.Image]) -> Damage:
    def damage(folder: Path) -> None:
        path = folder / f"{FRONT}.png"
        with PIL.Image.open(path) as shown:
            changed = change(shown)
        changed.save(path)

    return damage


def painted(picture: PIL.Image.Image) -> PIL.Image.Image:
    """A square of 4 mm in the colour of the mask."""
    seen = np.array(picture)
    seen[600:728, 600:728] = (25, 27, 29, 255)
    return PIL.Image.fromarray(seen)


def noise(picture: PIL.Image.Image) -> PIL.Image.Image:
    seen = np.array(picture)
    seen[..., :3] += np.random.default_rng(1).integers(0, 2, seen[..., :3].shape, np.uint8)
    return PIL.Image.fromarray(seen)


def other_side(folder: Path) -> None:
    back = folder / f"{FRONT.replace('front', 'back')}.png"
    (folder / f"{FRONT}.png").write_bytes(back.read_bytes())


def board_changed(folder: Path) -> None:
    """The pictures are of a board before its tracks were moved by 0.3 mm."""
    path = folder / "boards/receiver/receiver.kicad_pcb"
    moved = r"(\(segment\s+\(start )([\d.]+)( [\d.]+\)\s+\(end )([\d.]+)"
    text = path.read_text()
    changed = re.sub(
        moved, lambda m: f"{m[1]}{float(m[2]) + 0.3:.4f}{m[3]}{float(m[4]) + 0.3:.4f}", text
    )
    assert changed != text
    path.write_text(changed)


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "SVG mirrored": (svg('viewBox="', 'transform="scale(-1 1)" viewBox="'), {"readable"}),
    "SVG of another size": (svg('width="([\\d.]+)mm"', 'width="30mm"'), {"readable"}),
    "SVG covered": (
        svg("</svg>", '<rect x="-5" y="-5" width="9" height="9" fill="#000"/></svg>'),
        {"readable"},
    ),
    "SVG shifted": (svg('viewBox="-', 'viewBox="-1'), {"colours"}),
    "copper gone": (svg('<path id="covered copper"[^>]*>', ""), {"areas", "colours"}),
    "laminate gone": (svg('<path id="laminate"[^>]*>', ""), {"areas", "colours"}),
    "silkscreen of another form": (
        svg('id="silkscreen" (.*?) d="M', r'id="silkscreen" \1 d="C'),
        {"readable"},
    ),
    "silkscreen twice": (
        svg("<title>", '<path id="silkscreen" fill="#f3f2ea" fill-rule="evenodd" d=""/><title>'),
        {"readable"},
    ),
    "colour that is not opaque": (svg('fill="#191b1d"', 'fill="#191b1d80"'), {"readable"}),
    "SVG cut short": (lambda folder: cut_short(folder / f"{FRONT}.svg", 40_000), {"readable"}),
    "SVG gone": (lambda folder: (folder / f"{FRONT}.svg").unlink(), {"readable"}),
    "PNG mirrored": (png(lambda p: p.transpose(PIL.Image.Transpose.FLIP_LEFT_RIGHT)), {"colours"}),
    "PNG upside down": (
        png(lambda p: p.transpose(PIL.Image.Transpose.FLIP_TOP_BOTTOM)),
        {"colours"},
    ),
    "PNG painted over": (png(painted), {"colours"}),
    "PNG with noise": (png(noise), {"colours", "edges"}),
    "PNG of a pixel": (png(lambda p: p.resize((1, 1))), {"readable"}),
    "PNG squeezed": (png(lambda p: p.resize((p.width // 2, p.height))), {"readable"}),
    "PNG cut short": (lambda folder: cut_short(folder / f"{FRONT}.png", 9000), {"readable"}),
    "PNG gone": (lambda folder: (folder / f"{FRONT}.png").unlink(), {"readable"}),
    "PNG of the other side": (other_side, {"colours"}),
    "board changed": (board_changed, {"colours"}),
}


@pytest.mark.slow
def test_nothing_fails_as_it_is_written(outputs: Path) -> None:
    assert failing(outputs, "pictures") == set()


@pytest.mark.slow
@pytest.mark.parametrize("case", DAMAGES)
def test_a_damage_is_found(case: str, copied: Path) -> None:
    damage, expected = DAMAGES[case]
    damage(copied)
    found = {m.check.removeprefix("pictures."): m.subject for m in failed(copied)}
    assert set(found) == expected
    assert all(subject.startswith("boards/receiver/receiver_") for subject in found.values())


def failed(folder: Path) -> list[Measurement]:
    design = read_design(folder / "design.json")
    found = pictures.measure_board(folder, design, "receiver")
    return [m for m in found if not m.passed]


def test_a_board_without_a_closed_edge_is_named(copied: Path) -> None:
    path = copied / "boards/receiver/receiver.kicad_pcb"
    path.write_text(path.read_text().replace('"Edge.Cuts"', '"Dwgs.User"'))
    assert [(m.check, m.subject) for m in failed(copied)] == [
        ("pictures.readable", "boards/receiver")
    ]


def test_a_board_that_cannot_be_read_is_named(copied: Path) -> None:
    edit(copied / "boards/receiver/receiver.kicad_pcb", "(kicad_pcb", "(kicad_")
    assert [(m.check, m.subject) for m in failed(copied)] == [
        ("pictures.readable", "boards/receiver")
    ]
