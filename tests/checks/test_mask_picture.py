"""Damage what a mask's file shows, and exactly the right checks of its picture fail."""

import subprocess
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

import numpy as np
import pikepdf
import pytest
from pikepdf import Array, Dictionary, Name
from PIL import Image

from damages import cut_short, failing, passing
from finger_notes import written_masks
from lumitip_fab.checks import mask_picture
from lumitip_fab.checks.readers.pixels import DPI, Picture
from lumitip_fab.config.load import load
from pages import Operation, page_damage, paths, registration, runs
from programs import needs

pytestmark = pytest.mark.slow

A4, COUPON = "mask/emitter_mask_a4.pdf", "mask/coupon_letter.pdf"
Damage = Callable[[Path], None]
APERTURES = {"position", "size"}
UNPLACED = {"page", "figures", "ruler", "readable"}
"""Checks that fail where marks and rulers are not where they should be."""


def changed(change: Callable[[pikepdf.Pdf, pikepdf.Page], None], file: str = A4) -> Damage:
    """Change the page of a file beside its operators."""

    def damage(out: Path) -> None:
        with pikepdf.open(out / file, allow_overwriting_input=True) as pdf:
            change(pdf, pdf.pages[0])
            pdf.save(out / file)

    return damage


def entry(name: str, value: object) -> Damage:
    return changed(lambda _, page: page.obj.__setitem__(name, value))


def inserted(*more: Operation) -> Callable[[list[Operation]], list[Operation]]:
    """Operators over the black, its bands and its folds, in the sensor frame."""

    def change(operations: list[Operation]) -> list[Operation]:
        at, _ = registration(operations)
        return [*operations[:at], *more, *operations[at:]]

    return change


def white_dot(x: float, y: float) -> Damage:
    box = [Decimal(str(v)) for v in (x, y, 0.1, 0.1)]
    dot: tuple[Operation, ...] = (([Decimal(1)], "g"), (box, "re"), ([], "f"), ([Decimal(0)], "g"))
    return page_damage(A4, inserted(*dot))


def without_run(which: int) -> Damage:
    """Edge, window, then the apertures."""

    def change(operations: list[Operation]) -> list[Operation]:
        first, last = list(runs(operations))[which]
        return operations[:first] + operations[last + 1 :]

    return page_damage(A4, change)


def half_transparent(pdf: pikepdf.Pdf, page: pikepdf.Page) -> None:
    page.resources["/ExtGState"] = Dictionary(Half=Dictionary(Type=Name.ExtGState, ca=0.5))
    page.contents_add(pdf.make_stream(b"/Half gs\n"), prepend=True)


def layered(**state: object) -> Damage:
    """All on a layer, which a printer or a screen leaves out."""

    def change(pdf: pikepdf.Pdf, page: pikepdf.Page) -> None:
        layer = pdf.make_indirect(Dictionary(Type=Name.OCG, Name="Layer", **state))
        page.resources["/Properties"] = Dictionary(Layer=layer)
        page.contents_add(pdf.make_stream(b"/OC /Layer BDC\n"), prepend=True)
        page.contents_add(pdf.make_stream(b"\nEMC"))
        usage = Dictionary(Event=Name.Print, OCGs=Array([layer]), Category=Array([Name.Print]))
        off = Array([]) if state else Array([layer])
        shown = Dictionary(OFF=off, Order=Array([layer]), AS=Array([usage]))
        pdf.Root.OCProperties = Dictionary(OCGs=Array([layer]), D=shown)

    return changed(change)


def annotated(grey: int, flags: int) -> Damage:
    """A block over some apertures."""

    def change(pdf: pikepdf.Pdf, page: pikepdf.Page) -> None:
        low, high = [270, 420], [320, 480]
        look = pdf.make_stream(b"%d g 0 0 50 60 re f" % grey)
        look.stream_dict = Dictionary(Type=Name.XObject, Subtype=Name.Form, BBox=[0, 0, 50, 60])
        note = Dictionary(Type=Name.Annot, Subtype=Name.Square, Rect=[*low, *high], F=flags)
        note.AP = Dictionary(N=look)
        page.obj.Annots = Array([pdf.make_indirect(note)])

    return changed(change)


def cropped(_: pikepdf.Pdf, page: pikepdf.Page) -> None:
    page.cropbox = [100, 200, 500, 700]


def ruler_of(length_mm: float) -> Damage:
    def change(operations: list[Operation]) -> list[Operation]:
        first, last = next(
            (a, b) for a, b in paths(operations) if [n for _, n in operations[a:b]].count("m") > 100
        )
        for operands, _ in operations[first:last]:
            operands[0] = operands[0] * Decimal(str(length_mm / 100))
        return operations

    return page_damage(A4, change)


def figure_exchanged(operations: list[Operation]) -> list[Operation]:
    (last, *_) = (o for o, name in operations if name == "Tj" and bytes(o[0]) == b"100")
    last[0] = pikepdf.String("110")
    return operations


def mirrored(operations: list[Operation]) -> list[Operation]:
    matrix = next(o for o, name in operations if name == "cm" and float(o[0]) == -1)
    matrix[0] = Decimal(1)
    return operations


def moved(operations: list[Operation]) -> list[Operation]:
    first, last = list(runs(operations))[9]
    for operands, _ in operations[first:last]:
        operands[0] += Decimal("0.03")
    return operations


