"""Damage the printed sheet and the drawing that cuts a film, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import ezdxf
import pytest
from manifold3d import CrossSection

from damages import Body, box, carve, cut_short, failing, flip_a_triangle, passing, swap
from finger_notes import written_masks
from hidden_drawings import HIDDEN, redrawn
from lumitip_fab.config.load import load

pytestmark = pytest.mark.slow

STL, CUT = "mask/emitter_sheet.stl", "mask/emitter_cut.dxf"
BETWEEN = (0.0, 6.0)  # two cells of the middle column
Damage = Callable[[Path], None]


def carved(change: Callable[[Body], Body]) -> Damage:
    """Change the STL's body, on its bed."""
    return lambda out: carve(out / STL, change)


def drilled(x: float, y: float, diameter_mm: float) -> Damage:
    cutter = CrossSection.circle(diameter_mm / 2, 32).extrude(2.0).translate((x, y, -1.0))
    return carved(lambda body: body - cutter)


def turned_over(body: Body) -> Body:
    return body.rotate((0.0, 180.0, 0.0)).translate((0.0, 0.0, 0.4))


def renamed(out: Path) -> None:
    swap(out / STL, out / "mask/receiver_sheet.stl")
    swap(out / "mask/emitter_sheet.3mf", out / "mask/receiver_sheet.3mf")


def plugged(body: Body) -> Body:
    """Close the first layer under all holes."""
    return body + box((-20.0, -15.0, 0.0), (20.0, 15.0, 0.2))


SHEETS: dict[str, tuple[Damage, set[str]]] = {
    "a hole more": (drilled(*BETWEEN, 2.5), {"count", "size", "three_mf"}),
    "a hole wider": (drilled(0.0, 9.0, 3.4), {"size", "three_mf"}),
    "holes plugged": (carved(plugged), {"count", "position", "folds", "size", "three_mf"}),
    "all moved": (
        carved(lambda body: body.translate((0.2, 0.0, 0.0))),
        {"position", "outline", "window", "folds", "three_mf"},
    ),
    "larger": (
        carved(lambda body: body.scale((1.01, 1.01, 1.0))),
        {"position", "outline", "window", "folds", "three_mf"},
    ),
    "holes larger by a tenth": (
        carved(lambda body: body.scale((1.1, 1.1, 1.0))),
        {"position", "size", "outline", "window", "folds", "letter", "three_mf"},
    ),
    "thicker": (
        carved(lambda body: body.scale((1.0, 1.0, 1.25))),
        {"thickness", "layers", "count", "position", "three_mf"},
    ),
    "over the bed": (
        carved(lambda body: body.translate((0.0, 0.0, 0.2))),
        {"thickness", "three_mf", "outline", "folds", "count", "position", "size", "letter"},
    ),
    "mirrored": (
        carved(lambda body: body.mirror((1.0, 0.0, 0.0))),
        {"letter", "folds", "count", "size", "three_mf"},
    ),
    "grooves on the outside": (
        carved(turned_over),
        {"outline", "folds", "letter", "count", "size", "three_mf"},
    ),
    "groove filled": (
        carved(lambda body: body + box((-10.0, 21.5, 0.0), (10.0, 23.5, 0.4))),
        {"folds", "three_mf"},
    ),
    "flap shorter": (
        carved(lambda body: body - box((-30.0, 33.0, -1.0), (30.0, 50.0, 1.0))),
        {"outline", "three_mf"},
    ),
    "of the other finger": (renamed, {"outline", "window", "letter"}),
    "in two": (
        carved(lambda body: body - box((-60.0, 29.0, -1.0), (60.0, 29.2, 1.0))),
        {"bodies", "outline", "three_mf"},
    ),
    "a cell's hole moved": (
        carved(
            lambda body: (
                (body + box((-2.0, 7.0, 0.0), (2.0, 11.0, 0.4)))
                - CrossSection.circle(1.25, 32).extrude(2.0).translate((0.1, 9.0, -1.0))
            )
        ),
        {"position", "size", "three_mf"},
    ),
    "a triangle turned": (lambda out: flip_a_triangle(out / STL), {"watertight"}),
    "STL missing": (lambda out: (out / STL).unlink(), {"readable"}),
    "STL cut short": (lambda out: cut_short(out / STL), {"readable"}),
    "film missing": (lambda out: (out / "mask/emitter_mask.dxf").unlink(), {"readable"}),
    "3MF missing": (lambda out: (out / "mask/emitter_sheet.3mf").unlink(), {"three_mf"}),
    "3MF cut short": (lambda out: cut_short(out / "mask/emitter_sheet.3mf"), {"three_mf"}),
}


