"""The mask as drawings in mm, the page's view (mirrored) without its stretch: SVG, DXF, and DXF to
cut an opaque film."""

import io
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from xml.sax.saxutils import escape

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.enums import TextEntityAlignment
from ezdxf.layouts import Modelspace

from lumitip_fab.design import Mask, Point, Title
from lumitip_fab.design.frames import Matrix
from lumitip_fab.mask.artwork import Artwork, Path
from lumitip_fab.text import data_file

MARGIN_MM = 6.0


def svg_drawing(artwork: Artwork, mask: Mask, title: Title, words: bool = True) -> bytes:
    """The bytes of the SVG.

    Args:
        artwork: what to draw.
        mask: for the registration marks, which give the sheet's size.
        title: of the design.
        words: whether it has the finger's name and the numbers of the flaps, which cannot be read
            where it is set smaller.
    """
    shift = _shift(mask)
    width, height = (f"{2 * shift[0]:g}", f"{_height(mask):g}")
    bands = (Path(f.band[0], tuple((p,) for p in f.band[1:])) for f in artwork.flaps)
    folds = (Path(f.fold[0], ((f.fold[1],),)) for f in artwork.flaps)
    holes = (artwork.black, artwork.window, *artwork.apertures)
    labels = (
        _text(str(f.number), (f.label[0], f.label[1] - 0.6), shift, 1.8, 'text-anchor="middle"')
        for f in (artwork.flaps if words else ())
    )
    name = _text(artwork.name, artwork.name_at, shift, artwork.name_mm, 'font-weight="bold"')
    drawing = data_file("mask/mask.svg").format(
        width=width,
        height=height,
        title=f"{escape(title.name)} {escape(title.revision)}: {artwork.name.lower()}",
        black=_d(holes, shift),
        bands=_d(bands, shift),
        mark=_d((artwork.mark,), shift),
        cut=_d((artwork.cut,), shift),
        folds=_d(folds, shift),
        registration="\n".join(_registration(p, shift) for p in mask.registration),
        name=name if words else "",
        labels="".join(f"\n{label}" for label in labels),
    )
    return drawing.encode()


def svg_to_sensor(mask: Mask) -> Matrix:
    """From the drawing (mm, y down) to the sensor frame."""
    x, y = _shift(mask)
    matrix = np.diag([-1.0, -1.0, 1.0, 1.0])
    matrix[:2, 3] = x, y
    return matrix


def _shift(mask: Mask) -> Point:
    """The sensor frame's origin in the drawing."""
    xs, ys = zip(*mask.registration, strict=True)
    return max(xs) + MARGIN_MM, max(ys) + MARGIN_MM


def _height(mask: Mask) -> float:
    ys = [y for _, y in mask.registration]
    return max(ys) - min(ys) + 2 * MARGIN_MM


def _at(point: Point, shift: Point) -> str:
    return f"{shift[0] - point[0]:.5f},{shift[1] - point[1]:.5f}"


def _d(paths: Iterable[Path], shift: Point) -> str:
    """Path data; one sub-path in each line."""
    lines = []
    for path in paths:
        words = [f"M{_at(path.start, shift)}"]
        for segment in path.segments:
            letter = "L" if len(segment) == 1 else "C"
            words.append(letter + " ".join(_at(point, shift) for point in segment))
        lines.append("".join(words) + "Z")
    return "\n".join(lines)


def _registration(point: Point, shift: Point) -> str:
    x, y = shift[0] - point[0], shift[1] - point[1]
    return (
        f'<circle cx="{x:.5f}" cy="{y:.5f}" r="1.2"/>'
        f'<path d="M{x - 2:.5f},{y:.5f}h4M{x:.5f},{y - 2:.5f}v4"/>'
    )


def _text(text: str, point: Point, shift: Point, size_mm: float, style: str) -> str:
    return (
        f'<text transform="translate({_at(point, shift)}) scale(-1,1)" '
        f'font-size="{size_mm:.3f}" {style}>{escape(text)}</text>'
    )