def stretched(by: float) -> Damage:
    """The whole page, as a wrong print setting does."""

    def change(operations: list[Operation]) -> list[Operation]:
        scale = next(o for o, name in operations if name == "cm" and float(o[0]) > 2)
        scale[0], scale[3] = (Decimal(str(float(v) * by)) for v in (scale[0], scale[3]))
        return operations

    return page_damage(A4, change)


def mark_moved(operations: list[Operation]) -> list[Operation]:
    """A mark's ring and its cross, by 0.02 mm."""
    first, _ = registration(operations)
    last = [at for at, (_, name) in enumerate(operations) if at > first and name == "S"][2]
    for operands, name in operations[first:last]:
        if name in "mlc":
            operands[::2] = [v + Decimal("0.02") for v in operands[::2]]
    return operations


def doubled(pdf: pikepdf.Pdf, page: pikepdf.Page) -> None:
    pdf.pages.append(page)


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "white dot": (white_dot(0.0, 1.5), {"black"}),
    "white dot on the edge's folds": (white_dot(1.0, 22.3), {"black"}),
    "half transparent": (changed(half_transparent), {"black", *APERTURES}),
    "hidden layer": (layered(), {"readable", "ruler"}),
    "layer for the screen": (
        layered(Usage=Dictionary(Print=Dictionary(PrintState=Name.OFF))),
        {"printed", "readable", "ruler"},
    ),
    "user unit": (entry("/UserUnit", 1.1), UNPLACED),
    "cropped": (changed(cropped), {"figures", "page"}),
    "turned": (entry("/Rotate", 90), UNPLACED - {"ruler"}),
    "upside down": (entry("/Rotate", 180), {"black", "figures", "mirrored", "open", *APERTURES}),
    "window filled": (without_run(1), {"open"}),
    "aperture filled": (without_run(9), {"open", *APERTURES}),
    "aperture moved": (page_damage(A4, moved), {"position"}),
    "annotation covers apertures": (annotated(0, 4), {"open", *APERTURES}),
    "annotation bleaches": (annotated(1, 4), {"black", *APERTURES}),
    "annotation on the screen alone": (annotated(1, 0), {"printed"}),
    "ruler of 110": (ruler_of(110), {"ruler"}),
    "ruler of 100.2": (ruler_of(100.2), {"ruler"}),
    "ruler's figure": (page_damage(A4, figure_exchanged), {"figures"}),
    "not mirrored": (page_damage(A4, mirrored), {"mirrored"}),
    "stretched": (stretched(1.003), {"scale_x", "scale_y", "ruler"}),
    "mark moved": (page_damage(A4, mark_moved), {"marks"}),
    "two pages": (changed(doubled), {"readable"}),
    "cut short": (lambda out: cut_short(out / A4), {"readable"}),
    "missing": (lambda out: (out / A4).unlink(), {"readable"}),
    "huge": (entry("/MediaBox", [0, 0, 99999, 99999]), {"readable"}),
    "coupon of half black": (changed(half_transparent, COUPON), {"black", "coupon"}),
    "coupon missing": (lambda out: (out / COUPON).unlink(), {"readable"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = DAMAGES[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask_picture") == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    names = passing(masks, "mask_picture", lambda _: True)
    assert names <= set().union(*(expected for _, expected in DAMAGES.values()))


@needs("pdftoppm")
@pytest.mark.parametrize("preset", ["published", "flex", "dense"])
def test_another_renderer_sees_the_same(
    preset: str, design_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both see each aperture within 0.01 mm of its cell, so within 0.02 mm of each other."""

    def drawn(path: Path) -> tuple[Picture, Picture]:
        picture, _ = page_pictures(path)
        command = ["pdftoppm", "-r", str(DPI), "-gray", "-singlefile", path, tmp_path / "page"]
        subprocess.run(command, check=True)
        grey = np.asarray(Image.open(tmp_path / "page.pgm"))
        pixel_mm = picture.size_mm / grey.shape[::-1]
        other = Picture(grey, pixel_mm, picture.corner_mm, picture.words)
        return other, other

    page_pictures = mask_picture.page_pictures
    out = written_masks(load(design_dir / "presets" / f"{preset}.toml"), tmp_path / "out")
    monkeypatch.setattr(mask_picture, "page_pictures", drawn)
    assert failing(out, "mask_picture") == set()


FAR: dict[str, dict[str, object]] = {
    "measured rulers": {"mask.measured_ruler_mm": (97.0, 103.0)},
    "cut": {"mask.film": "TPU black 100um", "mask.route": "cut"},
    "few cells": {"grid.columns": (1,) * 8},
    "wide": {"grid.pitch_mm": 10.0, "stack.floor_mm": 2.5},
    "small holes": {"mask.hole_mm": 1.0, "mask.hole_shape": "circle"},
    "no allowance": {"mask.allowance_mm": 0.0},
}


@pytest.mark.parametrize("name", FAR)
@pytest.mark.parametrize("preset", ["published", "flex"])
def test_other_designs_pass(preset: str, name: str, design_dir: Path, tmp_path: Path) -> None:
    config = load(design_dir / "presets" / f"{preset}.toml").with_values(FAR[name])
    assert failing(written_masks(config, tmp_path / "out"), "mask_picture") == set()
