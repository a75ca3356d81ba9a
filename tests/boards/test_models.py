"""The parts' 3D models: KiCad finds each where the layout has its part, and damage is found."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from build123d import import_step

from damages import edit, failing
from lumitip_fab.boards.kicad.nodes import body_strokes
from lumitip_fab.boards.model import PlacedComponent
from lumitip_fab.boards.placed import placed_box
from lumitip_fab.boards.placement import place
from lumitip_fab.catalogue.controllers import Shroud, Strip
from lumitip_fab.checks.models import _seen
from lumitip_fab.design import Design, footprints
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import on_board_page
from lumitip_fab.errors import BuildError
from lumitip_fab.models.files import _different, model_files
from programs import needs

pytestmark = pytest.mark.slow

Boards = Callable[[str], Path]
Body = tuple[str, tuple[float, ...]]
BOARDS = ("emitter", "receiver", "breakout", "flange")
EVERY = (
    *(("small", name) for name in BOARDS),
    *(pytest.param("fingertip", name, marks=pytest.mark.slow) for name in BOARDS),
    pytest.param("integrated", "flange", marks=pytest.mark.slow),
)
NEAR_MM = 0.02
COPPER_MM = 0.1  # KiCad puts parts onto the copper, and ends the board's body below it
HEADER = Strip(
    source="test",
    confidence="assumed",
    manufacturer="any",
    order_number="X",
    ways=3,
    rows=2,
    pitch_mm=2.54,
    pad_mm=1.7,
    drill_mm=1.0,
    height_mm=9.0,
    shroud=Shroud(body_mm=(15.28, 8.9), beyond_mm=1.84, notch_mm=4.1),
)


def parts_of(design: Design, name: str) -> tuple[PlacedComponent, ...]:
    """The parts of a board that have a body."""
    boards = (*design.fingers, *design.auxiliary_boards)
    board = next(board for board in boards if board.name == name)
    return tuple(part for part in place(design, board).components if part.part)


def wanted(part: PlacedComponent, pcb_mm: float) -> tuple[float, ...]:
    """The box round a part in KiCad's export: y up, z from the board's back."""
    shape = part.footprint
    box = placed_box(part, _seen(shape))
    (left, low), (right, high) = (
        on_board_page(at) for at in ((box.x_min_mm, box.y_min_mm), (box.x_max_mm, box.y_max_mm))
    )
    out = pcb_mm + shape.height_mm if part.side == "front" else -shape.height_mm
    return left, right, -low, -high, out


def bodies(exported: Path) -> list[tuple[str, Any]]:
    """Names and boxes of the parts in a STEP file of KiCad."""
    whole = import_step(exported)
    return [(body.label, body.bounding_box()) for body in whole.children]


def unseen(exported: Path, parts: tuple[PlacedComponent, ...], pcb_mm: float) -> set[str]:
    """Parts without a body of their own size in their place."""
    found = bodies(exported)
    lost = set()
    for part in parts:
        box, name = wanted(part, pcb_mm), part.footprint.model.removesuffix(".step")
        here = [
            b
            for label, b in found
            if label == name.replace(".", "_")
            and max(
                abs(b.min.X - box[0]),
                abs(b.max.X - box[1]),
                abs(b.min.Y - box[2]),
                abs(b.max.Y - box[3]),
                abs((b.max.Z if part.side == "front" else b.min.Z) - box[4]) - COPPER_MM,
            )
            < NEAR_MM
        ]
        if len(here) != 1:
            lost.add(part.ref)
    return lost


def exported(kicad: Callable[..., str], board: Path, to: Path) -> Path:
    """The board as KiCad exports it."""
    kicad("kicad-cli", "pcb", "export", "step", "--force", "-o", to, board)
    return to


@needs("kicad-cli")
@pytest.mark.parametrize(("preset", "name"), EVERY)
def test_kicad_has_every_body_in_its_place(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    folder = boards(preset)
    design = read_design(folder / "design.json")
    pcb_mm = design.stack.pcb_mm if name in BOARDS[:2] else design.stack.auxiliary_mm
    parts = parts_of(design, name)
    file = exported(kicad, folder / f"boards/{name}/{name}.kicad_pcb", tmp_path / "board.step")
    assert unseen(file, parts, pcb_mm) == set()
    assert len(bodies(file)) == len(parts) + 1  # and the board


@needs("kicad-cli")
def test_a_damaged_path_is_seen_by_kicad_and_by_the_check(
    kicad: Callable[..., str], damaged_boards: Path, tmp_path: Path
) -> None:
    design = read_design(damaged_boards / "design.json")
    board = damaged_boards / "boards/breakout/breakout.kicad_pcb"
    edit(board, "../models/PinSocket", "../models/NoSocket")
    file = exported(kicad, board, tmp_path / "board.step")
    parts = parts_of(design, "breakout")
    assert unseen(file, parts, design.stack.auxiliary_mm) == {"J1"}
    assert failing(damaged_boards, "models") == {"files"}


def lost(folder: Path) -> None:
    (folder / "boards/models/RESC1608X50N.step").unlink()


def of_another(folder: Path) -> None:
    """One package's model under another's name."""
    models = folder / "boards/models"
    shutil.copy(models / "CAPC1608X90N.step", models / "RESC1608X50N.step")


def cut_short(folder: Path) -> None:
    (folder / "boards/models/RESC1608X50N.step").write_text("ISO-10303-21;")


def vrml_lost(folder: Path) -> None:
    (folder / "boards/models/RESC1608X50N.wrl").unlink()


def vrml_in_mm(folder: Path) -> None:
    """As other programs write it: KiCad shows the part 2.54 times as large."""
    path = folder / "boards/models/RESC1608X50N.wrl"
    points = re.compile(r"-?\d+\.\d{3,}")
    text = points.sub(lambda m: f"{2.54 * float(m[0]):.5f}", path.read_text())
    path.write_text(text)


def _board(old: str, new: str) -> Callable[[Path], None]:
    return lambda folder: edit(folder / "boards/flange/flange.kicad_pcb", old, new)


DAMAGES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "file lost": (lost, {"files"}),
    "another's model": (of_another, {"size"}),
    "file cut short": (cut_short, {"size"}),
    "VRML lost": (vrml_lost, {"vrml"}),
    "VRML in mm": (vrml_in_mm, {"vrml"}),
    "model turned": (_board("(rotate (xyz 0 0 0))", "(rotate (xyz 0 0 180))"), {"places"}),
    "model shifted": (_board("(offset (xyz 0 0 0))", "(offset (xyz 1 0 0))"), {"places"}),
    "model in inches": (_board("(scale (xyz 1 1 1))", "(scale (xyz 2.54 2.54 2.54))"), {"places"}),
    "another path": (_board("${KIPRJMOD}/../models/", "/tmp/models/"), {"files"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_is_found(damaged_boards: Path, name: str) -> None:
    damage, checks = DAMAGES[name]
    assert failing(damaged_boards, "models") == set()
    damage(damaged_boards)
    assert failing(damaged_boards, "models") == checks


def test_the_same_design_gives_the_same_models(boards: Boards) -> None:
    folder = boards("small")
    made = model_files(read_design(folder / "design.json"))
    assert {artefact.path for artefact in made} == {
        f.relative_to(folder).as_posix() for f in (folder / "boards/models").iterdir()
    }
    for artefact in made:
        assert (folder / artefact.path).read_bytes() == artefact.data


def test_two_bodies_of_one_name_are_refused(designs: Callable[[str], Design]) -> None:
    capacitor = designs("small").packages.capacitor
    other = capacitor.model_copy(update={"body_mm": (1.6, 0.85, 0.9)})
    both = [("capacitor", footprints.chip("capacitor", entry)) for entry in (capacitor, other)]
    with pytest.raises(BuildError, match=r"1.6 x 0.8 x 0.9 and 1.6 x 0.85 x 0.9 mm"):
        list(_different(both))


def test_a_shroud_is_drawn_on_the_side_of_its_plug() -> None:
    shape = footprints.rows("Header", HEADER)
    assert shape.shroud is not None
    box = shape.shroud.box
    assert (box.y_min_mm, box.y_max_mm) == pytest.approx((3.11, 12.01))
    body, shroud, *notch = body_strokes(shape)
    assert sorted({x for x, _ in shroud.points}) == pytest.approx([-7.64, 7.64])
    assert [points.points[0][0] for points in notch] == pytest.approx([-2.05, 2.05])
    assert max(abs(y) for _, y in body.points) == pytest.approx(2.54)
