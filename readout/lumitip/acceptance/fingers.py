"""Deviations of the fingers as a whole that are out of tolerance."""

import math
from collections.abc import Mapping

from lumitip.acceptance.findings import (
    GAP_MM,
    GUARD_SD,
    HOLE_MM,
    MASK_DEG,
    MASK_MM,
    MISFIT,
    SCATTER,
    SCATTER_ALONE,
    THICK_MM,
    Finding,
)
from lumitip.acceptance.fit import Fitted
from lumitip.acceptance.response import named

_FINGERS = ("receiver", "emitter")
_NO_WAY_MM = 1e-9


def faults_of_fingers(
    fitted: Fitted,
    reference: Mapping[str, float] | None,
    thicker_mm: tuple[float, float] | None = None,
) -> list[Finding]:
    """Findings of a fit, the largest first.

    Args:
        fitted: deviations.
        reference: mean deviations of good fingers, if there are any.
        thicker_mm: silicone of receiver and emitter beyond the drawing, if it was measured.
    """
    of, guards = named(fitted.deviations), named(GUARD_SD * fitted.sd)
    every = [_mask(finger, of, guards) for finger in _FINGERS]
    every += [_gap(of, guards), _silicone(of, guards, reference), _holes(of, guards)]
    every += [_thickness(*each) for each in zip(_FINGERS, thicker_mm or (), strict=False)]
    found = sorted((f for f in every if f.times_limit > 1.0), key=lambda f: -f.times_limit)
    if fitted.rms > MISFIT:
        text = (
            f"the cells differ by {fitted.rms:.1f} of 255 from any finger with such faults; at "
            f"most {MISFIT:g}. Was the gauge pressed against its stop, and the right way round? "
            "If all pairs show this alone, the twin does not know your optics"
        )
        found.append(Finding("unexplained", text, times_limit=fitted.rms / MISFIT))
    return found


_Named = Mapping[str, float]
"""By names of deviations: the deviations, or by how much each must be within its limit."""


def _mask(finger: str, of: _Named, guards: _Named) -> Finding:
    x, y, turn = (of[f"{finger}_{way}"] for way in ("x", "y", "turn"))
    off = math.hypot(x, y)
    along = math.hypot(x * guards[f"{finger}_x"], y * guards[f"{finger}_y"])
    most_mm = _guarded(MASK_MM, along / max(off, _NO_WAY_MM))
    most_deg = _guarded(MASK_DEG, guards[f"{finger}_turn"])
    text = (
        f"{finger}'s mask: {_direction(x, y)}, turned by {abs(turn):.1f}° to the "
        f"{'left' if turn > 0 else 'right'}, seen on the receiver with the tip up; at most "
        f"{most_mm:.2f} mm and {most_deg:.1f}°. Lay it anew"
    )
    return Finding(f"{finger} mask", text, times_limit=max(off / most_mm, abs(turn) / most_deg))


def _gap(of: _Named, guards: _Named) -> Finding:
    most_mm = _guarded(GAP_MM, guards["gap"])
    text = (
        f"gap: {of['gap']:+.2f} mm beyond the gauge's; at most {most_mm:.2f} mm. Does something "
        "lie between gauge and skin, is a finger bent or not parallel?"
    )
    return Finding("gap", text, times_limit=abs(of["gap"]) / most_mm)


def _silicone(of: _Named, guards: _Named, reference: _Named | None) -> Finding:
    good, limits = ("good fingers", SCATTER) if reference else ("the drawing", SCATTER_ALONE)
    off = of["scatter"] - (reference or {}).get("scatter", 0.0)
    less, more = (_guarded(limit, guards["scatter"]) for limit in limits)
    text = (
        f"silicone: scattered share {off:+.2f} from {good}, {'milky' if off > 0 else 'clear'}; "
        f"-{less:.2f} to +{more:.2f} is allowed. Is it the silicone of the bill, free of bubbles, "
        "and the film's back clear?"
    )
    return Finding("silicone", text, times_limit=max(-off / less, off / more))


def _thickness(finger: str, thicker_mm: float) -> Finding:
    text = (
        f"{finger}'s silicone: {abs(thicker_mm):.2f} mm "
        f"{'thicker' if thicker_mm > 0 else 'thinner'} than drawn; at most {THICK_MM:g} mm. "
        "Did the mould's stops lie on the backing?"
    )
    return Finding(f"{finger} thickness", text, times_limit=abs(thicker_mm) / THICK_MM)


def _holes(of: _Named, guards: _Named) -> Finding:
    most_mm = _guarded(HOLE_MM, guards["hole"])
    text = (
        f"holes: {of['hole']:+.2f} mm wider than the drawing's; at most {most_mm:.2f} mm. Measure "
        "the mask's rulers and holes"
    )
    return Finding("holes", text, times_limit=abs(of["hole"]) / most_mm)


def _guarded(limit: float, guard: float) -> float:
    """What is accepted of a limit; at least half of it, where little is known."""
    return limit - min(guard, limit / 2)


def _direction(x_mm: float, y_mm: float) -> str:
    side = "right" if x_mm > 0 else "left"
    along = "towards the tip" if y_mm > 0 else "towards the gripper"
    return f"{abs(x_mm):.2f} mm to the {side}, {abs(y_mm):.2f} mm {along}"
