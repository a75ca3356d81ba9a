"""SVG and DXF: elements and the whole changed, so that what is drawn differs."""

import io
import re
from collections.abc import Callable
from copy import deepcopy
from xml.etree import ElementTree

import ezdxf
import numpy as np
from ezdxf.document import Drawing
from ezdxf.path import make_path
from numpy.random import Generator
from numpy.typing import NDArray
from reportlab.graphics import renderPDF
from scipy.spatial import cKDTree
from svglib.svglib import svg2rlg

from mutations.amounts import NUMBER, changed, cut_short, distance_mm, factor
from mutations.damage import Mutator, Mutators, NotApplicableError
from mutations.pages import looks_alike

_SVG = "{http://www.w3.org/2000/svg}"
_SHAPES = frozenset(
    {"path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "text", "use"}
)
_PLACES = re.compile(r"d|[xy][12]?|c[xy]|r[xy]?|width|height|points|transform|viewBox")
"""Attributes that place a shape."""
Root = ElementTree.Element
ElementTree.register_namespace("", _SVG[1:-1])
SvgDamage = Callable[[Root, Generator], str]


def _page(data: bytes) -> bytes | None:
    """The drawing as a PDF; none where it cannot be drawn."""
    drawing = svg2rlg(io.BytesIO(data))
    return None if drawing is None else bytes(renderPDF.drawToString(drawing))


def on_svg(damage: SvgDamage, seen: bool = True) -> Mutator:
    """A damage of a drawing as a mutator; if it is to be seen, only if pixels differ after it."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        root = ElementTree.fromstring(data)
        done = damage(root, rng)
        new = ElementTree.tostring(root)
        if seen and _same(data, new):
            raise NotApplicableError
        return new, done

    return mutate


def _same(before: bytes, after: bytes) -> bool:
    try:
        pages = _page(before), _page(after)
        return None not in pages and looks_alike(pages[0] or b"", pages[1] or b"", 0)
    except Exception:  # noqa: BLE001 - whatever it is, a drawing that cannot be drawn differs
        return False


def _shapes(root: Root) -> list[Root]:
    """Elements that draw; each tag's are reached as often as another's by `_drawn`."""
    defs = {e for d in root.iter(f"{_SVG}defs") for e in d.iter()}
    return [e for e in root.iter() if _tag(e) in _SHAPES and e not in defs]


def _tag(element: Root) -> str:
    return str(element.tag).removeprefix(_SVG)


def _drawn(elements: list[Root], rng: Generator) -> Root:
    tags = sorted({_tag(e) for e in elements})
    if not tags:
        raise NotApplicableError
    tag = tags[int(rng.integers(len(tags)))]
    alike = [e for e in elements if _tag(e) == tag]
    return alike[int(rng.integers(len(alike)))]


def _named(element: Root) -> str:
    return f"<{_tag(element)} {' '.join(f'{k}={v!r:.60}' for k, v in element.items())}>"


def _number(root: Root, rng: Generator) -> str:
    element = _drawn([*_shapes(root), root], rng)
    keys = sorted(k for k, v in element.items() if _PLACES.fullmatch(k) and NUMBER.search(v))
    if not keys:
        raise NotApplicableError
    key = keys[int(rng.integers(len(keys)))]
    numbers = list(NUMBER_IN_PATH.finditer(element.attrib[key]))
    match = numbers[int(rng.integers(len(numbers)))]
    new = changed(match[0] if "." in match[0] else f"{match[0]}.0", rng, 0.3)
    before = _named(element)
    element.set(
        key, element.attrib[key][: match.start()] + new + element.attrib[key][match.end() :]
    )
    return f"{key}: {match[0]} becomes {new} in {before}"


NUMBER_IN_PATH = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)")


def _removed(root: Root, rng: Generator) -> str:
    element = _drawn([*_shapes(root), *root.iter(f"{_SVG}g")], rng)
    next(e for e in root.iter() if element in list(e)).remove(element)
    return f"gone: {_named(element)}"


def _doubled(root: Root, rng: Generator) -> str:
    element = _drawn(_shapes(root), rng)
    copy = deepcopy(element)
    by = rng.uniform(1, 6, 2)
    copy.set("transform", f"translate({by[0]:.2f} {by[1]:.2f}) {copy.get('transform', '')}".strip())
    parent = next(e for e in root.iter() if element in list(e))
    parent.insert(list(parent).index(element) + 1, copy)
    return f"once more, moved by {by[0]:.2f}, {by[1]:.2f}: {_named(element)}"


def _word(root: Root, rng: Generator) -> str:
    """A text with a number changed, or written backwards."""
    texts = [e for e in root.iter() if _tag(e) in {"text", "tspan"} and (e.text or "").strip()]
    if not texts:
        raise NotApplicableError
    element = texts[int(rng.integers(len(texts)))]
    old = element.text or ""
    number = NUMBER.search(old)
    new = (
        old[: number.start()] + changed(number[0], rng) + old[number.end() :]
        if number
        else old[::-1]
    )
    if new == old:
        raise NotApplicableError
    element.text = new
    return f"text {old!r} becomes {new!r}"


def _covered(root: Root, rng: Generator) -> str:
    """A white or black rectangle over a part of the drawing."""
    x, y, wide, high = (float(v) for v in root.attrib["viewBox"].split())
    size = rng.uniform(0.04, 0.4, 2) * (wide, high)
    place = np.array([x, y]) + rng.uniform(0, 1, 2) * ((wide, high) - size)
    colour = ("#fff", "#000")[int(rng.integers(2))]
    cover = {"x": place[0], "y": place[1], "width": size[0], "height": size[1]}
    root.append(
        ElementTree.Element(
            f"{_SVG}rect", {k: f"{v:.2f}" for k, v in cover.items()} | {"fill": colour}
        )
    )
    return f"{size[0]:.1f} x {size[1]:.1f} covered in {colour} at {place[0]:.1f}, {place[1]:.1f}"


def _whole(root: Root, rng: Generator) -> str:
    """All elements in a group that is mirrored, scaled or moved."""
    x, y, wide, high = (float(v) for v in root.attrib["viewBox"].split())
    by, move = factor(rng), distance_mm(rng)
    how = (
        f"translate({2 * x + wide:.3f} 0) scale(-1 1)",
        f"translate(0 {2 * y + high:.3f}) scale(1 -1)",
        f"scale({by:g})",
        f"scale({by:g} 1)",
        f"translate({move:g} 0)",
        f"translate(0 {move:g})",
    )[int(rng.integers(6))]
    group = ElementTree.Element(f"{_SVG}g", {"transform": how})
    group.extend(list(root))
    root[:] = [group]
    return f"all in a group with {how}"


def _size(root: Root, rng: Generator) -> str:
    """Another unit or size of the whole drawing, or another part of the plane."""
    how = int(rng.integers(3))
    by = factor(rng)
    if how == 0:
        for key in ("width", "height"):
            root.set(key, root.attrib[key].replace("mm", ("in", "px", "cm")[int(by * 1000) % 3]))
    elif how == 1:
        for key in ("width", "height"):
            root.set(key, f"{float(root.attrib[key].removesuffix('mm')) * by:.2f}mm")
    else:
        box = [float(v) for v in root.attrib["viewBox"].split()]
        box[0] += 0.1 * box[2]
        root.set("viewBox", " ".join(f"{v:g}" for v in box))
    return f"size {root.get('width')} x {root.get('height')}, viewBox {root.get('viewBox')}"


SVG: Mutators = {
    "number": on_svg(_number),
    "remove": on_svg(_removed),
    "duplicate": on_svg(_doubled),
    "word": on_svg(_word),
    "paint over": on_svg(_covered),
    "transform": on_svg(_whole),
    "unit": on_svg(_size, seen=False),
    "truncate": cut_short,
}
_CHORD_MM, _ALIKE_MM = 0.01, 0.2
DxfDamage = Callable[[Drawing, Generator], str]


def on_dxf(damage: DxfDamage) -> Mutator:
    """A damage of an open DXF as a mutator."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        drawing = ezdxf.read(io.StringIO(data.decode()))
        before = _points(drawing)
        done = damage(drawing, rng)
        if damage is _dxf_whole and _alike(before, _points(drawing)):
            raise NotApplicableError
        ezdxf.options.write_fixed_meta_data_for_testing = True  # no date, no new GUID
        target = io.StringIO()
        drawing.write(target)
        return target.getvalue().encode(), done

    return mutate


def _points(drawing: Drawing) -> NDArray[np.float64]:
    """Points of all lines, shape (n, 2), mm; a chord is at most 0.01 mm off its arc."""
    paths = (make_path(e) for e in drawing.modelspace() if e.dxftype() not in {"TEXT", "MTEXT"})
    return np.array([(p.x, p.y) for path in paths for p in path.flattening(_CHORD_MM)])


def _alike(before: NDArray[np.float64], after: NDArray[np.float64]) -> bool:
    """Whether a mirrored drawing looks the same."""
    return bool(cKDTree(before).query(after)[0].max() < _ALIKE_MM)


def _entity(drawing: Drawing, rng: Generator) -> "ezdxf.entities.DXFGraphic":
    entities = list(drawing.modelspace())
    return entities[int(rng.integers(len(entities)))]


def _dxf_moved(drawing: Drawing, rng: Generator) -> str:
    entity, by = _entity(drawing, rng), rng.uniform(0.3, 3, 2) * rng.choice([-1, 1], 2)
    entity.translate(*by, 0)
    return f"{entity} moved by {by[0]:.2f}, {by[1]:.2f}"


def _dxf_removed(drawing: Drawing, rng: Generator) -> str:
    entity = _entity(drawing, rng)
    drawing.modelspace().delete_entity(entity)
    return "an entity is gone"


def _dxf_doubled(drawing: Drawing, rng: Generator) -> str:
    entity = _entity(drawing, rng)
    copy = entity.copy()
    drawing.modelspace().add_entity(copy)
    copy.translate(*rng.uniform(0.5, 5, 2), 0)
    return f"{entity} once more, beside"


def _dxf_whole(drawing: Drawing, rng: Generator) -> str:
    by, move, how = factor(rng), distance_mm(rng), int(rng.integers(4))
    for entity in drawing.modelspace():
        if how < 2:
            entity.scale(*((by, by), (-1, 1))[how], 1)
        else:
            entity.translate(*((move, 0), (0, move))[how - 2], 0)
    return (
        f"all scaled by {by:g}",
        "all mirrored",
        f"all moved by {move:g} in x",
        f"all moved by {move:g} in y",
    )[how]


def _dxf_unit(drawing: Drawing, rng: Generator) -> str:
    drawing.header["$INSUNITS"] = int(rng.choice([1, 2, 5, 6]))
    return f"$INSUNITS {drawing.header['$INSUNITS']}"


def _dxf_layer(drawing: Drawing, rng: Generator) -> str:
    """An entity on another layer: what is cut is creased."""
    entity = _entity(drawing, rng)
    others = sorted({e.dxf.layer for e in drawing.modelspace()} - {entity.dxf.layer})
    if not others:
        raise NotApplicableError
    old, entity.dxf.layer = entity.dxf.layer, others[int(rng.integers(len(others)))]
    return f"{entity} of layer {old} is on {entity.dxf.layer}"


DXF: Mutators = {
    "move a part": on_dxf(_dxf_moved),
    "remove": on_dxf(_dxf_removed),
    "duplicate": on_dxf(_dxf_doubled),
    "transform": on_dxf(_dxf_whole),
    "unit": on_dxf(_dxf_unit),
    "layer": on_dxf(_dxf_layer),
    "truncate": cut_short,
}
