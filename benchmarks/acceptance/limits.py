"""Physical limits of `docs/ranges.md`, from the catalogue's figures.

Nothing here comes from `lumitip_fab`, so that the same figures confirm what it refuses.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from acceptance.parts import Table, bends, entries, over_pads_mm, preset

PAGE_MM = (210.0 - 16 - 30, 279.4 - 16 - 50)  # for the mask: less margins, rulers and texts
COVER_MM = 0.3  # silicone over the tallest part
BETWEEN_PADS_MM = 0.25
FINEST_MM = 0.125  # tracks and gaps at the usual price
FINEST_BENDING_MM, BENDING_LANE_USE, GROUND_LINES = 0.15, 0.9, 1
CHANNEL_MM, CONNECTOR_MM, END_MM = 2.2, 2.3, 1.9
STEP_DOWN_V = 1.0
MODULE_WIRES = 9
SCREW_FROM_MIDDLE_MM, BODY_MM, SEAT_GAP_MM = 17.78, 75.0, 0.3
EDGE_BELOW_PLATE_MM = 0.3
THINNEST_WALL_MM, WALL_LINES = 0.8, 1.2
RIM_LINES = 2 / 3
THICKEST_FLEXIBLE_MM = 0.2
PUBLISHED = {
    "board.side_margin_mm": 5.8,
    "board.tip_margin_mm": 3.65,
    "outline.tip_margin_mm": 6.2,
    "outline.end_margin_mm": 5.4,
    "outline.shoulder_margin_mm": 7.5,
    "mask.flap_mm": 13.0,
    "mask.allowance_mm": 0.75,
    "stack.floor_mm": 0.8,
    "stack.pcb_mm": 1.6,
    "receiver.pull_up_ohm": 75000.0,
    "supply.max_ma": 500.0,
    "emitter.max_heat_w": 2.0,
}
BENCH = "bench"
"""The controller that cannot be bought: it stands for one of the user's own."""


USUAL = {"emitter.led": "15406085BA300", "receiver.photodetector": "SML-H10TBT86"}
"""Parts that are taken where the file leaves the choice."""


@dataclass(frozen=True)
class Values:
    """The fields in force of a user file: what it writes, over the preset."""

    edits: Table
    base: str

    def __getitem__(self, field: str) -> Any:
        value = self.edits.get(field, preset(self.base)[field])
        return USUAL.get(field, value) if value == "auto" else value

    def number(self, field: str) -> float:
        """A figure; the published one where the preset leaves it to follow from others."""
        value = self[field]
        return float(value) if isinstance(value, int | float) else PUBLISHED[field]

    def part(self, field: str, kind: str) -> Table | None:
        """The entry that a field names; none where the preset leaves it to follow from others."""
        return entries(kind).get(self[field])

    @property
    def columns(self) -> tuple[int, ...]:
        """Cells of each column."""
        return tuple(self["grid.columns"])

    @property
    def cells(self) -> int:
        """How many cells there are."""
        return sum(self.columns)


def crossed(values: Values) -> str:
    """The first physical limit that a design crosses, in words; empty if it crosses none."""
    return next((text for limit in LIMITS for text in limit(values)), "")


def multiplexers(values: Values) -> list[Table]:
    """The multiplexers that may be used: the one written, else every one."""
    one = values.part("receiver.multiplexer", "multiplexers")
    written = "receiver.multiplexer" in values.edits
    return [one] if one and written else list(entries("multiplexers").values())


def inputs(board: str, muxes: list[Table]) -> float:
    """Most cells that a controller reads through one of these multiplexers."""
    controller = entries("controllers")[board]
    if controller.get("unlimited_analog_pins"):
        return math.inf
    lines = len(controller["select_pins"])
    channels = [len(m["inputs"]) for m in muxes if len(m["select"]) <= lines]
    return len(controller["analog_pins"]) * max(channels, default=0)


