"""PDF: what a page paints, its boxes and its order, changed so that its pixels differ."""

import io
from collections.abc import Callable
from decimal import Decimal

import numpy as np
import pikepdf
import pypdfium2
from numpy.random import Generator
from numpy.typing import NDArray
from pikepdf import Array, Dictionary, Name, Operator, Pdf

from mutations.amounts import changed, cut_short
from mutations.damage import Mutator, Mutators, NotApplicableError

_PIXELS_PER_POINT = 200 / 72
_DARKER = 60  # of 255
_DARK, _LIGHT = 80, 200
_LEAST_PIXELS = 20  # 0.3 mm²
_MM = 72 / 25.4
_PLACED = frozenset({"m", "l", "re", "c", "cm", "w", "Tm", "Td", "Tf", "g", "rg"})
_PAINTS = frozenset({"f", "f*", "S", "s", "B", "B*", "b", "b*"})
_MOST_PIXELS = 1e8
PageDamage = Callable[[Pdf, pikepdf.Page, Generator], str]
"""Changes a page of an open file, and says how."""


def painted(data: bytes, page: int) -> NDArray[np.uint8]:
    """The grey pixels of a page, as a printer would paint it."""
    document = pypdfium2.PdfDocument(data)
    try:
        sheet = document[page]
        if np.prod(sheet.get_size()) * _PIXELS_PER_POINT**2 > _MOST_PIXELS:
            return np.zeros((1, 1), np.uint8)
        return np.array(sheet.render(scale=_PIXELS_PER_POINT, grayscale=True).to_numpy())
    finally:
        document.close()


def looks_alike(one: bytes, other: bytes, page: int) -> bool:
    """Whether fewer pixels of a page differ than a reader would see."""
    before, after = (np.int16(painted(data, page)) for data in (one, other))
    if before.shape != after.shape:
        return False
    return bool(np.count_nonzero(np.abs(before - after) > _DARKER) < _LEAST_PIXELS)


