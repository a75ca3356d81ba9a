"""Findings, and the limits of what is judged."""

import math
from dataclasses import dataclass

MASK_MM, MASK_DEG = 1.0, 2.5
"""Most that a mask may be beside its place: four deviations of one that is laid by eye. The gauge
measures it within 0.2 mm, since the board may lie beside its place, too."""
GAP_MM = 0.6
"""Most that the skins may be from the gauge's gap: less closes on it, more is a bent finger."""
SCATTER, SCATTER_ALONE = (0.4, 0.3), (0.5, 0.35)
"""Most by which the scattered share of the light may be less, and more, than that of good fingers,
and without these than that of the drawing, which nobody has measured: a second optical model has
0.4 less. More than 0.4 above the drawing is impossible: all light is scattered then."""
THICK_MM = 0.3
"""Most by which the silicone may be thicker or thinner: six deviations of one that is cast well."""
HOLE_MM = 0.5
"""Most by which the holes may be wider or narrower."""
GUARD_SD = 0.5
"""Of the standard deviation of what the gauge measures, by which it must stay within its limit
(guarded acceptance, as JCGM 106 has it): fingers out of tolerance are then rather found than not.
"""
MISFIT = 12.0
"""Most rms difference from the twin (counts of 255). The published frame of a cloth edge differs by
9, those of corner and cable by more, of objects that nobody measured."""
ODD, ODD_MOVING = 25.0, 13.0
"""Most rms difference of a single cell from the fit, and most mean difference while the sheet moves
(counts of 255). Good fingers reach 19 and 11 in simulation: parts lie beside their lands."""
WEAK = 0.4
"""Least light of a cell in the empty grasp, as a share of the median."""
LEAK = 25.5
"""Most light behind sheet metal (counts of 255)."""
NOISE = 8.0
"""Most standard deviation of a cell in a steady step (counts of 255), as in a calibration."""
LEAST_LIGHT, MOST_LIGHT = 100.0, 252.0
"""Range of the median cell in the empty grasp (counts of 255)."""


@dataclass(frozen=True)
class Finding:
    """A fault of cells, or a deviation of the fingers that is out of tolerance."""

    kind: str
    """`"dark"`, `"saturated"`, `"stuck"`, `"noisy"`, `"swapped"`, `"astray"`, `"weak"`, `"leak"`,
    `"odd"`, `"exposure"` for cells; `"receiver mask"`, `"emitter mask"`, `"gap"`, `"silicone"`,
    `"receiver thickness"`, `"emitter thickness"`, `"holes"`, `"unexplained"` for the fingers."""
    text: str
    """Observation and remedy, for the builder."""
    cells: tuple[int, ...] = ()
    """Their numbers; empty where it is a matter of all."""
    times_limit: float = math.inf
    """How large it is; infinite for a fault of cells."""


def cell_names(cells: tuple[int, ...]) -> str:
    """Cells for a message."""
    return f"cell {' and '.join(map(str, cells))}" if cells else "all cells"
