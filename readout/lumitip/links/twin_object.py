"""The object between the fingers of a twin, as a user changes it while the twin runs.

Of each object some numbers can be set; then it stays where it was put. Otherwise it moves by
itself, as `lumitip.links.twin.moved` says.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError
from lumitip.layout import Layout
from lumitip.twin import Cable, Corner, Disc, HalfPlane, Sheet, Thing
from lumitip.twin.materials import MATERIALS, material
from lumitip.values import shown

Limits = tuple[float, float]
Placed = Thing | tuple[()]
"""An object, or the empty grasp."""
OPAQUE = "opaque"
OBJECTS: dict[str, type[Thing] | None] = {
    "edge": HalfPlane,
    "cable": Cable,
    "corner": Corner,
    "disc": Disc,
    "sheet": Sheet,
    "empty": None,
}
"""Names of the objects, and their classes; `None` is the empty grasp."""
_TURN: Limits = (-180.0, 180.0)
_STEP_MM = 5.0
_MATERIALS = (OPAQUE, *(m.key for m in MATERIALS))


@dataclass(frozen=True)
class Choice:
    """What a user has chosen."""

    shape: str
    """One of `lumitip.links.twin.SHAPES`."""
    material: str = OPAQUE
    placed: Placed | None = None
    """The object where a user has put it; `None` while it moves by itself."""


def fields_of(layout: Layout) -> dict[str, dict[str, Limits]]:
    """Numbers of each object with their limits; places reach a little beyond the cells."""
    beyond_mm = float(np.hypot(layout.x_mm, layout.y_mm).max()) + layout.pitch_mm
    reach_mm = _STEP_MM * math.ceil(beyond_mm / _STEP_MM)
    place: Limits = (-reach_mm, reach_mm)
    return {
        "edge": {"offset_mm": place, "angle_deg": _TURN},
        "cable": {"offset_mm": place, "angle_deg": _TURN, "diameter_mm": (0.5, 20.0)},
        "corner": {"x_mm": place, "y_mm": place, "angle_deg": _TURN, "opening_deg": (10.0, 170.0)},
        "disc": {"x_mm": place, "y_mm": place, "diameter_mm": (1.0, 2.0 * reach_mm)},
        "sheet": {},
        "empty": {},
    }


def controls_of(layout: Layout, shapes: tuple[str, ...]) -> dict[str, Any]:
    """What can be set, for JSON."""
    return {
        "objects": list(shapes),
        "materials": list(_MATERIALS),
        "fields": fields_of(layout),
    }


def name_of(thing: Placed) -> str:
    """The name of an object."""
    return next(n for n, kind in OBJECTS.items() if kind is (type(thing) if thing else None))


def values_of(thing: Placed, layout: Layout) -> dict[str, float]:
    """The numbers of an object, angles within ± 180°."""
    values = {name: float(getattr(thing, name)) for name in fields_of(layout)[name_of(thing)]}
    if "angle_deg" in values:
        values["angle_deg"] = math.remainder(values["angle_deg"], 360.0)
    return values


def status_of(choice: Choice, now: Placed, layout: Layout) -> dict[str, Any]:
    """What is there now, for JSON."""
    return {
        "object": choice.shape,
        "material": choice.material,
        "moving": choice.placed is None,
        "now": name_of(now),
        "values": values_of(now, layout),
    }


def changed(
    choice: Choice,
    now: Placed,
    layout: Layout,
    asked: Mapping[str, object],
    shapes: tuple[str, ...],
) -> Choice:
    """The choice after a request.

    Args:
        choice: before.
        now: the object at this moment.
        layout: the cells.
        asked: `object`, `material`, `moving`, and numbers of the object; all optional.
        shapes: allowed words of `object`.

    Raises:
        ArgumentError: if the request is not understood; nothing changes.
    """
    wanted = dict(asked)
    shape = _word(wanted.pop("object", choice.shape), "object", shapes)
    of = _word(wanted.pop("material", choice.material), "material", _MATERIALS)
    moving = wanted.pop("moving", not wanted and choice.placed is None)
    if not isinstance(moving, bool):
        raise ArgumentError(f"moving is {shown(moving)}; true or false is needed")
    placed = None if moving else _placed(shape, of, now, layout, wanted)
    if moving and wanted:
        raise ArgumentError(
            f"moving is true, so {next(iter(wanted))} cannot be set; leave out one of them"
        )
    return Choice(shape, of, placed)


def _word(value: object, name: str, allowed: tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in allowed:
        raise ArgumentError(f"{name} is {shown(value)}; allowed are {', '.join(allowed)}")
    return value


def _placed(
    shape: str, of: str, now: Placed, layout: Layout, wanted: Mapping[str, object]
) -> Placed:
    name = shape if shape in OBJECTS else name_of(now)
    kind = OBJECTS[name]
    limits = fields_of(layout)[name]
    for other in wanted:
        if other not in limits:
            allowed = ", ".join(limits) or "no numbers"
            raise ArgumentError(f"there is no {shown(other)} of {name}; allowed are {allowed}")
    if kind is None:
        return ()
    before = values_of(now, layout)
    thing = kind()
    values = {
        field: arguments.number(wanted[field], field, *limits[field])
        if field in wanted
        else min(max(before.get(field, getattr(thing, field)), limits[field][0]), limits[field][1])
        for field in limits
    }
    clear, diffuse = light_through(of)
    return replace(thing, **values, clear=clear, diffuse=diffuse)


def light_through(key: str) -> tuple[float, float]:
    """Shares of light that pass a material straight and scattered."""
    if key == OPAQUE:
        return 0.0, 0.0
    found = material(key)
    return found.clear, found.diffuse
