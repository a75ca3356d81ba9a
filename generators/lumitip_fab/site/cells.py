"""Parts, nets and places of each cell, read from the boards' copper, `layout.json`, the list of
cables and the firmware; where two files disagree, both are named."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lumitip.layout import Layout
from lumitip_fab.checks.readers.kicad_board import KicadBoard, Part
from lumitip_fab.design import Finger
from lumitip_fab.design.frames import on_board_page
from lumitip_fab.errors import OutputError
from lumitip_fab.site.folder import Folder, board_path
from lumitip_fab.site.wires import Wires, pads

FIRMWARE, LAYOUT = "firmware/layout.h", "layout.json"
_NEAR_MM = 0.2  # of a device to its cell


@dataclass(frozen=True)
class CellRecord:
    """Everything of one cell."""

    index: int
    """Index in frames, firmware and recordings."""
    parts: Mapping[str, str]
    """Parts of each board by role: `"led"`, `"detector"`, … as `board.reference`."""
    nets: tuple[str, ...]
    """Nets of this cell alone or of few, as `board:net`."""
    shared: tuple[str, ...]
    """Nets that it shares with its string, its multiplexer or all."""
    wires: tuple[str, ...]
    rows: tuple[tuple[str, str], ...]
    """Name and text of each line of its record."""
    faults: tuple[str, ...]
    """Where files disagree."""

    def data(self) -> dict[str, Any]:
        """The record as plain values."""
        return dict(vars(self))


def devices(board: KicadBoard, finger: Finger) -> list[Part]:
    """The LED or photodetector of each cell, by its place.

    Raises:
        OutputError: if a cell has none.
    """
    parts = [p for p in board.parts if p.front and p.ref.startswith(finger.cells_hold.letter)]
    found = []
    for index, cell in enumerate(finger.cells):
        x, y = on_board_page(cell)
        near = [p for p in parts if np.hypot(p.at[0] - x, p.at[1] - y) < _NEAR_MM]
        if len(near) != 1:
            raise OutputError(
                f"{board_path(finger.name)}: {len(near)} parts {finger.cells_hold.letter} lie on "
                f"cell {index}; one is needed. Build the design again."
            )
        found.append(near[0])
    return found


def firmware_arrays(folder: Folder) -> tuple[list[int], list[int]]:
    """Multiplexer and channel of each cell in the firmware.

    Raises:
        OutputError: if the header does not have both.
    """
    text = folder.text(FIRMWARE)
    arrays = []
    for name in ("MUX", "CHANNEL"):
        found = re.search(rf"{name}\[CELLS\] = \{{([^}}]*)\}}", text)
        values = [int(v) for v in re.findall(r"\d+", found[1])] if found else []
        if len(values) != len(folder.design.layout):
            raise folder.damaged(FIRMWARE, f"{len(values)} values of {name}")
        arrays.append(values)
    return arrays[0], arrays[1]


def cell_records(folder: Folder) -> list[CellRecord]:
    """The record of every cell.

    Raises:
        OutputError: if a file cannot be read.
    """
    try:
        layout = Layout.from_json(folder.text(LAYOUT))
    except ValueError as error:
        raise folder.damaged(LAYOUT, error) from error
    if layout.design_hash != folder.design.layout.design_hash:
        raise folder.damaged(LAYOUT, "it is of another design")
    return list(_Reader(folder, layout).records())


@dataclass
class _Notes:
    """Parts, rows and faults found on the way of one cell."""

    parts: dict[str, str] = field(default_factory=dict)
    rows: list[tuple[str, str]] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


class _Reader:
    """Follows each cell through the files."""

    def __init__(self, folder: Folder, layout: Layout) -> None:
        self.folder, self.design, self.layout = folder, folder.design, layout
        self.wires = Wires(folder)
        self.emitter, self.receiver = (folder.board(f) for f in ("emitter", "receiver"))
        chips = {f"U{int(mux) + 1}" for mux in layout.mux}
        output = str(self.design.packages.multiplexer.output)
        self.outputs = {
            terminal.net
            for part in self.receiver.parts
            for terminal in part.terminals
            if part.ref in chips and terminal.number == output
        }
        self.leds = devices(self.emitter, self.design.emitter)
        self.detectors = devices(self.receiver, self.design.receiver)
        self.firmware = firmware_arrays(folder)

    def records(self) -> Iterator[CellRecord]:
        for index in range(len(self.layout)):
            yield self._record(index)

    def _record(self, index: int) -> CellRecord:
        notes = _Notes()
        led_nets = self._light(index, notes)
        signal = self._detector(index, notes)
        line, select = self._multiplexer(index, signal, notes)
        wires, beyond = self._wires(line, notes)
        self._numbers(index, line, notes)
        shared = [line, *select] if line else []
        return CellRecord(
            index,
            notes.parts,
            (f"receiver:{signal}", *led_nets, *beyond),
            (*(f"receiver:{net}" for net in shared), *self._string_nets(index)),
            wires,
            tuple(notes.rows),
            tuple(notes.faults),
        )

    def _light(self, index: int, notes: _Notes) -> tuple[str, ...]:
        """Place, LED and hole; the nets of the LED."""
        layout, led, mask = self.layout, self.leds[index], self.design.mask
        notes.parts["led"] = f"emitter.{led.ref}"
        notes.rows += [
            ("Place", f"column {layout.column[index]}, row {layout.row[index]} from the tip"),
            ("x, y", f"{layout.x_mm[index]:.3f}, {layout.y_mm[index]:.3f} mm (receiver)"),
            ("LED", f"{led.ref}, {led.value}, emitter"),
            ("String", self._string(index)),
            ("Hole", f"{mask.holes_mm[index]:g} mm {mask.hole_shape}, both masks"),
        ]
        return tuple(f"emitter:{t.net}" for t in led.terminals if t.net != "GND")

    def _detector(self, index: int, notes: _Notes) -> str:
        """Photodetector; its net."""
        detector = self.detectors[index]
        own = [t.net for t in detector.terminals if t.net.startswith(detector.ref)]
        signal = own[0] if own else detector.ref
        notes.parts["detector"] = f"receiver.{detector.ref}"
        notes.rows += [
            ("Photodetector", f"{detector.ref}, {detector.value}, receiver"),
            ("Net", f"{signal}: {self._length(signal)}"),
        ]
        return signal

    def _multiplexer(self, index: int, signal: str, notes: _Notes) -> tuple[str, list[str]]:
        """Multiplexer and channel; the net of its output, and those of its select inputs."""
        package, channel = self.design.packages.multiplexer, int(self.layout.channel[index])
        named = f"U{int(self.layout.mux[index]) + 1}"
        chip = next((p for p in self.receiver.parts if p.ref == named), None)
        ends = pads(chip, signal) if chip else []
        notes.parts["multiplexer"] = f"receiver.{named}"
        if chip is None or not ends:
            file = board_path("receiver")
            notes.faults.append(f"{file}: net {signal} does not lead to {named}")
            return "", []
        nets = {t.number: t.net for t in chip.terminals}
        for pin in (*package.select, package.output):
            if str(pin) not in nets:
                raise self.folder.damaged(board_path("receiver"), f"{named} has no pad {pin}")
        select = [nets[str(pin)] for pin in package.select]
        bits = " ".join(f"{net}={channel >> bit & 1}" for bit, net in enumerate(select))
        line = nets[str(package.output)]
        notes.rows += [
            ("Multiplexer", f"{named}, {chip.value}, pin {ends[0]}"),
            ("Channel", f"{channel} ({bits})"),
            ("Output", f"pin {package.output}, net {line}"),
        ]
        wanted = str(package.inputs[str(channel)])
        if wanted not in ends:
            notes.faults.append(
                f"{LAYOUT} names channel {channel} (pin {wanted}), the copper ends at pin {ends[0]}"
            )
        for part in self.receiver.parts:
            if part.ref.startswith("R") and (pads(part, signal) or pads(part, line)):
                notes.parts["pull_up"] = f"receiver.{part.ref}"
                notes.rows.append(("Pull-up", f"{part.ref}, {part.value}"))
        return line, select

    def _wires(self, line: str, notes: _Notes) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Numbers of all wires that the cell needs, which are all but the outputs of the other
        multiplexers, and the nets beyond its analog wire."""
        analog = self.wires.of("receiver", line)
        beyond: tuple[str, ...] = ()
        if analog is not None:
            notes.rows.append(("Wire", _wire(analog)))
            way = self.wires.way(analog)
            beyond = way.nets
            notes.parts.update({f"beyond_{n}": part for n, part in enumerate(way.parts)})
            if way.steps:
                notes.rows.append((analog["to_board"].capitalize(), " → ".join(way.steps)))
        others = [("receiver", net) for net in self.outputs - {line}]
        rows = (row for row in self.wires.rows if (row["from_board"], row["signal"]) not in others)
        return tuple(row["wire"] for row in rows), beyond

    def _numbers(self, index: int, line: str, notes: _Notes) -> None:
        """Input of the controller, and indices in the firmware."""
        adc_pin = str(self.layout.adc_pin[index])
        mux, channel = self.firmware[0][index], self.firmware[1][index]
        notes.rows += [
            ("Analog input", f"{adc_pin} of the {self.design.controller.title}"),
            ("Firmware", f"MUX[{index}] = {mux}, CHANNEL[{index}] = {channel}"),
            ("Frame", f"value {index} of {len(self.layout)}"),
        ]
        if (mux, channel) != (self.layout.mux[index], self.layout.channel[index]):
            notes.faults.append(f"{FIRMWARE} reads U{mux + 1}, channel {channel}")
        if line and line != adc_pin:
            notes.faults.append(f"{LAYOUT} names {adc_pin}, the copper leads to {line}")

    def _length(self, net: str) -> str:
        """Length of a net's tracks on the receiver, by their area."""
        tracks = [c for c in self.receiver.loose if c.net == net and c.kind == "track"]
        vias = sum(c.net == net and c.kind == "via" for c in self.receiver.loose)
        along = sum((c.area.area - np.pi * c.width_mm**2 / 4) / c.width_mm for c in tracks)
        return f"{along:.1f} mm of track, {vias} via{'s' if vias != 1 else ''}"

    def _string(self, index: int) -> str:
        strings = self.design.wiring.strings
        for number, (string, current) in enumerate(
            zip(strings, self.design.wiring.current_ma, strict=True), start=1
        ):
            if index in string:
                place = string.index(index) + 1
                return f"{number} of {len(strings)}, LED {place} of {len(string)}, {current:.1f} mA"
        return "none"

    def _string_nets(self, index: int) -> tuple[str, ...]:
        """Nets of all LEDs of the same string."""
        string: Sequence[int] = next((s for s in self.design.wiring.strings if index in s), ())
        nets = {t.net for cell in string for t in self.leds[cell].terminals}
        return tuple(f"emitter:{net}" for net in sorted(nets - {"GND"}))


def _wire(row: dict[str, str]) -> str:
    return (
        f"{row['wire']} {row['signal']}, {row['colour']}, {row['length_mm']} mm, "
        f"{row['from_board']} {row['from_pad']} → {row['to_board']} {row['to_pad']}"
    )
