"""The row of wire pads at the gripper end of each board."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import Connector

MOST_WIDE_WAYS = 9
POWER_WIRES = 2
"""Supply and ground of the receiver."""
GROUND = "GND"
CONTROLLER = "3V3"
"""Supply of the receiver, from the controller."""
REGULATED = "5V"
"""Supply of the controller, from the flange's regulator."""
SWITCH = "LED"
"""Signal that switches the LEDs, high is on."""
WIDE = (2.54, 2.286, 1.2)  # pitch, pad, drill: as published
NARROW = (1.27, 1.0, 0.6)


def receiver_signals(config: Input, muxing: Muxing) -> tuple[str, ...]:
    """Signals of the receiver's connector, in the order of `wiring.order`.

    Apart, both supplies lie between select and analog lines. Ground is beside the analog ones: of
    the two it is the quieter, as the detectors' current changes the 3.3 V.
    """
    selects = tuple(f"S{i}" for i in range(len(muxing.select_pins)))
    if config.parameters.wiring.order == "published":
        return ("GND", CONTROLLER, *selects, *muxing.adc_pins)
    return (*selects, CONTROLLER, "GND", *muxing.adc_pins)


def emitter_signals(config: Input) -> tuple[str, ...]:
    """Signals of the emitter's connector: ground and supply; where the LEDs are switched, the
    supply, ground and the switch, so that a bridge of solder from pad to pad does not lead the
    supply to the controller."""
    supply = lit_supply(config)
    return (supply, GROUND, SWITCH) if config.parts.emitter.switch else (GROUND, supply)


def lit_supply(config: Input) -> str:
    """Supply of the LEDs, such as `24V`."""
    return f"{config.parameters.supply.voltage_v:g}V"


def half_width_mm(ways: int, wide: bool) -> float:
    """Half the width of a connector over its pads."""
    pitch, pad, _ = WIDE if wide else NARROW
    return (ways - 1) / 2 * pitch + pad / 2


def place(signals: tuple[str, ...], supply: str, wide: bool, y_mm: float) -> Connector:
    """A connector centred on x = 0."""
    pitch, pad, drill = WIDE if wide else NARROW
    first = -(len(signals) - 1) / 2 * pitch
    pads = tuple((first + i * pitch, y_mm) for i in range(len(signals)))
    return Connector(signals, supply, pads, pitch, pad, drill)