# Layer and its colour by AutoCAD's index.
LAYERS = {"CUT": 1, "FOLD": 5, "BLACK": 7, "APERTURES": 3, "WINDOW": 4, "BANDS": 8, "MARKS": 6}
MIRRORED_TEXT = 2  # flag of group 71


def dxf_drawing(artwork: Artwork, mask: Mask) -> bytes:
    """The bytes of the DXF.

    Args:
        artwork: what to draw.
        mask: for the apertures' form and the registration marks.
    """

    def draw(space: Modelspace) -> None:
        _film(space, artwork)
        _apertures(space, artwork, mask)
        _marks(space, artwork, mask)

    return dxf_file(LAYERS, draw)


def dxf_file(layers: Mapping[str, int], draw: Callable[[Modelspace], None]) -> bytes:
    """A drawing in mm with layers and their colours."""
    with _fixed_metadata():
        document = ezdxf.new("R2010", units=units.MM)
        for name, colour in layers.items():
            document.layers.add(name, color=colour)
        draw(document.modelspace())
        # ezdxf lists the classes in use in the order of a set of strings.
        document.classes.add_required_classes(document.dxfversion)
        document.classes.classes = dict(sorted(document.classes.classes.items()))
        stream = io.StringIO()
        document.write(stream)
    return stream.getvalue().encode()


def dxf_to_sensor() -> Matrix:
    """From the drawing to the sensor frame."""
    return np.diag([-1.0, 1.0, 1.0, 1.0])


CUT_LAYERS = {"CUT": 1, "HOLES": 3, "WINDOW": 4, "FOLD": 5}


def cut_drawing(artwork: Artwork, mask: Mask) -> bytes:
    """The bytes of the DXF for a plotter that cuts an opaque film: each layer is one tool.

    Args:
        artwork: what to cut; a hexagon is cut as the circle in it, because a dragged blade rounds
            such small corners.
        mask: for the diameter of the holes.
    """

    def draw(space: Modelspace) -> None:
        _closed(space, artwork.cut.corners, "CUT")
        _closed(space, artwork.window.corners, "WINDOW")
        for path, size_mm in zip(artwork.apertures, mask.holes_mm, strict=True):
            _circle(space, path, size_mm, "HOLES")
        for flap in artwork.flaps:
            _line(space, flap.fold, "FOLD")

    return dxf_file(CUT_LAYERS, draw)


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
        _line(space, flap.fold, "FOLD")
        _closed(space, flap.band, "BANDS")
    _closed(space, artwork.black.corners, "BLACK")
    _closed(space, artwork.window.corners, "WINDOW")


def _apertures(space: Modelspace, artwork: Artwork, mask: Mask) -> None:
    for path, size_mm in zip(artwork.apertures, mask.holes_mm, strict=True):
        if mask.hole_shape == "circle":
            _circle(space, path, size_mm, "APERTURES")
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
        space.add_text(text, height=height, dxfattribs=style).set_placement(
            _placed_at(point), align=align
        )


def _circle(space: Modelspace, path: Path, diameter_mm: float, layer: str) -> None:
    centre = tuple(np.mean(path.corners, axis=0).tolist())
    space.add_circle(_placed_at(centre), diameter_mm / 2, dxfattribs={"layer": layer})


def _line(space: Modelspace, ends: tuple[Point, Point], layer: str) -> None:
    start, end = map(_placed_at, ends)
    space.add_line(start, end, dxfattribs={"layer": layer})


def _closed(space: Modelspace, corners: tuple[Point, ...], layer: str) -> None:
    space.add_lwpolyline([_placed_at(p) for p in corners], close=True, dxfattribs={"layer": layer})


def _placed_at(point: Point) -> Point:
    """Mirrored as on the page, to a nanometre."""
    return round(-point[0], 6) + 0.0, round(point[1], 6)
