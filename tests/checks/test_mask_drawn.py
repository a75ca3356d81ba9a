"""Damage a mask's SVG or DXF, and exactly the right checks of its picture fail."""

from collections.abc import Callable
from pathlib import Path

import ezdxf
import pytest
from ezdxf import units
from ezdxf.document import Drawing
from ezdxf.math import Matrix44

from damages import cut_short, edit, failing

pytestmark = pytest.mark.slow

SVG, DXF = "mask/emitter_mask.svg", "mask/emitter_mask.dxf"
APERTURES = {"position", "size"}
Damage = Callable[[Path], None]


def svg(old: str, new: str) -> Damage:
    return lambda out: edit(out / SVG, old, new)


def wrapped(opening: str, closing: str = "</g>") -> Damage:
    """All of the drawing in another element."""

    def damage(out: Path) -> None:
        edit(out / SVG, "</title>", f"</title>{opening}")
        edit(out / SVG, "</svg>", f"{closing}</svg>")

    return damage


def in_points(out: Path) -> None:
    edit(out / SVG, 'mm" height', 'pt" height')
    edit(out / SVG, 'mm" viewBox', 'pt" viewBox')


def inverted(out: Path) -> None:
    edit(out / SVG, "</title>", '</title><rect width="200" height="200" fill="#000"/>')
    edit(out / SVG, 'id="black"', 'id="black" fill="#fff"')


def dxf(change: Callable[[Drawing], None]) -> Damage:
    def damage(out: Path) -> None:
        document = ezdxf.readfile(out / DXF)
        change(document)
        document.saveas(out / DXF)

    return damage


def dxf_mirrored(document: Drawing) -> None:
    for each in document.modelspace():
        each.transform(Matrix44.scale(-1, 1, 1))


def dxf_covered(document: Drawing) -> None:
    hatch = document.modelspace().add_hatch(dxfattribs={"layer": "MARKS"})
    hatch.paths.add_polyline_path([(-5, -5), (5, -5), (5, 15), (-5, 15)], is_closed=True)


def dxf_moved(document: Drawing) -> None:
    document.modelspace().query('*[layer=="APERTURES"]')[7].translate(0.03, 0, 0)


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "SVG scaled": (wrapped('<g transform="scale(1.01)">'), {"scale_x", "scale_y"}),
    "SVG turned": (wrapped('<g transform="rotate(90 48 47)">'), {"readable"}),
    "SVG in points": (in_points, {"readable"}),
    "SVG inverted": (inverted, {"readable"}),
    "SVG covered": (
        svg("</svg>", '<rect width="90" height="60" fill="#fff"/></svg>'),
        {"readable"},
    ),
    "SVG bleached": (
        svg("</svg>", '<rect x="30" y="30" width="30" height="30" fill="#fff"/></svg>'),
        {"black", *APERTURES},
    ),
    "SVG half transparent": (
        svg('id="black"', 'id="black" fill-opacity="0.5"'),
        {"black", *APERTURES},
    ),
    "SVG with a filter": (wrapped('<g filter="invert(1)">'), {"readable"}),
    "SVG with a mask": (wrapped('<mask id="m"/><g>'), {"readable"}),
    "SVG without openings": (svg('fill-rule="evenodd"', ""), {"open", *APERTURES}),
    "SVG cut short": (lambda out: cut_short(out / SVG), {"readable"}),
    "SVG missing": (lambda out: (out / SVG).unlink(), {"readable"}),
    "DXF mirrored": (dxf(dxf_mirrored), {"mirrored"}),
    "DXF in inches": (dxf(lambda d: setattr(d, "units", units.IN)), {"readable"}),
    "DXF in light years": (dxf(lambda d: setattr(d, "units", 19)), {"readable"}),
    "DXF without a unit": (dxf(lambda d: setattr(d, "units", 0)), {"readable"}),
    "DXF with a layer off": (
        dxf(lambda d: d.layers.get("APERTURES").off()),
        {"open", *APERTURES},
    ),
    "DXF covered": (dxf(dxf_covered), {"open", *APERTURES}),
    "DXF aperture moved": (dxf(dxf_moved), {"position"}),
    "DXF cut short": (lambda out: cut_short(out / DXF, 9000), {"readable"}),
    "DXF missing": (lambda out: (out / DXF).unlink(), {"readable"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = DAMAGES[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask_picture") == expected
