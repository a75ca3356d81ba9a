"""Where a sheet lies: its registration marks give scale and place, and so the sensor frame."""

from dataclasses import dataclass, replace

import numpy as np

from lumitip_fab.checks.mask_page import Page, PageError, Points, Subpath
from lumitip_fab.design import Mask

_MARKS = 4


@dataclass(frozen=True, eq=False)
class Placed:
    """How sensor coordinates became sheet coordinates: x mirrored, two scales and a shift."""

    scale: tuple[float, float]
    origin: tuple[float, float]
    """Of the sensor frame, on the sheet."""
    residual_mm: float
    """Of the worst mark: turned or skewed sheets show here."""

    def points(self, sheet: Points) -> Points:
        """Points of the sheet in the sensor frame."""
        across, up = self.scale
        return (sheet - self.origin) / (-across, up)

    def subpath(self, on_sheet: Subpath) -> Subpath:
        """A run of the sheet in the sensor frame."""
        corners, controls = self.points(on_sheet.corners), self.points(on_sheet.controls)
        return replace(on_sheet, corners=corners, controls=controls)


def registration_of(page: Page) -> Points:
    """Centres of the marks of a page: circles of four cubics, stroked by themselves."""
    rings = [
        p.subpaths[0].corners.mean(axis=0)
        for p in page.painted
        if p.stroked and not p.filled and len(p.subpaths) == 1
        and len(p.subpaths[0].corners) == 4 and len(p.subpaths[0].controls) == 8
    ]  # fmt: skip
    return np.array(rings).reshape(-1, 2)


def place(found: Points, mask: Mask) -> Placed:
    """Fit the sheet to its marks.

    Args:
        found: centres of the marks on the sheet, in any order.
        mask: for the places where they should be.

    Raises:
        PageError: if there are not four marks round a middle.
    """
    wanted = np.array(mask.registration)
    if len(found) != _MARKS:
        raise PageError(f"{len(found)} registration marks, {_MARKS} are needed")
    found, wanted = found[_corner_order(found)], wanted[_corner_order(wanted)]
    middle, nominal = found.mean(axis=0), wanted.mean(axis=0)
    off, reach = found - middle, wanted - nominal
    scale = (off * reach).sum(axis=0) / (reach * reach).sum(axis=0)
    if not (scale > 0).all():
        raise PageError("the registration marks are not at four corners")
    residual = float(np.hypot(*((off / scale) - reach).T).max())
    # The marks are the same in x and -x, so that their middle is the frame's origin in x.
    origin = middle - scale * nominal
    across, up = scale.tolist()
    return Placed((across, up), (float(origin[0]), float(origin[1])), residual)


def _corner_order(points: Points) -> list[int]:
    right, above = (points > points.mean(axis=0)).T
    return sorted(range(len(points)), key=lambda i: (bool(right[i]), bool(above[i])))