def finger_mm(values: Values) -> tuple[float, float]:
    """Width and length of the finger, its margins those of the file or as published.

    It is as wide on both sides of the middle of its cells.
    """
    pitch, columns = values["grid.pitch_mm"], values.columns
    middle = sum(i * count for i, count in enumerate(columns)) / sum(columns)
    wide = 2 * max(middle, len(columns) - 1 - middle) * pitch * math.sqrt(3) / 2
    tall = (max(columns) - 1) * pitch + (pitch / 2 if len(set(columns)) == 1 < len(columns) else 0)
    side = values.number("board.side_margin_mm") + values.number("outline.shoulder_margin_mm")
    ends = values.number("board.tip_margin_mm") + values.number("outline.tip_margin_mm")
    ends += values.number("outline.end_margin_mm") + END_MM + CONNECTOR_MM + 2 * CHANNEL_MM
    mux = max(multiplexers(values), key=lambda m: len(m["inputs"]))
    board = wide + 2 * values.number("board.side_margin_mm")
    gripper = entries("grippers")[values["coupling.gripper"]]
    board = max(board, gripper["seat_width_mm"] + 18)
    row = max(int(board / (mux["body_mm"][0] + 1.45)), 1)
    rows = math.ceil(math.ceil(values.cells / len(mux["inputs"])) / row)
    return max(wide + 2 * side, board + 15), tall + ends + rows * (mux["lead_span_mm"] + CHANNEL_MM)


def _page(values: Values) -> Iterator[str]:
    around = 2 * (values.number("mask.flap_mm") + values.number("mask.allowance_mm"))
    for side, room, ruler in zip(
        finger_mm(values), PAGE_MM, values["mask.measured_ruler_mm"], strict=True
    ):
        if (side + around) * 100 / ruler > room:
            yield f"page: a finger of {side:.0f} mm with flaps of {around / 2:g} mm, {room:g} mm"


def _bed(values: Values) -> Iterator[str]:
    wide, long = finger_mm(values)
    printer = values.part("printer.profile", "printers")
    bed = printer["bed_mm"] if printer else (math.inf,) * 3
    if wide + 6.8 > bed[0] or long + 14.2 > min(bed[1:]):
        yield f"bed: {wide:.0f} x {long:.0f} mm, a bed of {bed}"


def _land_patterns(values: Values) -> Iterator[str]:
    for field, kind in (("emitter.led", "leds"), ("receiver.photodetector", "photodetectors")):
        part = values.part(field, kind)
        least = max(over_pads_mm(part)) + BETWEEN_PADS_MM if part else 0.0
        if values["grid.pitch_mm"] < least - 1e-9:
            yield f"land patterns: {values[field]} needs a pitch of {least:.2f} mm"


def _lines(values: Values) -> Iterator[str]:
    lane = values["grid.pitch_mm"] * math.sqrt(3) / 2
    most = lane / (2 * FINEST_MM)
    if values["backing.variant"] == "flex":
        detector = values.part("receiver.photodetector", "photodetectors")
        lane -= min(over_pads_mm(detector)) if detector else 0.0
        most = BENDING_LANE_USE * lane / (2 * FINEST_BENDING_MM) - GROUND_LINES
    if len(values.columns) > 1 and max(values.columns) > most + 1e-9:
        yield f"lines: {max(values.columns)} cells in a column, room for {most:.1f} lines"


def least_silicone_mm(values: Values) -> float:
    """Silicone that covers the tallest part on the front of either board."""
    parts = (
        values.part("emitter.led", "leds"),
        values.part("receiver.photodetector", "photodetectors"),
        min(multiplexers(values), key=lambda m: m["body_mm"][2]),
    )
    return float(max(part["body_mm"][2] for part in parts if part) + COVER_MM)


def _cover(values: Values) -> Iterator[str]:
    least = least_silicone_mm(values)
    if values["stack.silicone_mm"] < least - 1e-9:
        yield f"cover: {values['stack.silicone_mm']} mm of silicone, {least:g} mm needed"


def _inputs(values: Values) -> Iterator[str]:
    most = inputs(values["controller.board"], multiplexers(values))
    if values.cells > most:
        yield f"inputs: {values.cells} cells, {most} inputs of {values['controller.board']}"


def _stands(values: Values) -> bool:
    """Whether the gripper stands on the coupling of the flange."""
    gripper = entries("grippers")[values["coupling.gripper"]]
    return bool(gripper.get("base") == entries("couplings")[values["flange.coupling"]]["base"])


def _flanged(values: Values) -> bool:
    wanted = values["flange.enabled"]
    return _stands(values) if wanted == "auto" else bool(wanted)


def _base(values: Values) -> Iterator[str]:
    if values["flange.enabled"] is True and not _stands(values):
        yield f"base: {values['coupling.gripper']} does not stand on {values['flange.coupling']}"


