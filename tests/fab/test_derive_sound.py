"""What holds for every design that is not refused: nothing collides and all of it fits."""

import dataclasses
import math
from collections.abc import Callable, Iterator
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from box_gaps import from_point_mm, gap_mm, inside_mm, round_box
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Finger, Part
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

NOISE_MM = 1e-6
Faults = Callable[[Design], Iterator[str]]
PRESETS = ("asymmetric", "dense", "mux16", "published")


def _faults(design: Design) -> Iterator[str]:
    """Every promise that a design breaks."""
    for finger in design.fingers:
        for promise in (_of_parts, _of_bulk, _of_holes, _of_reliefs, _of_connector):
            yield from (f"{finger.name}: {fault}" for fault in promise(design, finger))
    yield from _of_outline(design)


def _of_parts(design: Design, finger: Finger) -> Iterator[str]:
    zones = {zone.name: zone.box for zone in finger.zones}
    for (a, here), (b, there) in combinations(zones.items(), 2):
        if gap_mm(here, there) < -NOISE_MM:
            yield f"zones {a} and {b} overlap"
    for name, box in zones.items():
        if inside_mm(box, design.board.box) < -NOISE_MM:
            yield f"zone {name} leaves the board"
    bulk = _bulk(design, finger)
    for part in (q for q in finger.parts if q not in bulk):
        zone = "cells" if part.kind in ("led", "photodetector") else "parts"
        if inside_mm(part.box, zones[zone]) < -NOISE_MM:
            yield f"{part.name} leaves the zone {zone}"
    sides = {side: [q for q in finger.parts if q.side == side] for side in ("front", "back")}
    for parts in sides.values():
        boxes = shapely.box(
            *np.array(
                [(q.box.x_min_mm, q.box.y_min_mm, q.box.x_max_mm, q.box.y_max_mm) for q in parts]
            )
            .reshape(-1, 4)
            .T
        )
        near = shapely.STRtree(boxes).query(boxes, predicate="dwithin", distance=0.1 - NOISE_MM)
        for i, j in near.T.tolist():
            if i < j:
                yield f"{parts[i].name} and {parts[j].name} collide"
    if len({q.name for q in finger.parts}) != len(finger.parts):
        yield "two parts have the same name"
    heights = {q.height_mm for q in sides["front"]}
    if design.stack.silicone_mm - max(heights) < 0.3 - NOISE_MM:
        yield "less than 0.3 mm of silicone over a part"


def _bulk(design: Design, finger: Finger) -> list[Part]:
    """The bulk capacitor, which is not among the other parts but beside the wires."""
    if design.electrical.bulk is None or finger.name != "receiver":
        return []
    return [max((q for q in finger.parts if q.kind == "capacitor"), key=lambda q: int(q.name[1:]))]


def _of_bulk(design: Design, finger: Finger) -> Iterator[str]:
    wire, holes = finger.connector.pad_mm / 2, [at for tie in finger.ties for at in tie.holes]
    for part in _bulk(design, finger):
        if inside_mm(part.box, design.board.box) < 0.5 - NOISE_MM:
            yield f"{part.name} is too near the board's edge"
        if any(from_point_mm(part.box, pad) < wire + 0.5 for pad in finger.connector.pads):
            yield f"{part.name} meets a wire pad"
        if any(from_point_mm(part.box, hole) < finger.ties[0].hole_mm / 2 + 0.3 for hole in holes):
            yield f"{part.name} meets a hole of the thread"


def _of_holes(design: Design, finger: Finger) -> Iterator[str]:
    radius = design.board.hole_mm / 2
    if len(finger.holes) < 4 or len(set(finger.holes)) != len(finger.holes):
        yield "fewer than four holes"
    for at in finger.holes:
        if inside_mm(round_box(at, design.board.hole_mm), design.board.box) < 0.5 - NOISE_MM:
            yield f"hole {at} is too near the board's edge"
        for part in finger.parts:
            if from_point_mm(part.box, at) < radius + 0.2:
                yield f"hole {at} meets {part.name}"
        for pad in finger.connector.pads:
            if math.dist(pad, at) < radius + finger.connector.pad_mm / 2 + 0.2:
                yield f"hole {at} meets a pad"
        openings = {"notch": finger.notch} | {f"relief {r.box}": r.box for r in finger.reliefs}
        for name, box in openings.items():
            wall = from_point_mm(box, at) - design.board.pin_mm / 2
            if wall < design.printing.min_wall_mm - NOISE_MM:
                yield f"the pin at {at} stands {wall:.2f} mm from the {name}"
    for a, b in combinations(finger.holes, 2):
        if math.dist(a, b) < design.board.hole_mm + 0.4 - NOISE_MM:
            yield f"holes {a} and {b} are too near each other"
    if not 1.0 - NOISE_MM <= design.board.pin_mm < design.board.hole_mm:
        yield f"pins of {design.board.pin_mm} mm"


