"""Damage the masks' pages, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import pikepdf
import pytest

from active_pages import ACTIVE, added
from damages import cut_short, failing, passing
from pages import Operation, page_damage, paths, registration, runs

pytestmark = pytest.mark.slow

A4, LETTER = "mask/emitter_mask_a4.pdf", "mask/emitter_mask_letter.pdf"
PAGE = {"page", "marks", "scale_x", "scale_y", "ruler", "mirrored", "fonts"}
BLACK = {"count", "position", "size", "shape", "web", "outline", "window", "clear"}
FLAPS = {"flaps", "folds", "reach", "bands", "numbers"}
DRAWN = {"svg", "dxf"}  # both are compared with the A4 page


def moved(
    which: int, by_mm: float, corners: slice = slice(None), axis: int = 0
) -> Callable[..., Any]:
    """Move a run of the black, or some corners of it, in the sensor frame."""

    def change(operations: list[Operation]) -> list[Operation]:
        first, last = list(runs(operations))[which]
        for operands, _ in operations[first:last][corners]:
            operands[axis] += Decimal(str(by_mm))
        return operations

    return change


def reshaped(turn: complex) -> Callable[..., Any]:
    """Turn and scale one aperture about its centre."""

    def change(operations: list[Operation]) -> list[Operation]:
        first, last = list(runs(operations))[10]
        points = [complex(*map(float, operands)) for operands, _ in operations[first:last]]
        centre = sum(points) / len(points)
        for (operands, _), point in zip(operations[first:last], points, strict=True):
            new = centre + (point - centre) * turn
            operands[:] = [Decimal(f"{new.real:.6f}"), Decimal(f"{new.imag:.6f}")]
        return operations

    return change


def removed(operations: list[Operation]) -> list[Operation]:
    first, last = list(runs(operations))[7]
    return operations[:first] + operations[last + 1 :]


def doubled(operations: list[Operation]) -> list[Operation]:
    first, last = list(runs(operations))[7]
    return operations[: last + 1] + operations[first:]


def without_window(operations: list[Operation]) -> list[Operation]:
    first, last = list(runs(operations))[1]
    return operations[:first] + operations[last + 1 :]


def scaled(across: float, up: float) -> Callable[..., Any]:
    """Scale the whole page, as a wrong print setting does."""

    def change(operations: list[Operation]) -> list[Operation]:
        scale = next(o for o, name in operations if name == "cm" and float(o[0]) > 2)
        scale[0], scale[3] = scale[0] * Decimal(str(across)), scale[3] * Decimal(str(up))
        return operations

    return change


def facing(across: int, up: int) -> Callable[..., Any]:
    """Set the directions of the artwork, which are -1 and 1."""

    def change(operations: list[Operation]) -> list[Operation]:
        matrix = next(o for o, name in operations if name == "cm" and float(o[0]) == -1)
        matrix[0], matrix[3] = Decimal(across), Decimal(up)
        return operations

    return change


def mark_removed(operations: list[Operation]) -> list[Operation]:
    first, last = registration(operations)
    return operations[:first] + operations[last + 1 :]


def mark_moved(operations: list[Operation]) -> list[Operation]:
    first, last = registration(operations)
    for operands, name in operations[first:last]:
        if name in "mlc":
            operands[::2] = [v + Decimal("0.025") for v in operands[::2]]
    return operations


def letter(operations: list[Operation]) -> tuple[int, int]:
    return next((a, b) for a, b in paths(operations) if b - a == 11 and operations[b][1] == "f")


def letter_removed(operations: list[Operation]) -> list[Operation]:
    first, last = letter(operations)
    return operations[:first] + operations[last + 1 :]


def letter_flipped(operations: list[Operation]) -> list[Operation]:
    """In its own place, so that only its shape tells."""
    first, last = letter(operations)
    corners = [o for o, name in operations[first:last] if name in "ml"]
    middle = min(o[0] for o in corners) + max(o[0] for o in corners)
    for operands in corners:
        operands[0] = middle - operands[0]
    return operations


def ruler_shortened(operations: list[Operation]) -> list[Operation]:
    first, last = next(
        (a, b) for a, b in paths(operations) if [n for _, n in operations[a:b]].count("m") > 100
    )
    for operands, _ in operations[first:last]:
        if float(operands[0]) == 100:
            operands[0] = Decimal("99.9")
    return operations


def bands(operations: list[Operation]) -> tuple[int, int]:
    return next(
        (a, b)
        for a, b in paths(operations)
        if [n for _, n in operations[a:b]].count("m") > 5 and operations[b][1] == "f"
    )


def bands_removed(operations: list[Operation]) -> list[Operation]:
    first, last = bands(operations)
    return operations[:first] + operations[last + 1 :]


def band_narrowed(operations: list[Operation]) -> list[Operation]:
    """A corner of the first band moved inward, across its flap."""
    first, _ = bands(operations)
    operations[first + 1][0][0] += Decimal("0.4")
    return operations


def band_lengthened(operations: list[Operation]) -> list[Operation]:
    """The black runs nearly to the end of the first flap."""
    first, _ = bands(operations)
    for at in (first + 1, first + 2):
        operations[at][0][1] -= Decimal("6.5")
    return operations


def folds(operations: list[Operation]) -> list[tuple[int, int]]:
    """The last single lines before the marks."""
    until = registration(operations)[0]
    return [(a, b) for a, b in paths(operations) if b - a == 2 and b < until]


def fold_moved(operations: list[Operation]) -> list[Operation]:
    first, _ = folds(operations)[3]
    for operands, _ in operations[first : first + 2]:
        operands[0] += Decimal("0.5")
    return operations


def fold_removed(operations: list[Operation]) -> list[Operation]:
    first, last = folds(operations)[3]
    return operations[:first] + operations[last + 1 :]


def numbers_exchanged(operations: list[Operation]) -> list[Operation]:
    told = [o for o, name in operations if name == "Tj" and bytes(o[0]) in (b"4", b"12")]
    told[0][0], told[1][0] = told[1][0], told[0][0]
    return operations


def speck_added(operations: list[Operation]) -> list[Operation]:
    at = next(i for i, (_, name) in enumerate(operations) if name == "f*") + 1
    x, y = (Decimal(v) for v in ("15.3", "12.0"))  # in the first aperture
    half = Decimal("0.2")
    return [*operations[:at], ([x, y, half, half], "re"), ([], "f"), *operations[at:]]


def text_moved(operations: list[Operation]) -> list[Operation]:
    matrix = next(o for o, name in reversed(operations) if name == "Tm")
    matrix[4] -= 60
    return operations


def picture_added(operations: list[Operation]) -> list[Operation]:
    return [([pikepdf.Name("/Im0")], "Do"), *operations]


def truncated(file: str) -> Callable[[Path], None]:
    return lambda out: cut_short(out / file)


def papers_swapped(out: Path) -> None:
    shutil.copy(out / A4, out / LETTER)


def fingers_swapped(out: Path) -> None:
    shutil.copy(out / A4.replace("emitter", "receiver"), out / A4)


def font_left_out(file: str) -> Callable[[Path], None]:
    """The page names a font and does not bring it, as of a file that was made smaller."""

    def change(out: Path) -> None:
        with pikepdf.open(out / file, allow_overwriting_input=True) as pdf:
            font = next(iter(pdf.pages[0].resources.Font.values()))
            del font["/FontDescriptor"]
            pdf.save(out / file)

    return change


SIXTH_OF_A_TURN = 3**0.5 / 2 + 0.5j  # half of one: 30°

DAMAGES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "hole moved 0.05 mm": (page_damage(A4, moved(9, 0.05)), {"position", "facing", *DRAWN}),
    "hole moved on letter": (page_damage(LETTER, moved(9, 0.05)), {"position", "facing"}),
    "hole moved 0.013 mm": (page_damage(LETTER, moved(9, 0.013)), {"position"}),
    "hole dented": (
        page_damage(LETTER, moved(9, 0.1, slice(0, 1))),
        {"position", "size", "shape"},
    ),
    "hole enlarged": (page_damage(A4, reshaped(1.02 + 0j)), {"size", *DRAWN}),
    "hole turned": (page_damage(LETTER, reshaped(SIXTH_OF_A_TURN)), {"shape"}),
    "hole removed": (
        page_damage(A4, removed),
        {"count", "position", "facing", *DRAWN},
    ),
    "hole doubled": (page_damage(A4, doubled), {"count", "web", *DRAWN}),
    "holes touch": (
        page_damage(LETTER, moved(9, 3.3, axis=1)),
        {"position", "facing", "web"},
    ),
    "not mirrored": (page_damage(LETTER, facing(1, 1)), {"mirrored"}),
    "half a turn": (
        page_damage(LETTER, facing(1, -1)),
        {"mirrored", "position", "facing", "outline", "window", "folds", "bands", "numbers"},
    ),
    "letter removed": (page_damage(LETTER, letter_removed), {"mirrored"}),
    "letter flipped": (page_damage(LETTER, letter_flipped), {"mirrored"}),
    "page scaled 0.5 %": (page_damage(LETTER, scaled(1.005, 1.005)), {"scale_x", "scale_y"}),
    "page widened 0.2 %": (page_damage(A4, scaled(1.002, 1)), {"scale_x"}),
    "page lengthened 0.2 %": (page_damage(A4, scaled(1, 1.002)), {"scale_y"}),
    "mark removed": (page_damage(LETTER, mark_removed), {*PAGE, *BLACK, *FLAPS, "facing"}),
    "mark moved": (page_damage(LETTER, mark_moved), {"marks"}),
    "ruler shortened": (page_damage(LETTER, ruler_shortened), {"ruler"}),
    "edge moved": (
        page_damage(A4, moved(0, 0.3, slice(40, 41))),
        {"outline", "folds", *DRAWN},
    ),
    "window moved": (page_damage(A4, moved(1, 0.2)), {"window", *DRAWN}),
    "window missing": (page_damage(LETTER, without_window), {"window"}),
    "speck in a hole": (page_damage(LETTER, speck_added), {"clear"}),
    "bands missing": (page_damage(LETTER, bands_removed), {"bands"}),
    "band narrowed": (page_damage(A4, band_narrowed), {"bands", *DRAWN}),
    "band over the glue": (page_damage(LETTER, band_lengthened), {"bands"}),
    "fold moved": (page_damage(LETTER, fold_moved), FLAPS),
    "fold missing": (page_damage(LETTER, fold_removed), {"folds", "numbers"}),
    "numbers exchanged": (page_damage(LETTER, numbers_exchanged), {"numbers"}),
    "text off the page": (page_damage(LETTER, text_moved), {"page"}),
    "picture added": (page_damage(LETTER, picture_added), {*PAGE, *BLACK, *FLAPS, "facing"}),
    "letter is A4": (papers_swapped, {"page"}),
    "other finger's": (fingers_swapped, {"window", "note", *DRAWN}),
    "page truncated": (truncated(A4), {*PAGE, *BLACK, *FLAPS, "note", "facing", *DRAWN}),
    "font left out": (font_left_out(LETTER), {"fonts"}),
    **{a.__name__: (added(LETTER, a), {*PAGE, *BLACK, *FLAPS, "facing"}) for a in ACTIVE},
    "page missing": (lambda out: (out / LETTER).unlink(), {*PAGE, *BLACK, *FLAPS, "facing"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = DAMAGES[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask") == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    names = passing(masks, "mask", lambda file: ".pdf" in file)
    assert names <= set().union(*(expected for _, expected in DAMAGES.values()))
