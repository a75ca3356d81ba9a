"""The published Table I (arXiv 2306.05902) and other figures beside those of a design, and why they
differ; rows of boards and printed parts."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from lumitip_fab.design import AuxiliaryBoard, Design, Finger, Flange, Holder, Mount, TieLug
from lumitip_fab.design.frames import gripper_to_base, gripper_to_tool
from lumitip_fab.design.insert import LEAST_MARGIN_MM
from lumitip_fab.design.least_size import too_small
from lumitip_fab.docs.row import Row, rows_of
from lumitip_fab.docs.spec_circuit import (
    ambient_rows,
    channel_rows,
    electrical_rows,
    input_rows,
    string_rows,
)
from lumitip_fab.text import listed


def outside(design: Design) -> Iterator[Row]:
    """Rows of the boards and printed parts that the design has."""
    breakout = [board for board in design.auxiliary_boards if board.name == "breakout"]
    for auxiliary in design.auxiliary_boards:
        yield from _breakout(auxiliary) if auxiliary in breakout else _flange(auxiliary)
    if protection := design.electrical.protection:
        most_ma = 1000 * (protection.most_pin_a or math.inf)
        pin_ma = 1000 * protection.pin_a
        yield from rows_of("protected", protection=protection, pin_ma=pin_ma, most_ma=most_ma)
    for finger in design.fingers:
        yield from _held_at(finger, design)
    yield from _lugs(design.mount.lugs, "lugs", "no_lugs", mount=design.mount)
    added = {cable.name: cable.added_mm for cable in design.cabling.cables}
    for loop in design.cabling.loops:
        longer = f"; cut {added[loop.cable]:g} mm longer for it" if added[loop.cable] else ""
        yield from rows_of("loop", loop=loop, ratio=design.cabling.bend_ratio, longer=longer)
    for supply in design.electrical.supplies:
        charging_ma = 1000 * supply.charging_a
        least_a = supply.ripple_a / 2
        yield from rows_of("regulated", supply=supply, least_a=least_a, charging_ma=charging_ma)
    yield from input_rows(design)
    if feed := design.feed:
        left_v = feed.wire_v - feed.drop_v
        yield from rows_of("feed" if feed.diode else "joined_feed", feed=feed, left_v=left_v)
    for lit in design.electrical.indicators:
        milliwatts = {"takes_mw": 1000 * lit.resistor_w, "rated_mw": 1000 * lit.rated_w}
        yield from rows_of("lit", lit=lit, **milliwatts)
    if breakout and not design.holders:
        yield from rows_of("no_holder", mount=design.mount)
    for holder in design.holders if breakout else ():
        yield from rows_of("holder", holder=holder)
        yield from _lugs(holder.lugs, "holder_lugs", "no_holder_lugs", holder=holder)
    for flange in design.flanges:
        yield from _stack(flange)
    for panel in design.panels:
        yield from rows_of("panel", panel=panel, copies=len(panel.copies))
    for small in too_small(design):
        names = {"fabs": listed([*small.fabs]), "boards": listed([*small.boards])}
        yield from rows_of("small", least=small.least_mm, **names)


def _breakout(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    spacing = auxiliary.holes[1][0] - auxiliary.holes[0][0]
    yield from rows_of("breakout", box=auxiliary.box, spacing=spacing)
    yield from _tied(auxiliary)


def _tied(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    """Strain relief of the cables; none where no cable ends at wire pads."""
    for tie in auxiliary.ties[:1]:
        yield from rows_of("tied", tie=tie, count=len(auxiliary.ties))


def _held_at(finger: Finger, design: Design) -> Iterator[Row]:
    """Strain relief of a finger's cable, or the figures that leave no room for it."""
    if finger.ties:
        return rows_of("thread", name=finger.name, tie=finger.ties[0])
    if design.board.flexible:
        return rows_of("stiffened", name=finger.name)
    wires = finger.connector
    x, y = wires.pads[-1]
    edge_mm = y - wires.pad_mm / 2 - design.board.box.y_min_mm
    notch_mm = finger.notch.x_max_mm - x - wires.pad_mm / 2
    return rows_of("no_thread", name=finger.name, edge_mm=edge_mm, notch_mm=notch_mm)


