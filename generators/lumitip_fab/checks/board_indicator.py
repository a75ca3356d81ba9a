"""The power LED of the flange's board, followed along the copper, with its currents."""

import math
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.electrical import Indicator

LED, RESISTOR = "D2", "R4"
_CATHODE, _ANODE = "1", "2"
_COIL, _TVS = "L1", "D1"


def measure_indicator(read: ReadBoard) -> Iterator[Measurement]:
    """The way from the output over resistor and LED to ground, the side that the LED stands on, its
    currents, and the resistor's power; all from the values on the written board."""
    if not any(flange.auxiliary == read.name for flange in read.design.flanges):
        return
    for lit in read.design.electrical.indicators:
        yield read.count("indicator", list(_wrong(read)), "pads")
        resistor = ohm(read.parts[RESISTOR].value) if RESISTOR in read.parts else math.nan
        low_ma, high_ma, watt = _figures(lit, resistor)
        unseen = "at the lowest output, highest forward voltage and highest resistance"
        yield read.figure("indicator_dim", low_ma, lit.visible_ma, math.inf, "mA", unseen)
        yield read.figure("indicator_bright", high_ma, 0, lit.max_ma, "mA", "at the other ends")
        share = 100 * watt / lit.rated_w
        note = "of its resistor's rated power"
        yield read.figure("indicator_load", share, 0, 100 * lit.load, "%", note)


def _figures(lit: Indicator, resistor: float) -> tuple[float, float, float]:
    """Least and greatest current (mA), and the power of the resistor (W)."""
    least_v, most_v = lit.forward_v
    low_v = lit.output_v * (1 - lit.supply_tolerance) - most_v
    high_v = lit.output_v * (1 + lit.supply_tolerance) - least_v
    least_ohm = resistor * (1 - lit.resistor_tolerance)
    most_ohm = resistor * (1 + lit.resistor_tolerance)
    return 1000 * low_v / most_ohm, 1000 * high_v / least_ohm, high_v**2 / least_ohm


def _wrong(read: ReadBoard) -> Iterator[str]:
    """Pads that are not where they belong, and an LED that cannot be seen."""
    node = _ends(read) - {output_of(read), None}
    for ref, pad, found, wanted in (
        (RESISTOR, "supply end", {output_of(read)} & _ends(read), {output_of(read)}),
        (LED, "anode", {read.group(LED, _ANODE)}, node),
        (LED, "cathode", {read.group(LED, _CATHODE)}, {read.group(_TVS, "2")}),
    ):
        if not wanted or None in wanted or found != wanted:
            yield f"{ref}: {pad}"
    part = read.parts.get(LED)
    if part is not None and not part.front:
        yield f"{LED}: on the side of the contacts"


def _ends(read: ReadBoard) -> set[int | None]:
    return {read.group(RESISTOR, 1), read.group(RESISTOR, 2)}


def output_of(read: ReadBoard) -> int | None:
    """The output's copper: the coil's end away from the regulator; the supply behind the MOSFET
    where there is no regulator."""
    if _COIL not in read.parts:
        return read.group(_TVS, "1")
    names = next((device.pins for device in read.components if device.ref == "U1"), ())
    switch = read.group("U1", names.index("SW") + 1) if "SW" in names else None
    ends = {read.group(_COIL, 1), read.group(_COIL, 2)} - {switch, None}
    return ends.pop() if len(ends) == 1 else None