def _of_reliefs(design: Design, finger: Finger) -> Iterator[str]:
    wall = design.printing.min_wall_mm
    for relief in finger.reliefs:
        if inside_mm(relief.box, design.board.pocket) < -NOISE_MM:
            yield "a relief leaves the pocket"
        if gap_mm(relief.box, finger.notch) < wall - NOISE_MM:
            yield "a relief is too near the notch"
        reach = design.mount.block_width_mm / 2
        if min(abs(relief.box.x_min_mm), abs(relief.box.x_max_mm)) < reach + wall - NOISE_MM:
            yield "a relief is too near the coupling"
        left = design.stack.floor_mm - relief.depth_mm
        if relief.through != (left < wall - NOISE_MM) or (relief.through and left != 0):
            yield f"a relief leaves {left} mm of floor"
    for part in finger.parts:
        if part.side == "back" and not any(
            inside_mm(part.box, relief.box) > 0.2 - NOISE_MM and relief.depth_mm >= part.height_mm
            for relief in finger.reliefs
        ):
            yield f"{part.name} on the back has no relief"


def _of_connector(design: Design, finger: Finger) -> Iterator[str]:
    for pad in finger.connector.pads:
        box = round_box(pad, finger.connector.pad_mm)
        if inside_mm(box, design.board.box) < 0.3 - NOISE_MM:
            yield f"pad {pad} is too near the board's edge"
        if inside_mm(box, finger.notch) < 0.5 - NOISE_MM:
            yield f"pad {pad} is not over the notch"
        if inside_mm(box, finger.window) < 1.0:
            yield f"pad {pad} is not in the window"
    if any(
        b - a < finger.connector.pad_mm + 0.2 for (a, _), (b, _) in pairwise(finger.connector.pads)
    ):
        yield "pads touch"
    lowest = min(y for _, y in finger.cells) - design.mask.holes_mm[0] / 2
    if lowest - finger.window.y_max_mm < 0.4 - NOISE_MM:
        yield "an aperture meets the window"
    if finger.notch.y_min_mm > design.outline.end_y_mm + NOISE_MM:
        yield "the notch is not open to the gripper end"


def _of_outline(design: Design) -> Iterator[str]:
    corners = design.outline.polygon()
    skin = shapely.Polygon(corners)
    if not skin.is_valid or not skin.exterior.is_ccw:
        yield "the outline is no simple counter-clockwise curve"
    if not shapely.Polygon(corners * (-1, 1)).symmetric_difference(skin).area < 1e-6:
        yield "the outline is not symmetric"
    pocket = design.board.pocket
    hole = shapely.box(pocket.x_min_mm, pocket.y_min_mm, pocket.x_max_mm, pocket.y_max_mm)
    if not skin.contains(hole) or skin.exterior.distance(hole) < design.printing.min_wall_mm - 1e-3:
        yield "too little rim round the pocket"
    if abs(corners[:, 1].max() - design.outline.tip_y_mm) > NOISE_MM:
        yield "the tip is elsewhere"
    if abs(corners[:, 1].min() - design.outline.end_y_mm) > NOISE_MM:
        yield "the gripper end is elsewhere"
    if design.tip.slant_start_y_mm < pocket.y_max_mm - NOISE_MM:
        yield "the wedge begins beyond the pocket"
    for at in design.mould.pads:
        pad = shapely.Point(at).buffer(design.mould.pad_mm / 2)
        if not skin.contains(pad) or pad.distance(hole) < 0.05:
            yield "a stop of the mould is not on the rim"
    if design.outline.tip_y_mm - design.mould.taper_length_mm < design.board.box.y_max_mm:
        yield "the silicone thins over the board"
    if design.closing.max_opening_mm < 10:
        yield "the fingers hardly open"


@pytest.mark.parametrize("name", PRESETS)
def test_presets_derive_and_nothing_collides(
    designs: dict[str, Design], wiring_faults: Faults, name: str
) -> None:
    assert not [*_faults(designs[name]), *wiring_faults(designs[name])]


