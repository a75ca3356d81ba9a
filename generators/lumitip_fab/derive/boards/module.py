"""A module as the controller, on a wing of the flange's board to the left of all else.

```
╭───────────────────╮
│  J6 USB           │   the module's antenna is at the edge
│  J7 SWD   C5 U3 C6│   5V ─ U3 ─ 3V3
│  Z                │
│▒▒┌──────────────┐C10   of VBUS
│▒▒│      U2      │C7    of VDD
│▒▒└──────────────┘C9
│  R R R R R C C C C│Y1   see `lumitip_fab.derive.boards.module_protection`
│       J5          │C8
│  Z Z Z Z Z Z Z Z Z│
│  J4               │   wires to the receiver, and (J5) to the emitter
╰───────────────────╯
```

▒ is the keep-out. The other parts are placed round the module's body.
"""

from dataclasses import dataclass

from lumitip_fab.catalogue.controllers import Module
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.derive.boards.breakout import switching
from lumitip_fab.derive.boards.connectors import CONTROLLER
from lumitip_fab.derive.boards.module_protection import module_protection, refuse_row
from lumitip_fab.derive.boards.packages import capacitor
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import protection
from lumitip_fab.derive.wiring.wiring import Muxing, larger_multiplexers
from lumitip_fab.design import Box, Component, Point, footprints
from lumitip_fab.design.components import chip, leaded, mounted, wires

WING_MM = 12.6
"""Width beyond the board without a module; the bolts of the published flange limit it."""
MODULE_Y_MM = 1.0
"""Middle of the module: below it is room for resistors and capacitors."""
TURN_DEG = 90.0  # the antenna, at the top of the module's own frame, to the left
MOST_WIRES = 9
"""In the row to the receiver, between the board's round corner and the header."""
J4_AT: Point = (-20.1, -20.85)
J5_END_MM, J5_Y_MM = -15.63, -12.85
"""Last pad of the row to the emitter: beyond it the floor holds a bolt of the flange."""
J7_AT: Point = (-20.52, 15.2)
"""Between a panel's tab at the board's edge and a bolt of the flange."""
FIDUCIALS_AT: tuple[Point, ...] = ((-25.6, 8.4), (13.0, -15.5), (-26.3, -10.9))
_NAMED = {
    "GND": "GND",
    "VDD": CONTROLLER,
    "VDDH": CONTROLLER,
    "VBUS": "VUSB",
    "USB_DM": "D-",
    "USB_DP": "D+",
    "SWDIO": "DIO",
    "SWDCLK": "CLK",
    "P0_18": "RST",
}


@dataclass(frozen=True)
class Supplies:
    """Nets that the flange's board has: the LEDs' supply, and the controller's."""

    leds: str
    regulated: str


@dataclass(frozen=True)
class Wing:
    """Additions of a module to the flange's board, and the board's box with them."""

    box: Box
    components: tuple[Component, ...]
    fiducials: tuple[Point, ...]
    keep_outs: tuple[Box, ...]


def derive_module(
    config: Input,
    module: Module | None,
    muxing: Muxing,
    supplies: Supplies,
    box: Box,
    faults: Diagnostics,
) -> Wing | None:
    """The module with what it needs; none where the controller is not one."""
    if module is None:
        return None
    _refuse(config, muxing, faults)
    refuse_row(config, muxing, faults)
    left = box.x_min_mm - WING_MM
    at = left + module.body_mm[1] / 2, MODULE_Y_MM
    receiver, lit = connectors.receiver_signals(config, muxing), connectors.emitter_signals(config)
    pitch = connectors.WIDE[0]
    components = (
        _module(config, module, muxing, at),
        *_beside(config),
        *_supply(config, supplies),
        wires("J4", receiver, connectors.NARROW, J4_AT),
        wires("J5", lit, connectors.WIDE, (J5_END_MM - (len(lit) - 1) / 2 * pitch, J5_Y_MM)),
        wires("J6", ("VUSB", "D-", "D+", "GND"), connectors.WIDE, (-21.0, 20.25)),
        wires("J7", (CONTROLLER, "DIO", "CLK", "RST", "GND"), connectors.WIDE, J7_AT),
        # Last, since references find room in this order, and small parts can do without.
        *module_protection(config, module, muxing, (receiver, J4_AT)),
    )
    return Wing(
        box=Box(left, box.x_max_mm, box.y_min_mm, box.y_max_mm),
        components=components,
        fiducials=FIDUCIALS_AT,
        keep_outs=tuple(
            # Turned by a quarter: (x, y) becomes (-y, x).
            Box(at[0] - high, at[0] - low, at[1] + x_min, at[1] + x_max)
            for x_min, low, x_max, high in module.keep_out_mm
        ),
    )


