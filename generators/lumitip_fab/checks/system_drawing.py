"""The exploded drawing of the whole system: every body, in its order, all on the page."""

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np

from lumitip_fab.checks.readers.drawing import Drawing, margin_mm, read_drawing
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design

DRAWN = ("drawing", "drawing_page", "heights")
PLACE_MM = 0.02
_DRAWING = "assembly/system.svg"
RISE_MM = 10.0  # from body to body, on the page
MARGIN_MM = 2.0
_CLIMB = re.compile(r"^\+ ([\d.]+) = ([\d.]+) mm")


def measure_drawing(
    outputs: Path, design: Design, heights: tuple[float, ...]
) -> Iterator[Measurement]:
    """Every body on the page, in its order; heights that add up to those of the scene."""
    try:
        drawing = read_drawing(outputs / _DRAWING)
    except (OSError, XmlTree.ParseError, LookupError, ValueError) as error:
        names = DRAWN if heights else DRAWN[:-1]
        reason = f"cannot be read: {error!r:.200}"
        yield from (unreadable(f"system.{name}", _DRAWING, reason) for name in names)
        return
    yield from _on_page(drawing, design)
    yield Measurement(
        "system.drawing_page",
        _DRAWING,
        margin_mm(drawing),
        MARGIN_MM,
        np.inf,
        "mm",
        "to the page's edge",
    )
    if heights:
        yield _labels(drawing, heights)


def _on_page(drawing: Drawing, design: Design) -> Iterator[Measurement]:
    layers = [f"{f.name}.{layer}" for f in design.fingers for layer in design.layers]
    stacked = [
        name
        for name in wanted_bodies(design)
        if name.partition(".")[0]
        in ("robot", "coupling", "gripper", *(f.name for f in design.flanges))
    ]
    held = [f"{name}.{part}" for name in design.system.holders for part in ("tray", "board")]
    wanted = [*stacked, *held, *layers]
    missing = [name for name in wanted if not len(drawing.groups.get(name, ()))]
    note = f"of {len(wanted)}" + (f", first {missing[0]}" if missing else "")
    yield Measurement("system.drawing", _DRAWING, len(missing), 0, 0, "missing", note)
    order = [
        "robot.flange",
        "coupling.body",
        *(f"{f.name}.{part}" for f in design.flanges for part in ("lower", "board", "upper")),
        "gripper.envelope",
        "emitter.backing",
    ]
    middles = [
        drawing.groups[name][:, 1].mean() for name in order if len(drawing.groups.get(name, ()))
    ]
    rise = float(np.diff(middles).min(initial=np.inf))
    yield Measurement(
        "system.drawing",
        f"{_DRAWING} order",
        rise,
        RISE_MM,
        np.inf,
        "mm",
        "least rise from body to body",
    )


def _labels(drawing: Drawing, heights: tuple[float, ...]) -> Measurement:
    """Steps and heights as they are written, against the bodies."""
    climbs = [match.groups() for words, _ in drawing.words if (match := _CLIMB.match(words))]
    climbed = sorted((float(height), float(step)) for step, height in climbs)
    if len(climbed) != len(heights):
        return unreadable("system.heights", _DRAWING, f"{len(climbed)} of {len(heights)} heights")
    wanted = np.column_stack([heights, np.diff((0.0, *heights))])
    off = float(np.abs(np.array(climbed) - wanted).max())
    return Measurement(
        "system.heights",
        _DRAWING,
        off,
        0,
        PLACE_MM,
        "mm",
        f"of {len(heights)} heights and steps, the worst",
    )


def real_bodies(design: Design) -> Iterator[str]:
    """Names of the bodies whose shape is that of the thing itself."""
    for flange in design.flanges:
        yield from (f"{flange.name}.{part}" for part in ("lower", "board", "upper"))
    for holder in design.system.holders:
        yield from (f"{holder}.{part}" for part in ("tray", "board"))
    for finger in design.fingers:
        yield f"{finger.name}.{design.held}"


def wanted_bodies(design: Design) -> Iterator[str]:
    if design.flanges:
        yield from ("robot.flange", "coupling.body")
    yield "gripper.envelope"
    yield from real_bodies(design)
    for finger in design.fingers:
        yield from (f"{finger.name}.{layer}" for layer in design.layers)
        yield from (part.name for part in finger.parts)