def _step_down(values: Values) -> Iterator[str]:
    regulator = values.part("flange.regulator", "regulators")
    made = regulator["output_v"] if regulator else 5.0
    if _flanged(values) and values["supply.voltage_v"] < made + STEP_DOWN_V:
        yield f"step-down: {made:g} V of {values['supply.voltage_v']:g} V"


def _module(values: Values) -> Iterator[str]:
    if not entries("controllers")[values["controller.board"]].get("module"):
        return
    if not _flanged(values):
        yield "module: there is no flange"
    wires = min(
        2 + len(m["select"]) + math.ceil(values.cells / len(m["inputs"]))
        for m in multiplexers(values)
    )
    if wires > MODULE_WIRES:
        yield f"module: {wires} wires to the receiver, room for {MODULE_WIRES}"


def _plate(values: Values) -> Iterator[str]:
    edge = values.edits.get("tip.edge_mm")
    plate = values.number("stack.floor_mm")
    if values["backing.variant"] == "rigid":
        plate += values.number("stack.pcb_mm")
    printer = values.part("printer.profile", "printers")
    line = printer["line_mm"] if printer else 0.0
    if edge is not None and not line <= edge <= plate - EDGE_BELOW_PLATE_MM:
        yield f"plate: an edge of {edge:g} mm, a plate of {plate:g} mm and a line of {line:g} mm"


def nut_has_room(screw: str) -> bool:
    """Whether a nut fits between its seat and the gripper's body."""
    nut = entries("fasteners")[screw]
    inner = SCREW_FROM_MIDDLE_MM - nut["nut_mm"] / math.sqrt(3)
    room = BODY_MM / 2 + SEAT_GAP_MM - math.sqrt((BODY_MM / 2) ** 2 - inner**2)
    return bool(room >= nut["nut_height_mm"])


def _nut(values: Values) -> Iterator[str]:
    screw = values.edits.get("holder.screw")
    if screw and not nut_has_room(screw):
        yield f"nut: no room for one of {screw}"


def _bending(values: Values) -> Iterator[str]:
    flex, board = values["backing.variant"] == "flex", values["stack.pcb_mm"]
    if not isinstance(board, str) and flex != (board <= THICKEST_FLEXIBLE_MM):
        yield f"bending: a board of {board:g} mm, {values['backing.variant']}"
    if bends(values["backing.material"]) != (values["backing.variant"] == "flex"):
        yield f"bending: {values['backing.variant']} of {values['backing.material']}"


def _groove(values: Values) -> Iterator[str]:
    """The plate of a finger that bends is a wall under the groove in which a rim is glued."""
    if values["backing.variant"] != "flex":
        return
    printer = values.part("printer.profile", "printers")
    line = printer["line_mm"] if printer else 0.0
    wall = max(THINNEST_WALL_MM, WALL_LINES * line)
    rim = RIM_LINES * line + values.number("flex.glue_mm")
    plate = values.number("stack.floor_mm")
    if plate < wall + rim - 1e-9:
        yield f"groove: a plate of {plate:g} mm, a wall of {wall:g} mm and a rim of {rim:g} mm"


def _block(values: Values) -> Iterator[str]:
    """The hole of the bolt and the holes of the pins beside it grow by the fit; a wall between
    them that is thinner than a line is not printed."""
    printer = values.part("printer.profile", "printers")
    gripper = entries("grippers")[values["coupling.gripper"]]
    pins, fit = gripper.get("pins"), values["printer.fit_mm"]
    bolts = gripper.get("bolt_spacing_mm", 0.0)
    if not printer or not pins or pins["spacing_mm"] == bolts:  # of sleeves round the bolts
        return
    radii = [hole / 2 + fit for hole in (gripper["bolt_hole_mm"], pins["hole_mm"])]
    wall = abs(pins["spacing_mm"] - bolts) / 2 - sum(radii)
    if wall < printer["line_mm"] - 1e-9:
        yield f"block: {wall:.2f} mm between bolt and pins, a line of {printer['line_mm']:g} mm"


LIMITS = (
    _page,
    _bed,
    _land_patterns,
    _lines,
    _cover,
    _inputs,
    _step_down,
    _module,
    _base,
    _plate,
    _nut,
    _bending,
    _groove,
    _block,
)