def on_a_page(damage: PageDamage) -> Mutator:
    """A page's damage as a mutator: of a page drawn at random, if its pixels differ after it."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        with Pdf.open(io.BytesIO(data)) as pdf:
            number = int(rng.integers(len(pdf.pages)))
            done = damage(pdf, pdf.pages[number], rng)
            new = _saved(pdf)
        if looks_alike(data, new, number):
            raise NotApplicableError
        return new, f"page {number + 1}: {done}"

    return mutate


def _saved(pdf: Pdf) -> bytes:
    target = io.BytesIO()
    pdf.save(target, deterministic_id=True)
    return target.getvalue()


def _put(pdf: Pdf, page: pikepdf.Page, steps: list[object]) -> None:
    page.Contents = pdf.make_stream(pikepdf.unparse_content_stream(steps))


def _number(pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    steps = list(pikepdf.parse_content_stream(page))
    names = sorted({str(s.operator) for s in steps} & _PLACED)
    if not names:
        raise NotApplicableError
    name = names[int(rng.integers(len(names)))]
    places = [i for i, s in enumerate(steps) if str(s.operator) == name]
    place = places[int(rng.integers(len(places)))]
    operands = list(steps[place].operands)
    numbers = [i for i, o in enumerate(operands) if isinstance(o, int | float | Decimal)]
    at = numbers[int(rng.integers(len(numbers)))]
    old = operands[at]
    operands[at] = Decimal(changed(f"{float(old):.5f}", rng, 0.25))
    steps[place] = pikepdf.ContentStreamInstruction(operands, Operator(name))
    _put(pdf, page, steps)
    return f"step {place}, {name}: {old} becomes {operands[at]}"


def _block(steps: list[object], rng: Generator) -> tuple[int, int]:
    """First and last step of a block q … Q or BT … ET, or of one path."""
    blocks, opened, path = [], [], 0
    for i, step in enumerate(steps):
        name = str(step.operator)  # type: ignore[attr-defined]
        if name in {"q", "BT"}:
            opened.append(i)
        elif name in {"Q", "ET"} and opened:
            blocks.append((opened.pop(), i))
        elif name in _PAINTS:
            blocks.append((path + 1, i))
        if name not in {"m", "l", "c", "re", "h"}:
            path = i
    if not blocks:
        raise NotApplicableError
    return blocks[int(rng.integers(len(blocks)))]


def _removed(pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    steps = list(pikepdf.parse_content_stream(page))
    first, last = _block(steps, rng)
    _put(pdf, page, steps[:first] + steps[last + 1 :])
    return f"steps {first} to {last} are gone"


def _doubled(pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """A block once more, some mm beside the first."""
    steps = list(pikepdf.parse_content_stream(page))
    first, last = _block(steps, rng)
    by = [Decimal(str(round(float(v), 2))) for v in rng.uniform(1, 8, 2)]
    shift = pikepdf.ContentStreamInstruction([1, 0, 0, 1, *by], Operator("cm"))
    start, end = (pikepdf.ContentStreamInstruction([], Operator(o)) for o in "qQ")
    again = [start, shift, *steps[first : last + 1], end]
    _put(pdf, page, steps[: last + 1] + again + steps[last + 1 :])
    return f"steps {first} to {last} once more, beside"


def _spot(pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """A white or black square of 0.7 to 5 mm over what is there."""
    pixels = painted(_saved(pdf), pdf.pages.index(page))
    grey = int(rng.integers(2))
    rows, columns = np.nonzero(pixels < _DARK if grey else pixels > _LIGHT)
    if not len(rows):
        raise NotApplicableError
    at = int(rng.integers(len(rows)))
    size = float(rng.uniform(0.7, 5)) * _MM
    x = float(columns[at]) / _PIXELS_PER_POINT - size / 2
    y = (pixels.shape[0] - float(rows[at])) / _PIXELS_PER_POINT - size / 2
    page.contents_add(b"q", prepend=True)
    page.contents_add(f"Q {grey} g {x:.2f} {y:.2f} {size:.2f} {size:.2f} re f".encode())
    colour = ("black", "white")[grey]
    return f"a {colour} square of {size / _MM:.2f} mm at {x / _MM:.1f}, {y / _MM:.1f} mm"


def _transparent(_pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """All that is painted lets light through, by a graphics state."""
    alpha = round(float(rng.uniform(0.2, 0.7)), 2)
    page.add_resource(Dictionary(ca=alpha, CA=alpha), Name.ExtGState, Name.Fade)
    page.contents_add(b"/Fade gs", prepend=True)
    return f"all is painted with {alpha:g} of its darkness"


def _placed(_pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """The whole page scaled, mirrored or moved by a matrix."""
    wide, high = float(page.mediabox[2]), float(page.mediabox[3])
    by, move = float(rng.uniform(1.02, 1.2)), float(rng.uniform(3, 30))
    matrix = (
        (by, 0, 0, 1, 0, 0),
        (1, 0, 0, by, 0, 0),
        (by, 0, 0, by, 0, 0),
        (-1, 0, 0, 1, wide, 0),
        (1, 0, 0, -1, 0, high),
        (1, 0, 0, 1, move, 0),
        (1, 0, 0, 1, 0, move),
    )[int(rng.integers(7))]
    words = " ".join(f"{v:g}" for v in matrix)
    page.contents_add(f"{words} cm".encode(), prepend=True)
    return f"all is transformed by {words}"


def _boxed(_pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """Another size, corner, crop, direction or unit of the page."""
    box = [float(v) for v in page.mediabox]
    off = float(rng.uniform(0.05, 0.3))
    how = int(rng.integers(4))
    if how == 0:
        box[int(rng.integers(4))] += off * box[2] * float(rng.choice([-1, 1]))
        page.MediaBox = Array([round(v, 2) for v in box])
        return f"MediaBox {box}"
    if how == 1:
        crop = [box[2] * off, box[3] * off, box[2] * (1 - off), box[3] * (1 - off)]
        page.CropBox = Array([round(v, 2) for v in crop])
        return f"CropBox {crop}"
    if how == 2:
        page.Rotate = int(rng.choice([90, 180, 270]))
        return f"Rotate {page.Rotate}"
    page.UserUnit = round(1 + off, 2)
    return f"UserUnit {page.UserUnit}"


def _word(pdf: Pdf, page: pikepdf.Page, rng: Generator) -> str:
    """A text with some of its letters changed."""
    steps = list(pikepdf.parse_content_stream(page))
    texts = [
        i for i, s in enumerate(steps) if str(s.operator) == "Tj" and len(bytes(s.operands[0])) > 2
    ]
    if not texts:
        raise NotApplicableError
    place = texts[int(rng.integers(len(texts)))]
    old = bytes(steps[place].operands[0])
    new = old[::-1]
    steps[place] = pikepdf.ContentStreamInstruction([pikepdf.String(new)], Operator("Tj"))
    _put(pdf, page, steps)
    return f"{old!r} is written backwards"


def _pages(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A page removed, repeated, or in the place of another."""
    with Pdf.open(io.BytesIO(data)) as pdf:
        count = len(pdf.pages)
        one, other = int(rng.integers(count)), int(rng.integers(count))
        how = int(rng.integers(3))
        if how == 0 and count > 1:
            del pdf.pages[one]
            done = f"page {one + 1} of {count} is gone"
        elif how == 1 and one != other:
            pdf.pages[one], pdf.pages[other] = pdf.pages[other], pdf.pages[one]
            done = f"pages {one + 1} and {other + 1} of {count} are swapped"
        else:
            pdf.pages.insert(one, pdf.pages[other])
            done = f"page {other + 1} of {count} is there twice"
        return _saved(pdf), done


def _emptied(pdf: Pdf, page: pikepdf.Page, _rng: Generator) -> str:
    page.Contents = pdf.make_stream(b"")
    return "nothing is painted"


PDF: Mutators = {
    "number": on_a_page(_number),
    "word": on_a_page(_word),
    "remove": on_a_page(_removed),
    "duplicate": on_a_page(_doubled),
    "paint over": on_a_page(_spot),
    "transparent": on_a_page(_transparent),
    "transform": on_a_page(_placed),
    "page box": on_a_page(_boxed),
    "empty": on_a_page(_emptied),
    "pages": _pages,
    "truncate": cut_short,
}