@pytest.mark.parametrize("name", SHEETS)
def test_a_damaged_sheet_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = SHEETS[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask_sheet") == expected


def test_a_narrow_web_counts_where_the_sheet_is_wrapped(design_dir: Path, tmp_path: Path) -> None:
    config = load(design_dir / "presets/published.toml").with_values({"mask.route": "tpu"})
    out = written_masks(config, tmp_path / "out")
    assert failing(out, "mask_sheet") == set()
    drilled(0.0, 6.0, 3.0)(out)  # 0.25 mm to its neighbours
    assert failing(out, "mask_sheet") == {"count", "size", "web", "three_mf"}


def edited(change: Callable[[ezdxf.document.Drawing], None]) -> Damage:
    def edit(out: Path) -> None:
        document = ezdxf.readfile(out / CUT)
        change(document)
        document.saveas(out / CUT)

    return edit


def _one(document: ezdxf.document.Drawing, query: str) -> ezdxf.entities.DXFEntity:
    return next(iter(document.modelspace().query(query)))


def hole_moved(document: ezdxf.document.Drawing) -> None:
    circle = _one(document, "CIRCLE")
    circle.dxf.center = circle.dxf.center + ezdxf.math.Vec3(0.05, 0, 0)


def tight(document: ezdxf.document.Drawing) -> None:
    for circle in document.modelspace().query("CIRCLE"):
        circle.dxf.radius = 2.9


def in_inches(document: ezdxf.document.Drawing) -> None:
    document.units = ezdxf.units.IN


CUTS: dict[str, tuple[Damage, set[str]]] = {
    "hole moved": (edited(hole_moved), {"position"}),
    "hole wider": (edited(lambda d: setattr(_one(d, "CIRCLE").dxf, "radius", 1.3)), {"size"}),
    "webs too narrow": (edited(tight), {"size", "web"}),
    "hole missing": (edited(lambda d: _one(d, "CIRCLE").destroy()), {"count", "position"}),
    "hole on another layer": (
        edited(lambda d: setattr(_one(d, "CIRCLE").dxf, "layer", "FOLD")),
        {"readable", "count", "position"},
    ),
    "fold missing": (edited(lambda d: _one(d, "LINE").destroy()), {"folds"}),
    "fold cut through": (
        edited(lambda d: setattr(_one(d, "LINE").dxf, "layer", "CUT")),
        {"readable", "folds"},
    ),
    "edge missing": (
        edited(lambda d: _one(d, 'LWPOLYLINE[layer=="CUT"]').destroy()),
        {"outline"},
    ),
    "in inches": (edited(in_inches), {"readable"}),
    **{change.__name__: (redrawn(CUT, change), {"readable"}) for change in HIDDEN},
    "missing": (lambda out: (out / CUT).unlink(), {"readable"}),
    "cut short": (lambda out: cut_short(out / CUT, 20000), {"readable"}),
    "of the other finger": (
        lambda out: swap(out / CUT, out / "mask/receiver_cut.dxf"),
        {"outline", "window"},
    ),
}


@pytest.mark.parametrize("name", CUTS)
def test_a_damaged_cut_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = CUTS[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask_cut") == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    for module, damages in (("mask_sheet", SHEETS), ("mask_cut", CUTS)):
        names = passing(masks, module, lambda _: True)
        assert names - {"fits_bed", "web"} <= set().union(
            *(expected for _, expected in damages.values())
        )


@pytest.mark.parametrize("preset", ["asymmetric", "dense", "flex", "franka_hand", "wsg50"])
@pytest.mark.parametrize("layers", [1, 2, 3])
def test_every_preset_passes_by_every_route(
    design_dir: Path, tmp_path: Path, preset: str, layers: int
) -> None:
    values = {"mask.route": "tpu", "mask.layers": layers, "mask.hole_shape": "circle"}
    config = load(design_dir / "presets" / f"{preset}.toml").with_values(values)
    out = written_masks(config, tmp_path / "out")
    for module in ("mask", "mask_sheet", "mask_cut", "mask_coupon"):
        assert failing(out, module) == set()
    shutil.copy(out / "mask/emitter_cut.dxf", out / "mask/receiver_cut.dxf")
    assert failing(out, "mask_cut")
