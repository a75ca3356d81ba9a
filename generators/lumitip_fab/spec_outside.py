"""Figures of what is outside the fingers, beside the published ones."""

from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.design import Carrier, Design, Holder


@dataclass(frozen=True)
class Row:
    """One figure: published, computed, and the reason where they differ."""

    quantity: str
    published: str
    computed: str
    reason: str = ""


def outside(design: Design) -> Iterator[Row]:
    """Rows of the boards and printed parts that the design has."""
    for carrier in design.carriers:
        if carrier.name == "breakout":
            yield from _breakout(carrier)
        else:
            yield from _flange(carrier)
    for holder in design.holders:
        yield from _holder(holder)


def _breakout(carrier: Carrier) -> Iterator[Row]:
    box = carrier.box
    spacing = carrier.holes[1][0] - carrier.holes[0][0]
    yield Row("controller breakout", "45.7 x 33.0 mm",
              f"{box.width_mm:.1f} x {box.length_mm:.1f} mm", "by breakout.board_mm")  # fmt: skip
    yield Row("its screw holes", "35.56 mm apart, in the holder 36.00", f"{spacing:.2f} mm apart",
              "one figure for board and holder, breakout.hole_spacing_mm")  # fmt: skip


def _flange(carrier: Carrier) -> Iterator[Row]:
    box = carrier.box
    yield Row("board of the flange", "32.8 x 63.5 mm",
              f"{box.width_mm:.1f} x {box.length_mm:.1f} mm",
              "a rectangle with round corners; published: one side is an arc")  # fmt: skip
    values = {device.ref: device.value for device in carrier.devices}
    yield Row("its supply", "AP63205, 4.7 uH, 10 uF, 2 x 22 uF",
              f"{values['U1']}, {values['L1']}, {values['C1']}, 2 x {values['C2']}",
              "parts of [flange]")  # fmt: skip
    yield Row("its fuse and reversed supply", "not stated",
              f"{values['F1']}, {values['Q1']}",
              "a MOSFET costs the LEDs no voltage, as a diode would")  # fmt: skip


def _holder(holder: Holder) -> Iterator[Row]:
    yield Row("cradle of the holder", "37.8 mm radius", f"{holder.cradle_mm:.1f} mm radius",
              f"round a body of {holder.body_mm:g} mm by holder.body_mm")  # fmt: skip
    yield Row("arms of the holder", "bolted with M4",
              f"clip round, to {holder.wrap_deg:g}° from the middle",
              "holder.wrap_deg beyond 90° holds without screws")  # fmt: skip
