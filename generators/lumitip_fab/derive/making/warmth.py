"""How warm a finger is by its own LEDs: an estimate, for two open fingers in still air.

The power leaves a plate by its two faces, by convection and by radiation, and none by the gripper.
Between closed fingers it is warmer, in moving air or on a large gripper cooler.
"""

import math
from bisect import bisect_left

from shapely import Polygon

from lumitip_fab.design import Electrical, Outline

ROOM_C = 25.0
MOST_K = 1000
EMISSIVITY = 0.9
"""Of plastics, solder mask and silicone, as handbooks commonly give it (0.85 to 0.95)."""
CONVECTION = 1.42
"""Of an upright plate in air, laminar: h = 1.42 (K / m)^(1/4) W/m²K, the simplified equation of
McAdams as in Holman, Heat Transfer, "free convection in air at atmospheric pressure"."""
STEFAN_BOLTZMANN = 5.670374e-8  # W/m²K⁴ (CODATA 2018)
ZERO_C_K = 273.15


def in_use_c(figures: Electrical, outline: Outline) -> float:
    """Temperature of the emitter's finger in use, in a room of 25 °C, up to a whole degree."""
    rises_k = range(MOST_K)
    return ROOM_C + bisect_left(rises_k, figures.mean_heat_w, key=lambda k: _leaves_w(k, outline))


def most_heat_w(figures: Electrical, outline: Outline, limit_c: float) -> float:
    """Power of LEDs that are on with which the finger is no warmer than a limit, in 0.01 W; 0 where
    the room alone is."""
    share = figures.mean_heat_w / figures.heat_w
    return math.floor(_leaves_w(max(limit_c - ROOM_C, 0.0), outline) / share * 100) / 100


def _leaves_w(rise_k: float, outline: Outline) -> float:
    """Heat that leaves a plate which is warmer than its room."""
    area_m2 = 2 * float(Polygon(outline.polygon()).area) * 1e-6
    length_m, room_k = outline.length_mm / 1000, ROOM_C + ZERO_C_K
    convection = CONVECTION * (rise_k / length_m) ** 0.25 * rise_k
    radiation = EMISSIVITY * STEFAN_BOLTZMANN * ((room_k + rise_k) ** 4 - room_k**4)
    return float(area_m2 * (convection + radiation))
