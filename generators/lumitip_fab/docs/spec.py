"""The published Table I (arXiv 2306.05902) beside the figures of a design, and why they differ."""

import math

import numpy as np

from lumitip_fab.design import Design
from lumitip_fab.design.frames import gripper_to_base, gripper_to_tool
from lumitip_fab.docs.outside import Row, outside
from lumitip_fab.docs.spec_circuit import (
    ambient_rows,
    channel_rows,
    electrical_rows,
    string_rows,
)


def rows(design: Design) -> tuple[Row, ...]:
    """Table I of the publication, then the figures that it does not have."""
    return (
        *_table_1(design),
        *_further(design),
        *string_rows(design),
        *channel_rows(design),
        *ambient_rows(design),
        *outside(design),
    )


def choice_rows(design: Design) -> tuple[Row, ...]:
    """Every automatic value with its reason."""
    return tuple(Row(c.field, "", c.value, c.reason) for c in design.choices)


def _table_1(design: Design) -> tuple[Row, ...]:
    return (*_sizes(design), *electrical_rows(design))


def _sizes(design: Design) -> tuple[Row, ...]:
    stack, outline, mount = design.stack, design.outline, design.mount
    box, pitch = design.board.box, design.grid.pitch_mm
    width = 2 * float(np.abs(outline.polygon()[:, 0]).max())
    depth = mount.block_back_w_mm - stack.rim_z_mm
    span = float(np.ptp(design.layout.x_mm)), float(np.ptp(design.layout.y_mm))
    # Each cell is a hexagon with flats to the tip: pitch high, 2/√3 pitch from corner to corner.
    corners = pitch * 2 / math.sqrt(3)
    before, behind = outline.tip_y_mm - box.y_max_mm, box.y_min_mm - outline.end_y_mm
    to_tip = box.y_max_mm - float(design.layout.y_mm.max())
    cell = pitch**2 * math.sqrt(3) / 2
    columns = ", ".join(str(n) for n in design.grid.columns)
    return (
        Row(
            "width",
            "58 mm",
            f"{width:.1f} mm",
            f"board of {box.width_mm:.1f} mm and {(width - box.width_mm) / 2:.1f} mm on each side "
            "to the widest point of an own curve; the published part measures 57.9",
        ),
        Row(
            "height",
            "54 mm",
            f"{outline.length_mm:.1f} mm",
            f"board of {box.length_mm:.1f} mm, {before:.1f} before and {behind:.1f} behind it; "
            "the published part measures 54.7",
        ),
        Row(
            "depth",
            "21 mm",
            f"{depth:.1f} mm",
            f"silicone {stack.silicone_mm:g} and mask {stack.film_mm:g} before the rim, coupling "
            f"{mount.block_back_w_mm:g} behind it; Table I gives whole mm",
        ),
        Row(
            "board",
            "42.8 x 43.1 mm",
            f"{box.width_mm:.1f} x {box.length_mm:.1f} mm",
            f"cells over {span[0]:.1f} x {span[1]:.1f} mm; {(box.width_mm - span[0]) / 2:.2f} to "
            f"each side, {to_tip:.2f} to the tip, the rest takes parts and connector",
        ),
        Row(
            "sensorised area",
            "38.0 x 30.0 mm",
            f"{span[0] + corners:.1f} x {span[1] + pitch:.1f} mm",
            f"cells over {span[0]:.2f} x {span[1]:.1f} mm and one hexagon more, {corners:.2f} from "
            f"corner to corner and {pitch:g} across flats",
        ),
        Row(
            "thickness without coupling",
            "4.0 mm",
            f"{stack.thickness_mm:.1f} mm",
            f"floor {stack.floor_mm:g}, board {stack.pcb_mm:g}, silicone {stack.silicone_mm:g}, "
            f"mask {stack.film_mm:g} mm",
        ),
        Row(
            "density",
            "3.21 per cm²",
            f"{100 / cell:.2f} per cm²",
            f"one cell in {cell:.1f} mm², at a pitch of {pitch:g} mm instead of 6",
        ),
        Row(
            "cells",
            "32",
            str(len(design.layout)),
            f"columns of {columns}; published: 5, 4, 5, 4, 5, 4, 5",
        ),
    )


def _of_rigid(design: Design) -> tuple[Row, ...]:
    stack, printing = design.stack, design.printing
    return (
        Row(
            "pocket depth",
            "0.8 mm",
            f"{stack.pcb_mm:g} mm",
            f"as deep as the board is thick, so that it is flush with the rim; the published board "
            f"stands {stack.pcb_mm - 0.8:.1f} mm proud",
        ),
        Row(
            "floor behind the board",
            "0.5 mm",
            f"{stack.floor_mm:g} mm",
            f"at least printer.min_wall_mm = {printing.min_wall_mm:g}; 0.5 mm is little more than "
            f"one line of {printing.line_mm:g}",
        ),
    )