def _lugs(lugs: tuple[TieLug, ...], some: str, none: str, **of: Mount | Holder) -> Iterator[Row]:
    """Lugs for cable ties, or what leaves no room for them."""
    wide, thick = lugs[0].tie_mm if lugs else (0.0, 0.0)
    names = ", ".join(lug.name for lug in lugs)
    return rows_of(some if lugs else none, names=names, wide=wide, thick=thick, **of)


def _flange(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    """The flange's board; without a regulator, the robot's contact must carry its voltage."""
    values = {device.ref: device.value for device in auxiliary.components}
    points = [part for part in auxiliary.components if part.kind == "test point"]
    yield from rows_of("flange", box=auxiliary.box)
    yield from rows_of("regulator" if auxiliary.hot_loop else "no_regulator", **values)
    yield from rows_of(
        "protection",
        **values,
        points=", ".join(part.value for part in points),
        width_mm=points[0].footprint.pads[0].width_mm,
    )
    yield from _tied(auxiliary)
    if "U2" in values:
        yield from rows_of("module", **values)


def _stack(flange: Flange) -> Iterator[Row]:
    return rows_of(
        "stack",
        flange=flange,
        bolts=len(flange.bolts),
        circle_mm=2 * max(math.hypot(*at) for at in flange.bolts),
        pressed=flange.contacts_mm - (flange.board_z_mm - flange.contacts_z_mm),
    )


def rows(design: Design) -> tuple[Row, ...]:
    """Table I of the publication, then the figures that it does not have."""
    return (
        *rows_of("sizes", **_sizes(design)),
        *electrical_rows(design),
        *_of_the_plate(design),
        *rows_of("further", **_further(design)),
        *string_rows(design),
        *channel_rows(design),
        *ambient_rows(design),
        *outside(design),
        *_of_the_gauge(design),
    )


_INPUT = "flange.fuse", "flange.tvs", "flange.gate_ohm"
"""Parts that a breakout has at its input where there is no flange."""


def choice_rows(design: Design) -> tuple[Row, ...]:
    """Every automatic value with its reason, but for those of a flange that is not made."""
    of_parts = [c for c in design.choices if c.field != "flange.enabled"]
    made = ("flange.",) if design.flanges else _INPUT if design.entered else ()
    absent = [c for c in of_parts if c.field.startswith("flange.") and not c.field.startswith(made)]
    chosen = [c for c in design.choices if c not in absent]
    return tuple(Row(c.field, "", c.value, c.reason) for c in chosen)


def _sizes(design: Design) -> dict[str, Any]:
    stack, outline, mount = design.stack, design.outline, design.mount
    box, pitch = design.board.box, design.grid.pitch_mm
    width = 2 * float(np.abs(outline.polygon()[:, 0]).max())
    span = float(np.ptp(design.layout.x_mm)), float(np.ptp(design.layout.y_mm))
    # Each cell is a hexagon with flats to the tip: pitch high, 2/√3 pitch from corner to corner.
    corners = pitch * 2 / math.sqrt(3)
    cell = pitch**2 * math.sqrt(3) / 2
    return {
        "stack": stack,
        "outline": outline,
        "box": box,
        "pitch": pitch,
        "width": width,
        "side": (width - box.width_mm) / 2,
        "before": outline.tip_y_mm - box.y_max_mm,
        "behind": box.y_min_mm - outline.end_y_mm,
        "depth": mount.block_back_w_mm - stack.rim_z_mm,
        "back_mm": mount.block_back_w_mm,
        "span": span,
        "beside": (box.width_mm - span[0]) / 2,
        "to_tip": box.y_max_mm - float(design.layout.y_mm.max()),
        "corners": corners,
        "area": (span[0] + corners, span[1] + pitch),
        "cell": cell,
        "density": 100 / cell,
        "cells": len(design.layout),
        "columns": ", ".join(str(n) for n in design.grid.columns),
    }


def _of_the_plate(design: Design) -> tuple[Row, ...]:
    """Silicone over the parts, and the plate behind the board, rigid or compliant."""
    stack, printing = design.stack, design.printing
    kinds = {part.kind: part for finger in design.fingers for part in finger.parts}
    over = [
        row
        for _, part in sorted(kinds.items())
        if part.side == "front"
        for row in rows_of(
            "over",
            part=part,
            silicone_mm=stack.silicone_mm,
            over_mm=stack.silicone_mm - part.height_mm,
        )
    ]
    over += [*_of_the_keys(design), *_of_the_wrap(design), *_of_the_insert(design)]
    over += _of_the_clamp(design)
    if not design.interfaces:
        return (*over, *rows_of("rigid", stack=stack, printing=printing, proud=stack.pcb_mm - 0.8))
    (interface,), holes = design.interfaces, design.receiver.holes
    values = {"holes": len(holes), "rows": len({y for _, y in holes})}
    return (
        *over,
        *rows_of("flex", stack=stack, printing=printing, interface=interface, **values),
    )


def _of_the_keys(design: Design) -> Iterator[Row]:
    """The holes that hold the skin, or that there are none."""
    for key in design.keys[:1]:
        yield from rows_of("keys", count=len(design.keys), hole_mm=key.hole_mm)
    if not design.keys:
        yield from rows_of("no_keys")


def _of_the_wrap(design: Design) -> Iterator[Row]:
    """The silicone round the tip, or that the skin ends at its edge."""
    for prop in design.props:
        length = design.mould.lip_length_mm(design.outline, design.tip)
        skin, (left, right) = design.mould.tip_silicone_mm, design.tip.slots
        yield from rows_of(
            "wrap",
            prop=prop,
            slot_mm=design.tip.slot_mm,
            bare_edge_mm=right.x_min_mm - left.x_max_mm,
            length_mm=length,
            thick_mm=prop.level_mm(design.outline.tip_y_mm) + skin,
            bare_mm=design.tip.edge_mm + skin,
        )
    if not design.props:
        yield from rows_of("no_wrap")


def _of_the_insert(design: Design) -> Iterator[Row]:
    """The film that gives the silicone its face, or that there is none."""
    for insert in design.inserts:
        yield from rows_of("insert", insert=insert)
    if not design.inserts:
        yield from rows_of("no_insert", margin_mm=LEAST_MARGIN_MM)


def _of_the_clamp(design: Design) -> Iterator[Row]:
    """The press of the clamp that holds a finger in its mould, or that there is none."""
    for clamp in design.clamps:
        yield from rows_of("clamp", clamp=clamp, press_n=clamp.pads_n(clamp.thickness_mm))
    if not design.clamps:
        yield from rows_of("no_clamp")


def _of_the_gauge(design: Design) -> Iterator[Row]:
    """The gauge card for acceptance, or why there is none."""
    for card in design.gauge_cards:
        yield from rows_of("gauge", card=card, strip_mm=card.strip.width_mm)
    if not design.gauge_cards:
        yield from rows_of("no_gauge_flex" if design.interfaces else "no_gauge")


def _further(design: Design) -> dict[str, Any]:
    stack, mount, closing, system = design.stack, design.mount, design.closing, design.system
    shape = design.layout.optics.hole_shape
    added = system.gripper_z_mm - system.coupling_mm
    named = ("stack", "mount", "closing", "system", "printing", "tip", "mask", "wiring")
    return {name: getattr(design, name) for name in (*named, "electrical")} | {
        "plate": design.fit_plate,
        "current_ma": sum(design.wiring.current_ma),
        "slant": design.outline.tip_y_mm - design.tip.slant_start_y_mm,
        "tcp_mm": float(gripper_to_base(stack, mount, closing)[2, 3]),
        "tool_mm": float(gripper_to_tool(stack, mount, closing, system)[2, 3]),
        "face": "the robot's flange" if design.flanges else "the gripper's own face",
        "before": f"coupling {system.coupling_mm:g}, flange {added:g}, " if design.flanges else "",
        "skin": (mount.stroke_mm - closing.max_opening_mm) / 2,
        "shape": shape,
        "holes_field": "mask.cell_holes_mm"
        if set(design.mask.holes_mm) != {design.layout.optics.hole_mm}
        else "mask.hole_mm",
        "across": "diameter" if shape == "circle" else "across flats",
        "flex_lean": " and flex.lean_deg" if design.interfaces else "",
        "trusted": _trusted(design),
        "use": design.heat_steps["use"],
    }


def _trusted(design: Design) -> str:
    """How far the gripper's figures go, and what to do about those that go not far enough."""
    if not design.mount.unsure:
        return "every figure from a datasheet or a measurement: parts/grippers.toml"
    names = dict.fromkeys(figure.name.partition(".")[0] for figure in design.mount.unsure)
    return (
        f"neither datasheet nor measurement gives {', '.join(names)}: print the "
        "coupling alone and try it first (docs/making.md)"
    )
