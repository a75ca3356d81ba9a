"""The smooth film of the moulds' floor, as written: what is measured, and every damage seen."""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.layouts import Modelspace
from manifold3d import Manifold

from damages import box, carve, cut_short, edit, failing
from finger_notes import noted_mould
from lumitip_fab.checks import insert as insert_checks
from lumitip_fab.checks import mould as mould_checks
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Box, Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.design.frames import mould_bed_to_sensor
from lumitip_fab.parts.insert import insert_files, insert_page

pytestmark = pytest.mark.slow

STL, NOTE, DXF = "mould/receiver_mould.stl", "mould/receiver_casting.md", "mould/insert.dxf"
FILM = '\n[mould]\ninsert = "PET 100um"\n'
DESIGNS = {
    "published": 'extends = "presets/published.toml"' + FILM,
    "dense": 'extends = "presets/dense.toml"' + FILM,
    "asymmetric": 'extends = "presets/asymmetric.toml"' + FILM,
    "flex": 'extends = "presets/flex.toml"' + FILM + "draft_deg = 2.5\n",
    "loose": 'extends = "fingertip.toml"' + FILM + "[printer]\nfit_mm = 0.1\n",
    "long": 'extends = "fingertip.toml"\n[grid]\ncolumns = [9, 8, 9]\npitch_mm = 6.0' + FILM,
    "stretched": 'extends = "fingertip.toml"\n[mask]\nmeasured_ruler_mm = [99.2, 100.4]' + FILM,
}
Made = Callable[[str], Path]