def _of_flex(design: Design) -> tuple[Row, ...]:
    """Rows of a compliant finger, beside measured figures of the published flexible part."""
    stack, (interface,) = design.stack, design.interfaces
    rows = len({y for _, y in design.receiver.holes})
    return (
        Row(
            "bendable plate",
            "2.0 mm",
            f"{stack.floor_mm:g} mm",
            f"of {design.printing.material}, with the board on its flat front",
        ),
        Row(
            "holes for thread",
            "2.2 mm",
            f"{interface.thread_hole_mm:g} mm",
            f"{len(design.receiver.holes)} in {rows} rows, behind those of the board; the "
            "published part has them 1 mm farther from the tip than its own board",
        ),
        Row(
            "interface",
            "26 mm",
            f"{interface.box.length_mm:.1f} mm",
            f"rim of {interface.rim_mm:g} x {interface.rim_height_mm:g} mm in a groove of "
            f"{interface.groove_mm:g} x {interface.groove_depth_mm:g}; published: 1.1 x 0.65 in "
            "1.5 x 0.75",
        ),
    )


def _further(design: Design) -> tuple[Row, ...]:
    stack, printing, tip = design.stack, design.printing, design.tip
    plate = design.fit_plate
    kinds = {part.kind: part for finger in design.fingers for part in finger.parts}
    over = [
        Row(
            f"silicone over the {kind}",
            "not stated",
            f"{stack.silicone_mm - part.height_mm:.2f} mm",
            f"{stack.silicone_mm:g} mm of silicone, part {part.height_mm:g} mm high",
        )
        for kind, part in sorted(kinds.items())
        if part.side == "front"
    ]
    current, volts = sum(design.wiring.current_ma), design.wiring.supply_v
    slant = design.outline.tip_y_mm - tip.slant_start_y_mm
    tcp_mm = float(gripper_to_base(stack, design.mount, design.closing)[2, 3])
    to_tool = gripper_to_tool(stack, design.mount, design.closing, design.system)
    tool_mm = float(to_tool[2, 3])
    skin = (design.mount.stroke_mm - design.closing.max_opening_mm) / 2
    shape = design.layout.optics.hole_shape
    across = "diameter" if shape == "circle" else "across flats"
    return (
        *over,
        *(_of_flex(design) if design.interfaces else _of_rigid(design)),
        Row(
            "tip edge",
            "0 mm",
            f"{tip.edge_mm:g} mm",
            f"one printed line is {printing.line_mm:g} mm wide: a knife edge cannot be printed",
        ),
        Row(
            "wedge at the tip",
            "12.2°",
            f"{tip.angle_deg:.1f}°",
            f"from {stack.plate_mm:g} to {tip.edge_mm:g} mm over {slant:g} mm; published: from 1.3 "
            "to 0 over 6, of the flexible part from 2 to 0 over 14.2",
        ),
        Row(
            "gripper",
            "Robotiq 2F-85",
            f"{design.mount.title}, {design.mount.bolt}",
            _trusted(design),
        ),
        Row(
            "fit test plate",
            "none",
            f"{plate.volume_ml:.1f} cm³",
            "lumitip-fab slice prints its duration; its reading is printer.fit_mm, here "
            f"{printing.fit_mm:g} mm (docs/making.md)",
        ),
        Row(
            "lean of each finger",
            "1.5°",
            f"{design.mount.tilt_deg:g}°",
            f"of {design.mount.gripper} in parts/grippers.toml"
            + (" and flex.lean_deg" if design.interfaces else ""),
        ),
        Row(
            "largest opening",
            "not stated",
            f"{design.closing.max_opening_mm:.1f} mm",
            f"stroke of {design.mount.stroke_mm:g} mm less {skin:.1f} for each finger's skin, "
            "which stands before the gripper's own pad",
        ),
        Row(
            "tool centre point",
            "not stated",
            f"{tcp_mm:.1f} mm",
            "from the mount plane, midway between the fingers: the middle of both grids",
        ),
        Row("... from the robot's flange", "not stated", f"{tool_mm:.1f} mm", _reached(design)),
        Row(
            "aperture",
            "2.5 mm",
            f"{design.mask.hole_mm:g} mm",
            f"{across} of a {shape}, by mask.hole_mm; published: a hexagon",
        ),
        Row(
            "mask",
            "printed film, 0.1 mm",
            f"{design.mask.material}, {stack.film_mm:g} mm",
            f"by mask.route = {design.mask.route!r}; outputs/mask has files for all three routes",
        ),
        Row(
            "heat in the emitter",
            "not stated",
            f"{design.electrical.heat_w:.2f} W",
            f"{current:.1f} mA from {volts:g} V, all of it in LEDs and what sets their current",
        ),
    )


def _reached(design: Design) -> str:
    """Terms of the height of the fingers' mount plane."""
    system = design.system
    added = system.gripper_z_mm - system.coupling_mm
    before = (
        f"coupling {system.coupling_mm:g}, flange {added:g}"
        if design.flanges
        else "without a coupling: from the gripper's own face"
    )
    return (
        f"{before}, gripper {system.reach_mm:g} mm, closed ({system.confidence}, "
        "parts/grippers.toml), and the row above"
    )


def _trusted(design: Design) -> str:
    """How far the gripper's figures go, and what to do about those that go not far enough."""
    if not design.mount.unsure:
        return "every figure from a datasheet or a measurement: parts/grippers.toml"
    return (
        f"neither datasheet nor measurement gives {', '.join(design.mount.unsure)}: print the "
        "coupling alone and try it first (docs/making.md)"
    )
