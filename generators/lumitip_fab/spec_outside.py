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
    for holder in design.holders:
        yield from _holder(holder)


def _breakout(carrier: Carrier) -> Iterator[Row]:
    box = carrier.box
    spacing = carrier.holes[1][0] - carrier.holes[0][0]
    yield Row("controller breakout", "45.7 x 33.0 mm",
              f"{box.width_mm:.1f} x {box.length_mm:.1f} mm", "by breakout.board_mm")  # fmt: skip
    yield Row("its screw holes", "35.56 mm apart, in the holder 36.00", f"{spacing:.2f} mm apart",
              "one figure for board and holder, breakout.hole_spacing_mm")  # fmt: skip


def _holder(holder: Holder) -> Iterator[Row]:
    yield Row("cradle of the holder", "37.8 mm radius", f"{holder.cradle_mm:.1f} mm radius",
              f"round a body of {holder.body_mm:g} mm by holder.body_mm")  # fmt: skip
    yield Row("arms of the holder", "bolted with M4",
              f"clip round, to {holder.wrap_deg:g}° from the middle",
              "holder.wrap_deg beyond 90° holds without screws")  # fmt: skip