@pytest.fixture(scope="module")
def made(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """`made("flex")`: moulds and insert of a design in a folder. Do not change it."""
    root = tmp_path_factory.mktemp("inserts")
    shutil.copytree(design_dir, root / "design")

    def make(name: str) -> Path:
        out = root / name
        if out.is_dir():
            return out
        file = root / "design" / "mine.toml"
        file.write_text(DESIGNS[name], encoding="utf-8")
        design = derive(load(file))
        (out / "mould").mkdir(parents=True)
        made = [a for finger in design.fingers for a in noted_mould(design, finger)]
        made += [a for insert in design.inserts for a in insert_files(design, insert)]
        for artefact in made:
            (out / artefact.path).write_bytes(artefact.data)
        (out / "design.json").write_text(design_text(design), encoding="utf-8")
        return out

    return make


@pytest.fixture
def copied(made: Made, tmp_path: Path) -> Path:
    """The files of the published design with a film, to damage."""
    return Path(shutil.copytree(made("published"), tmp_path / "damaged"))


@pytest.mark.parametrize("name", DESIGNS)
def test_moulds_with_a_film_pass_every_check(name: str, made: Made) -> None:
    design = read_design(made(name) / "design.json")
    found = [*insert_checks.measure(made(name), design)]
    assert {m.check for m in found} == {f"insert.{name}" for name in EVERY - {"mould"}}
    found += [m for m in mould_checks.measure(made(name), design) if m.check != "mould.seat"]
    assert not [m for m in found if not m.passed]


@pytest.mark.parametrize("name", DESIGNS)
def test_the_film_is_symmetric_and_covers_both_fingers(name: str, made: Made) -> None:
    design = read_design(made(name) / "design.json")
    (insert,) = design.inserts
    assert insert.box.x_min_mm == -insert.box.x_max_mm
    assert insert.clearance_mm == pytest.approx(0.4 if name == "loose" else 0.3)
    for finger in design.fingers:
        cells = np.array(finger.cells)
        assert (cells.min(axis=0) > (insert.box.x_min_mm, insert.box.y_min_mm)).all()
        assert (cells.max(axis=0) < (insert.box.x_max_mm, insert.box.y_max_mm)).all()


# In the sensor frame: the floor is at z = -0.1, that of the recess at 0, and the bed at 2.4. The
# film reaches to x = 19.04 and y = 15.45, the recess 0.3 mm farther.


def recess_deeper(part: Manifold) -> Manifold:
    return part - box((-19.34, -15.75, -0.2), (19.34, 15.75, 0.05))


def recess_forgotten(part: Manifold) -> Manifold:
    return part + box((-19.4, -15.8, -0.1), (19.4, 15.8, 0.5))


def recess_narrow(part: Manifold) -> Manifold:
    return part + box((19.0, -5, -0.1), (19.5, 5, 0.5))


def recess_wide(part: Manifold) -> Manifold:
    return part - box((19.0, -5, -0.2), (19.45, 5, 0.0))


def blob_under_the_film(part: Manifold) -> Manifold:
    return part + box((-1, -1, -0.05), (1, 1, 0.5))


def stop_on_the_film(part: Manifold) -> Manifold:
    return part + box((17, -15, -0.6), (18, -14, 0.5))


def stop_beside_the_film(part: Manifold) -> Manifold:
    return part + box((19.4, -5, -0.6), (19.5, 5, 0.5))


SOLID = {
    recess_deeper: {"level"},
    recess_forgotten: {"level", "play"},
    recess_narrow: {"play"},
    recess_wide: {"play"},
    blob_under_the_film: {"level"},
    stop_on_the_film: {"level", "apart"},
    stop_beside_the_film: {"apart"},
}


@pytest.mark.parametrize("damage", SOLID, ids=lambda d: d.__name__)
def test_a_damaged_mould(damage: Callable[[Manifold], Manifold], copied: Path) -> None:
    design = read_design(copied / "design.json")
    carve(copied / STL, damage, mould_bed_to_sensor(design.stack, design.mould))
    assert failing(copied, "insert") == SOLID[damage]


def redraw(folder: Path, draw: Callable[[Modelspace], None]) -> None:
    document = ezdxf.readfile(folder / DXF)
    draw(document.modelspace())
    document.saveas(folder / DXF)


def moved(folder: Path, x: tuple[float, float], y: tuple[float, float]) -> None:
    """Draw the film with these sides."""

    def draw(space: Modelspace) -> None:
        (line,) = space
        line.set_points([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], format="xy")

    redraw(folder, draw)


def film_short(folder: Path) -> None:
    moved(folder, (-19.04, 19.04), (-14.2, 15.45))


def film_aside(folder: Path) -> None:
    moved(folder, (-18.9, 19.18), (-15.45, 15.45))


def film_with_a_hole(folder: Path) -> None:
    redraw(folder, lambda space: space.add_circle((0, 0), 1, dxfattribs={"layer": "CUT"}))


def film_in_inches(folder: Path) -> None:
    document = ezdxf.readfile(folder / DXF)
    document.units = ezdxf.units.IN
    document.saveas(folder / DXF)


def film_cut_short(folder: Path) -> None:
    cut_short(folder / DXF)


def film_missing(folder: Path) -> None:
    (folder / DXF).unlink()


def page_missing(folder: Path) -> None:
    (folder / "mould/insert_a4.pdf").unlink()


def page_enlarged(folder: Path) -> None:
    design = read_design(folder / "design.json")
    (insert,) = design.inserts
    larger = replace(insert, box=insert.box.grown(0.1))
    (folder / "mould/insert_letter.pdf").write_bytes(insert_page(larger, design, "letter"))


def size_edited(folder: Path) -> None:
    edit(folder / NOTE, "never outside: 38.08 x", "never outside: 38.80 x")


def size_gone(folder: Path) -> None:
    text = (folder / NOTE).read_text(encoding="utf-8")
    (folder / NOTE).write_text(re.sub(r"never outside: .* mm\.", "", text), encoding="utf-8")


def mould_missing(folder: Path) -> None:
    (folder / STL).unlink()


def note_missing(folder: Path) -> None:
    (folder / NOTE).unlink()


FILES = {
    film_short: {"covers", "play", "level", "page", "note"},
    film_aside: {"play"},
    film_with_a_hole: {"readable"},
    film_in_inches: {"readable"},
    film_cut_short: {"readable"},
    film_missing: {"readable"},
    page_missing: {"page"},
    page_enlarged: {"page"},
    size_edited: {"note"},
    size_gone: {"note"},
    mould_missing: {"mould"},
    note_missing: {"mould"},
}
EVERY = set().union(*SOLID.values(), *FILES.values())


@pytest.mark.parametrize("damage", FILES, ids=lambda d: d.__name__)
def test_a_damaged_file(damage: Callable[[Path], None], copied: Path) -> None:
    damage(copied)
    assert failing(copied, "insert") == FILES[damage]


def test_a_film_of_another_thickness_is_seen(copied: Path) -> None:
    design = read_design(copied / "design.json")
    (insert,) = design.inserts
    thicker = replace(design.mould, inserts=(replace(insert, thickness_mm=0.15),))
    text = design_text(replace(design, mould=thicker))
    (copied / "design.json").write_text(text, encoding="utf-8")
    assert "level" in failing(copied, "insert")
    assert "thickness" in failing(copied, "mould")


def test_a_film_that_misses_a_cell_is_seen(copied: Path) -> None:
    """The aperture of one cell more, beyond the film."""
    design = read_design(copied / "design.json")
    cells = (*design.receiver.cells, (20.0, 0.0))
    text = design_text(replace(design, receiver=replace(design.receiver, cells=cells)))
    (copied / "design.json").write_text(text, encoding="utf-8")
    assert failing(copied, "insert") == {"covers"}


def test_without_a_film_nothing_is_measured(design_dir: Path, tmp_path: Path) -> None:
    design: Design = derive(load(design_dir / "presets" / "published.toml"))
    assert not design.inserts
    assert not [*insert_checks.measure(tmp_path, design)]


def test_the_recess_is_the_film_and_its_play(made: Made) -> None:
    (insert,) = read_design(made("published") / "design.json").inserts
    assert insert.box == Box(-19.04, 19.04, -15.45, 15.45)
    assert insert.recess == insert.box.grown(0.3)
