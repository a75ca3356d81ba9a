"""The emitter's sheet: each string is a row, from the supply on the left to ground."""

from lumitip_fab.boards.circuit import GROUND
from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.model import Component
from lumitip_fab.design import Point, Wiring

LED_MM = 12.7
STRING_MM = 22.86
_BEFORE_MM = 30.48


def size_mm(wiring: Wiring) -> Point:
    """Width and height of the strings."""
    longest = max(len(string) for string in wiring.strings)
    return _BEFORE_MM + longest * LED_MM + 20.32, len(wiring.strings) * STRING_MM


def draw_strings(
    sheet: Sheet, at: Point, wiring: Wiring, parts: dict[str, Component], supply: str
) -> None:
    """Every string with its resistor."""
    for number, string in enumerate(wiring.strings, start=1):
        x, y = at[0], at[1] + (number - 1) * STRING_MM + 12.7
        caption = f"String {number}: {len(string)} LEDs, {wiring.current_ma[number - 1]:.1f} mA"
        sheet.texts.append((caption, (x, y - 10.16), 1.8))
        sheet.power(supply, (x + 5.08, y))
        resistor = parts[f"R{number}"]
        sheet.wire((x + 5.08, y), (x + 8.89, y))
        sheet.symbols.append(
            Drawn(
                "R",
                resistor.ref,
                resistor.value,
                x + 12.7,
                y,
                90,
                ref_at=(0, -2.54),
                value_at=(0, 2.54),
            )
        )
        end = x + 16.51
        for place, cell in enumerate(string):
            middle = x + _BEFORE_MM + place * LED_MM
            sheet.wire((end, y), (middle - 3.81, y))
            net = dict(parts[f"R{number}"].nets)["2"] if not place else f"S{number}_{place}"
            sheet.flag(net, ((end + middle - 3.81) / 2 // 1.27 * 1.27, y), 270)
            led = parts[f"D{cell + 1}"]
            sheet.symbols.append(Drawn("LED", led.ref, led.value, middle, y, ref_at=(0, -5.08)))
            end = middle + 3.81
        sheet.wire((end, y), (end + 5.08, y))
        sheet.power(GROUND, (end + 5.08, y))
