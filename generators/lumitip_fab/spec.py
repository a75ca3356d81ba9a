"""The published Table I (arXiv 2306.05902) beside the figures of a design, and why they differ."""

import math
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.table import Table

from lumitip_fab.design import Design


@dataclass(frozen=True)
class Row:
    """One figure: published, computed, and the reason where they differ."""

    quantity: str
    published: str
    computed: str
    reason: str = ""


def rows(design: Design) -> tuple[Row, ...]:
    """Table I of the publication, then the figures that it does not have."""
    return (*_table_1(design), *_further(design))


def _table_1(design: Design) -> tuple[Row, ...]:
    box, pitch = design.board.box, design.grid.pitch_mm
    width = 2 * float(np.abs(design.outline.polygon()[:, 0]).max())
    depth = design.mount.block_back_w_mm - design.stack.rim_z_mm
    x_mm, y_mm = design.layout.x_mm, design.layout.y_mm
    # Each cell is a hexagon with flats to the tip: pitch high, 2/√3 pitch from corner to corner.
    area = (np.ptp(x_mm) + pitch * 2 / math.sqrt(3), np.ptp(y_mm) + pitch)
    density = 100 / (pitch**2 * math.sqrt(3) / 2)
    return (
        Row("width", "58 mm", f"{width:.1f} mm",
            "own curve round the board; the published part measures 57.9"),
        Row("height", "54 mm", f"{design.outline.length_mm:.1f} mm",
            "board and its margins; the published part measures 54.7"),
        Row("depth", "21 mm", f"{depth:.1f} mm", "silicone and film before the coupling's 19.1"),
        Row("board", "42.8 x 43.1 mm", f"{box.width_mm:.1f} x {box.length_mm:.1f} mm",
            "follows grid, margins and parts"),
        Row("sensorised area", "38.0 x 30.0 mm", f"{area[0]:.1f} x {area[1]:.1f} mm",
            "hexagons of the grid, corner to corner"),
        Row("thickness without coupling", "4.0 mm", f"{design.stack.thickness_mm:.1f} mm",
            "floor, board, silicone and film"),
        Row("density", "3.21 per cm²", f"{density:.2f} per cm²", "follows the pitch"),
        Row("cells", "32", str(len(design.layout)), "follows the columns"),
        Row("resolution", "8 bits", f"{design.controller.adc_bits} bits",
            "of the controller's ADC; the published firmware keeps 8"),
        Row("rate", "55 Hz", "set by the firmware", "not a property of the printed parts"),
        Row("current of the emitter", "38 mA", f"{sum(design.wiring.current_ma):.1f} mA",
            f"nominal: {len(design.wiring.strings)} strings, "
            f"{_ohms(design.wiring.resistor_ohm)} from {design.wiring.supply_v:g} V"),
        Row("current of the receiver", "1 mA", f"{_pull_up_ma(design):.2f} mA",
            "pull-ups at full light only; multiplexers take microamperes"),
        Row("warm-up", "5 min", "not computed", "measure it on your sensor"),
    )  # fmt: skip


def _further(design: Design) -> tuple[Row, ...]:
    kinds = {part.kind: part for finger in design.fingers for part in finger.parts}
    over = [
        Row(f"silicone over the {kind}", "not stated",
            f"{design.stack.silicone_mm - part.height_mm:.2f} mm", f"{part.height_mm:g} mm high")
        for kind, part in sorted(kinds.items()) if part.side == "front"
    ]  # fmt: skip
    heat_w = sum(design.wiring.current_ma) * design.wiring.supply_v / 1000
    return (
        *over,
        Row("pocket depth", "0.8 mm", f"{design.stack.pcb_mm:g} mm",
            "the published board stands proud; here it is flush with the rim"),
        Row("floor behind the board", "0.5 mm", f"{design.stack.floor_mm:g} mm",
            "at least printer.min_wall_mm"),
        Row("tip edge", "0 mm", f"{design.tip.edge_mm:g} mm", "one printed line"),
        Row("wedge at the tip", "12.2°", f"{design.tip.angle_deg:.1f}°",
            "a thicker plate over the same length"),
        Row("lean of each finger", "1.5°", f"{design.mount.tilt_deg:g}°", "of the gripper's entry"),
        Row("largest opening", "not stated", f"{design.closing.max_opening_mm:.1f} mm",
            f"the gripper's {design.mount.stroke_mm:g} mm less the fingers' thickness"),
        Row("aperture", "2.5 mm", f"{design.mask.hole_mm:g} mm", design.mask.hole_shape),
        Row("heat in the emitter", "not stated", f"{heat_w:.2f} W", "LEDs and their resistors"),
    )  # fmt: skip


def _ohms(values: tuple[float, ...]) -> str:
    return ", ".join(f"{values.count(v)} x {v:g} Ω" for v in sorted(set(values)))


def _pull_up_ma(design: Design) -> float:
    optics = design.layout.optics
    return 1000 * design.wiring.muxes * optics.supply_v / optics.pull_up_ohm


def print_table(told: tuple[Row, ...], console: Console) -> None:
    """The rows as a table."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading in ("", "published", "this design"):
        table.add_column(heading, no_wrap=True)
    table.add_column("why they differ", style="dim", overflow="fold")
    for row in told:
        differs = row.published != row.computed
        table.add_row(row.quantity, row.published, row.computed, row.reason if differs else "")
    console.print(table)