def _module(config: Input, module: Module, muxing: Muxing, at: Point) -> Component:
    """The module; a pin of the sketch names its pad, any other pad is called by its port."""
    pins = {port: pin for pin, port in module.ports.items()}
    nets = _NAMED | dict(zip(module.crystal, ("XL1", "XL2"), strict=True))
    used = {pin: pin for pin in muxing.adc_pins}
    used |= {pin: f"S{i}" for i, pin in enumerate(muxing.select_pins)} | switching(config)
    nets |= {
        module.ports[pin]: protection.pin_net(config, muxing, net) for pin, net in used.items()
    }
    return mounted(
        "U2",
        "module",
        config.title("controller.board"),
        module,
        footprints.module(module),
        tuple((str(i), nets[name]) for i, name in enumerate(module.names, 1) if name in nets),
        at,
        TURN_DEG,
        tuple(pins.get(name, name) for name in module.names),
    )


def _supply(config: Input, supplies: Supplies) -> tuple[Component, ...]:
    """The linear regulator with a capacitor before and after it."""
    p, fed = config.parameters.module, supplies.regulated
    entry = config.parts.module.regulator
    leads = {"IN": fed, "OUT": CONTROLLER, "GND": "GND"}
    return (
        leaded("U3", "regulator", p.regulator, entry, leads, (-17.5, 9.8), 0.0),
        capacitor(config, "C5", p.supply_capacitor, (fed, "GND"), (-14.4, 10.8), 0.0),
        capacitor(config, "C6", p.supply_capacitor, (CONTROLLER, "GND"), (-14.4, 8.6), 0.0),
    )


def _beside(config: Input) -> tuple[Component, ...]:
    """Parts near the module's pads: capacitors of its supplies, and the crystal."""
    p = config.parameters.module
    entry, value = config.parts.module.crystal, p.crystal.split()[0]
    return (
        capacitor(config, "C7", p.capacitor, (CONTROLLER, "GND"), (-11.2, 5.2), 90.0),
        capacitor(config, "C10", p.supply_capacitor, ("VUSB", "GND"), (-11.2, 10.2), 90.0),
        chip("Y1", "crystal", value, entry, ("XL1", "XL2"), (-11.3, -7.2), 90.0),
        capacitor(config, "C8", p.crystal_capacitor, ("XL1", "GND"), (-11.3, -11.4), 270.0),
        capacitor(config, "C9", p.crystal_capacitor, ("XL2", "GND"), (-11.4, -3.7), 270.0),
    )


def _refuse(config: Input, muxing: Muxing, faults: Diagnostics) -> None:
    """Refuse a regulator that does not go between the supplies, and more wires than have room."""
    regulator = config.parts.module.regulator
    controller = config.parts.controller.board
    fed_v = config.parts.flange.regulator.output_v
    least, most = regulator.input_v
    faults.unless(
        least <= fed_v <= most and regulator.output_v == controller.supply_v,
        "module_regulator",
        regulator=regulator,
        least=least,
        most=most,
        controller=controller,
        fed_v=fed_v,
    )
    needed_a = controller.draws_ma / 1000
    faults.unless(
        needed_a <= regulator.output_a,
        "module_regulator_current",
        output_ma=1000 * regulator.output_a,
        controller=controller,
    )
    wires_needed = len(connectors.receiver_signals(config, muxing))
    faults.unless(
        wires_needed <= MOST_WIRES,
        "module_wires",
        most_wires=MOST_WIRES,
        wires_needed=wires_needed,
        cells=_most_cells(config),
        larger=larger_multiplexers(config),
    )


def _most_cells(config: Input) -> int:
    """Cells that the wires from the receiver can carry with its multiplexers."""
    mux = config.parts.receiver.multiplexer
    return mux.channels * (MOST_WIRES - connectors.POWER_WIRES - len(mux.select))
