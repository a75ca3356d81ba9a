"""The coupon of the mask's material: it covers every cell, has no hole, and is as thick as the
mask."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks.readers import MALFORMED, solids
from lumitip_fab.checks.readers.mask_page import Page, PageError, read_page
from lumitip_fab.checks.readers.three_mf import three_mf_triangles
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("mask/coupon_*.pdf", "mask/coupon.stl", "mask/coupon.3mf")
PAPERS = ("a4", "letter")
SIZE_MM = 0.01
THICK_MM = 0.001
WHOLE = 1e-4  # of its volume


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Both pages and the printed piece."""
    for paper in PAPERS:
        page = Subject("mask_coupon", f"mask/coupon_{paper}.pdf")
        try:
            yield from _covers(page, _black_mm(read_page(outputs / page.subject)), design)
        except PageError as error:
            yield unreadable("mask_coupon.covers", page.subject, str(error))
    yield from _printed(Subject("mask_coupon", "mask/coupon.stl"), outputs, design)


def _black_mm(page: Page) -> tuple[float, float]:
    """Width and length of the page's one full black rectangle.

    Raises:
        PageError: if something else is filled, or it is not black or not whole.
    """
    filled = [painted for painted in page.painted if painted.filled]
    if len(filled) != 1 or len(filled[0].subpaths) != 1 or not filled[0].black:
        raise PageError(f"{len(filled)} areas are filled; one whole black one is needed")
    left, low, right, high = filled[0].subpaths[0].extent
    area = shapely.Polygon(filled[0].subpaths[0].corners).area
    if not math.isclose(area, (right - left) * (high - low), rel_tol=WHOLE):
        raise PageError("its black is no whole rectangle")
    return right - left, high - low


def _covers(read: Subject, size_mm: tuple[float, float], design: Design) -> Iterator[Measurement]:
    """Its size against the cells, with half a pitch more on each side: the hexagon round a cell."""
    cells = np.array(design.receiver.cells)
    beyond = (np.array(size_mm) - np.ptp(cells, axis=0)) / 2
    note = "beyond the outer cells"
    yield read.figure("covers", beyond.min(), design.grid.pitch_mm / 2, math.inf, note=note)


def _printed(read: Subject, outputs: Path, design: Design) -> Iterator[Measurement]:
    """The printed piece: size, thickness, no hole, and the same in the 3MF."""
    try:
        mesh = solids.read_mesh(outputs / read.subject)
        packed = three_mf_triangles(outputs / "mask/coupon.3mf").reshape(-1, 3)
    except (OutputError, OSError, *MALFORMED) as error:
        yield unreadable("mask_coupon.covers", read.subject, str(error))
        return
    wide, long, thick = np.ptp(mesh.bounds, axis=0)
    yield from _covers(read, (wide, long), design)
    wanted = design.mask.sheet.layers * design.printing.layer_mm
    yield read.near("thickness", thick, wanted, THICK_MM)
    share = float(mesh.volume / (wide * long * thick))
    yield read.near("whole", share, 1.0, WHOLE, "of its block is solid", unit="")
    off = np.abs(np.ptp(packed, axis=0) - (wide, long, thick)).max()
    yield read.figure("three_mf", off, 0, SIZE_MM, note="size of the 3MF")
