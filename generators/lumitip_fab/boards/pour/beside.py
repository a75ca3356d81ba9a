"""`beside`: vias of the pour near pads that want one."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from lumitip_fab.boards.model import Via
from lumitip_fab.boards.placed import BYPASS_MM, PlacedPad


def beside(pads: Sequence[PlacedPad], possible: list[Via], present: list[Via]) -> list[Via]:
    """The nearest via for each pad that has none as near yet, where one is near."""
    added: list[Via] = []
    for pad in pads:
        away_mm = _away_mm(pad, possible)
        has = _away_mm(pad, [*present, *added]).min(initial=math.inf)
        if away_mm.min(initial=math.inf) <= BYPASS_MM and away_mm.min() < has:
            added.append(possible[int(away_mm.argmin())])
    return added


def _away_mm(pad: PlacedPad, vias: Sequence[Via]) -> NDArray[np.float64]:
    places = np.array([(v.x_mm, v.y_mm) for v in vias]).reshape(-1, 2)
    return np.asarray(shapely.distance(pad.area, shapely.points(places)), np.float64).round(6)