def test_collisions_are_seen(designs: dict[str, Design], wiring_faults: Faults) -> None:
    """The promises above can fail."""
    design = designs["published"]

    def broken(**changes: Any) -> str:
        emitter = dataclasses.replace(design.emitter, **changes)
        other = dataclasses.replace(design, emitter=emitter)
        return " / ".join([*_faults(other), *wiring_faults(other)])

    first, *others = design.emitter.parts
    x, y = design.emitter.holes[0]
    moved = dataclasses.replace(first, x_mm=others[0].x_mm, y_mm=others[0].y_mm + 0.5)
    assert "D1 and D2 collide" in broken(parts=(moved, *others))
    assert "D1 leaves the zone" in broken(parts=(dataclasses.replace(first, x_mm=30.0), *others))
    assert "meets D" in broken(holes=(first.box.centre_mm, *design.emitter.holes[1:]))
    assert "too near the board's edge" in broken(holes=((x, y + 1.5), *design.emitter.holes[1:]))
    assert "has no relief" in broken(reliefs=())
    assert "too near the notch" in broken(notch=design.emitter.notch.grown(3.0))
    assert "does not face" in broken(cells=design.receiver.cells[::-1])
    taken = dataclasses.replace(design.layout, channel=design.layout.channel * 0)
    assert "share an input" in " ".join(wiring_faults(dataclasses.replace(design, layout=taken)))


COLUMNS = [
    (5, 4, 5, 4, 5, 4, 5),
    (4, 5, 6, 5),
    (3, 4),
    (4, 3, 2, 1),
    (1, 2, 3, 4, 5),
    (6, 5) * 4,
    (2, 3) * 8,
    (8, 7, 8, 7, 8),
    (3,),
    (12,),
    (2, 1),
    (1, 1, 1),
    (4, 4, 4, 4),
    (5, 2, 5),
    (1, 4, 1),
    (1, 2, 3, 2, 1),
    (1,) * 8,
]
ROOMY = {
    "mask.hole_mm": 1.5,
    "mask.flap_mm": 6.0,
    "board.tip_margin_mm": 5.0,
    "emitter.resistor_side": "front",
    "emitter.current_ma": 2.0,
    "outline.tip_margin_mm": 7.0,
}
WEAK = {"finger.rated_force_n": 0.5, "finger.bend_fraction": 0.5, "backing.flare_mm": 2.0}
"""A load that fingers of any length bear: these fields are not chosen here."""


@pytest.mark.parametrize("columns", COLUMNS, ids=str)
def test_a_design_of_any_pitch_is_sound_or_refused(
    inputs: Any, vary: Any, wiring_faults: Faults, columns: tuple[int, ...]
) -> None:
    sound = 0
    for pitch_mm in np.arange(3.0, 10.25, 0.5).tolist():
        for changes in ({}, ROOMY):
            wanted = {**WEAK, **changes, "grid.columns": columns, "grid.pitch_mm": pitch_mm}
            try:
                design = derive(vary(inputs["published"], wanted))
            except InputError:
                continue
            sound += 1
            assert not [*_faults(design), *wiring_faults(design)], wanted
    assert sound, "every pitch was refused"


def _any_values(told: dict[str, Any]) -> st.SearchStrategy[dict[str, Any]]:
    fields = [
        f"{section}.{key}"
        for section, table in told.items()
        if isinstance(table, dict)
        for key, value in table.items()
        if isinstance(value, float)
    ]
    factor = st.one_of(
        st.floats(0.9, 1.15), st.floats(0.4, 2.5), st.sampled_from([1e-9, 0.01, 100.0, 1e9])
    )
    return st.dictionaries(st.sampled_from(fields), factor, max_size=4)


def test_random_values_give_a_sound_design_or_are_refused(
    inputs: Any, vary: Any, wiring_faults: Faults
) -> None:
    derived = 0

    @settings(
        max_examples=120,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(
        name=st.sampled_from(PRESETS),
        factors=_any_values(inputs["published"].parameters.model_dump()),
        side=st.sampled_from(["front", "back"]),
    )
    def attempt(name: str, factors: dict[str, float], side: str) -> None:
        nonlocal derived
        values: dict[str, Any] = {f: inputs[name].value(f) * by for f, by in factors.items()}
        try:
            design = derive(vary(inputs[name], values | {"emitter.resistor_side": side}))
        except (InputError, ValidationError):
            return
        derived += 1
        assert not [*_faults(design), *wiring_faults(design)], values

    attempt()
    assert derived > 20
