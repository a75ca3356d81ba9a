"""The mask for a cutter: DXF in mm, the page's view (mirrored) without its stretch."""

import io
from collections.abc import Iterator
from contextlib import contextmanager

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.enums import TextEntityAlignment
from ezdxf.layouts import Modelspace

from lumitip_fab.design import Mask, Point
from lumitip_fab.frames import Matrix
from lumitip_fab.mask.artwork import Artwork

# Layer and its colour by AutoCAD's index.
LAYERS = {"CUT": 1, "FOLD": 5, "BLACK": 7, "APERTURES": 3, "WINDOW": 4, "BANDS": 8, "MARKS": 6}
MIRRORED_TEXT = 2  # flag of group 71


def dxf_drawing(artwork: Artwork, mask: Mask) -> bytes:
    """The bytes of the DXF.

    Args:
        artwork: what to draw.
        mask: for the apertures' form and the registration marks.
    """
    with _fixed_metadata():
        document = ezdxf.new("R2010", units=units.MM)
        for name, colour in LAYERS.items():
            document.layers.add(name, color=colour)
        space = document.modelspace()
        _film(space, artwork)
        _apertures(space, artwork, mask)
        _marks(space, artwork, mask)
        # ezdxf lists the classes in use in the order of a set of strings.
        document.classes.add_required_classes(document.dxfversion)
        document.classes.classes = dict(sorted(document.classes.classes.items()))
        stream = io.StringIO()
        document.write(stream)
    return stream.getvalue().encode()


def dxf_to_sensor() -> Matrix:
    """From the drawing to the sensor frame."""
    return np.diag([-1.0, 1.0, 1.0, 1.0])


@contextmanager
def _fixed_metadata() -> Iterator[None]:
    """Have ezdxf write no time and no random identifier."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _film(space: Modelspace, artwork: Artwork) -> None:
    _closed(space, artwork.cut.corners, "CUT")
    for flap in artwork.flaps:
        start, end = (_at(point) for point in flap.fold)
        space.add_line(start, end, dxfattribs={"layer": "FOLD"})
        _closed(space, flap.band, "BANDS")
    _closed(space, artwork.black.corners, "BLACK")
    _closed(space, artwork.window.corners, "WINDOW")


def _apertures(space: Modelspace, artwork: Artwork, mask: Mask) -> None:
    attributes = {"layer": "APERTURES"}
    for path in artwork.apertures:
        if mask.hole_shape == "circle":
            centre = tuple(np.mean(path.corners, axis=0).tolist())
            space.add_circle(_at(centre), mask.hole_mm / 2, dxfattribs=attributes)
        else:
            _closed(space, path.corners, "APERTURES")


def _marks(space: Modelspace, artwork: Artwork, mask: Mask) -> None:
    attributes = {"layer": "MARKS"}
    for x, y in mask.registration:
        space.add_circle((x, y), 1.2, dxfattribs=attributes)
        space.add_line((x - 2, y), (x + 2, y), dxfattribs=attributes)
        space.add_line((x, y - 2), (x, y + 2), dxfattribs=attributes)
    _closed(space, artwork.mark.corners, "MARKS")
    texts = [(artwork.name, artwork.name_at, 0.7 * artwork.name_mm, TextEntityAlignment.LEFT)]
    texts += [(str(f.number), f.label, 1.5, TextEntityAlignment.MIDDLE) for f in artwork.flaps]
    for text, point, height, align in texts:
        style = {**attributes, "text_generation_flag": MIRRORED_TEXT}
        space.add_text(text, height=height, dxfattribs=style).set_placement(_at(point), align=align)


def _closed(space: Modelspace, corners: tuple[Point, ...], layer: str) -> None:
    space.add_lwpolyline([_at(p) for p in corners], close=True, dxfattribs={"layer": layer})


def _at(point: Point) -> Point:
    """Mirrored as on the page, to a nanometre."""
    return round(-point[0], 6) + 0.0, round(point[1], 6)
