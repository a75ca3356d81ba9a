"""The board in the flange: from the robot's contacts over fuse, MOSFET and regulator to cables.

```
╭──────────────────────────╮
│   [ header J3, 2 rows ]  │
│  C4  L1  C2 C3           │   SW ─ L1 ─ 5V; C2, C3 beside L1's output
│  U1 C1 R3     [contacts] │   C1 at VIN and GND of U1: the hot loop
│  R1 Q1 R2  F1  J1        │   24V_IN ─ F1 ─ FUSED ─ Q1 ─ 24V ─ R3 ─ VIN
│                D1        │   D1 from 24V to GND
│   [ header J2, 2 rows ]  │
╰──────────────────────────╯
```

With a module as its controller it is wider to the left: see `lumitip_fab.derive.boards.module`.
"""

from lumitip_fab.catalogue.controllers import OPEN
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import flange_circuit
from lumitip_fab.derive.boards.indicator import NOTE, flange_indicator, flange_probes
from lumitip_fab.derive.boards.module import Supplies, derive_module
from lumitip_fab.derive.boards.packages import capacitor
from lumitip_fab.derive.boards.supply_input import (
    FUSED,
    Places,
    input_nets,
    input_parts,
    is_regulated,
)
from lumitip_fab.derive.boards.ties import derive_ties
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.mount.base import refuse_base, refuse_module
from lumitip_fab.derive.mount.fasteners import BOARD_SCREW
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import AuxiliaryBoard, Box, Component, Point
from lumitip_fab.design.components import (
    chip,
    fiducials,
    from_behind,
    leaded,
    resistor,
    strip,
)

BOX = Box(-15.4, 15.4, -27.0, 27.0)
CORNER_MM = 8.0
"""Inside the spigot of 70.7 mm of the published flange, whose board reaches as far."""
CONTACTS_AT: Point = (7.46, 0.0)
HEADERS_AT: tuple[Point, Point] = ((-3.5, -19.05), (-3.5, 19.05))
TITLE_AT: Point = (6.0, 12.5)
INPUT_AT = Places(
    fuse=((5.4, -7.0), 180.0),
    transistor=((-1.0, -7.0), 270.0),
    upper=((-5.2, -7.0), 90.0),
    lower=((-2.0, -3.8), 0.0),
    tvs=((9.4, -10.8), 0.0),
)
INRUSH_AT: Point = (-2.3, 0.0)
HOLES_AT: tuple[Point, ...] = ((11.0, 19.5), (11.0, -19.5))
INPUT = "VIN"
"""Net of the regulator's input."""
BUILT_IN = frozenset({"SUPPLY", "SUPPLY_IN", "GND", "REGULATED", OPEN})
"""Signals that are not lines from a contact to a header of the same name."""
FIDUCIALS_AT: tuple[Point, ...] = ((-13.0, -13.5), (13.0, -15.5), (-13.0, 13.5))


def derive_flange(
    config: Input, strings: Strings, muxing: Muxing, faults: Diagnostics
) -> tuple[AuxiliaryBoard, ...]:
    """The flange's board, with the controller if that is a module; none if it is not wanted."""
    p = config.parameters
    module = config.parts.controller.board.module
    if not p.flange.enabled:
        refuse_module(config, faults)
        return ()
    refuse_base(config, faults)
    _refuse(config, faults)
    flange_circuit.refuse_map(config, faults)
    flange_circuit.refuse_parts(config, strings, faults)
    raw, supply, output = _supplies(config)
    wing = derive_module(config, module, muxing, Supplies(supply, output), BOX, faults)
    light = flange_indicator(config, output)
    module_parts = wing.components if wing else ()
    parts = (*input_parts(config, INPUT_AT), *_regulator(config), *light, *module_parts)
    _refuse_lines(config, parts, faults)
    behind = ("SW", INPUT) if is_regulated(config) else ()
    components = (
        *_strips(config),
        *parts,
        *flange_probes(config, (raw, supply, output), faults),
        *fiducials(wing.fiducials if wing else FIDUCIALS_AT),
    )
    box = wing.box if wing else BOX
    hole_mm = config.catalogue.fasteners[BOARD_SCREW].hole_mm[0]
    screws = [(at, hole_mm) for at in HOLES_AT]
    return (
        AuxiliaryBoard(
            name="flange",
            title="breakout flange",
            title_at=TITLE_AT,
            box=box,
            corner_mm=CORNER_MM,
            holes=HOLES_AT,
            hole_mm=hole_mm,
            ties=derive_ties(components, box, CORNER_MM, screws, "controller.board", faults),
            components=components,
            notes=(NOTE,) if light else (),
            supplies=tuple(dict.fromkeys(("GND", supply, raw, FUSED, output, *behind))),
            keep_outs=wing.keep_outs if wing else (),
            hot_loop=_hot_loop(config),
        ),
    )


def _hot_loop(config: Input) -> tuple[tuple[str, str], ...]:
    """The leads round which the regulator's input current switches; none without it."""
    if not is_regulated(config):
        return ()
    names = config.parts.flange.regulator.names
    vin, ground = (str(names.index(name) + 1) for name in ("VIN", "GND"))
    return ("U1", vin), ("C1", "1"), ("C1", "2"), ("U1", ground)


def _supplies(config: Input) -> tuple[str, str, str]:
    """Nets of the contacts' supply, of the same after the MOSFET, and of the regulator."""
    return *input_nets(config), f"{config.parts.flange.regulator.output_v:g}V"


def _strips(config: Input) -> tuple[Component, ...]:
    """Contacts and headers."""
    p, parts = config.parameters.flange, config.parts.flange
    raw, supply, output = _supplies(config)
    called = {"SUPPLY": supply, "SUPPLY_IN": raw, "REGULATED": output}
    nets = tuple(raw if signal == "SUPPLY" else signal for signal in p.signals)
    names = tuple(called.get(signal, signal) for signal in p.signals)
    coupling = parts.coupling
    x, y = coupling.contacts_at_mm
    places = [(contact.at_mm[0] - x, contact.at_mm[1] - y) for contact in coupling.contacts]
    rows = strip("J1", p.contacts, parts.contacts, nets, CONTACTS_AT, names)
    contacts = from_behind(rows, places)
    both = []
    for ref, at, signals in zip(("J2", "J3"), HEADERS_AT, p.headers, strict=True):
        # Contacts are counted from the left of one who looks where the cable goes.
        counted = signals if at[1] > 0 else reversed(signals)
        each = parts.header.rows
        across = tuple(called.get(signal, signal) for signal in counted for _ in range(each))
        both.append(strip(ref, p.header, parts.header, across, at, across))
    return contacts, *both


def _regulator(config: Input) -> tuple[Component, ...]:
    """The regulator with its input capacitor across VIN and GND, the resistor before them, and
    what hangs on SW; nothing where the supply is what it would make."""
    p, parts = config.parameters.flange, config.parts.flange
    if not is_regulated(config):
        return ()
    _, supply, output = _supplies(config)
    leads = {"FB": output, "EN": INPUT, "VIN": INPUT, "GND": "GND", "SW": "SW", "BST": "BST"}
    return (
        resistor("R3", p.inrush_ohm, parts.inrush_resistor, (supply, INPUT), INRUSH_AT, 270.0),
        leaded("U1", "regulator", p.regulator, parts.regulator, leads, (-7.5, 0.0), 0.0),
        capacitor(config, "C1", p.input_capacitor, (INPUT, "GND"), (-4.9, 0.0), 90.0),
        capacitor(config, "C4", p.boot_capacitor, ("BST", "SW"), (-10.8, 2.1), 90.0),
        chip(
            "L1",
            "inductor",
            p.inductor.split()[0],
            parts.inductor,
            ("SW", output),
            (-7.5, 5.2),
            90.0,
        ),
        capacitor(config, "C2", p.output_capacitor, (output, "GND"), (-4.2, 5.8), 270.0),
        capacitor(config, "C3", p.output_capacitor, (output, "GND"), (-1.8, 5.8), 270.0),
    )


def _refuse(config: Input, faults: Diagnostics) -> None:
    """Refuse headers of another size, signals that lead nowhere, and voltages beyond the parts'."""
    p, parts = config.parameters.flange, config.parts.flange
    volts = config.parameters.supply.voltage_v
    strip = parts.header
    counts = [len(signals) for signals in p.headers]
    faults.unless(
        strip.rows == 2 and all(count == strip.ways for count in counts),
        "header_ways",
        strip=strip,
        counts=" and ".join(map(str, counts)),
    )
    cables = {*p.headers[0], *p.headers[1]}
    lost = sorted((set(p.signals) ^ cables) - BUILT_IN)
    faults.unless(not lost, "signal_at_one_end", lost=", ".join(lost))
    _refuse_unfed(config, faults)
    absent = sorted({"SUPPLY", "GND"} - set(p.signals))
    faults.unless(
        not absent and "REGULATED" not in p.signals, "signals_needed", signals=", ".join(p.signals)
    )
    least, most = flange_circuit.supply_range_v(config)
    faults.unless(
        not is_regulated(config) or least <= volts <= most,
        "flange_supply",
        least=least,
        most=most,
        parts=parts,
    )


def _refuse_unfed(config: Input, faults: Diagnostics) -> None:
    """Refuse headers of which none has every net that the breakout is fed with by one cable."""
    p, regulated = config.parameters, is_regulated(config)
    if not p.breakout.enabled or config.parts.controller.board.plug is None:
        return
    needed = ("GND", "SUPPLY", *["REGULATED"] * regulated)
    as_one = {} if regulated else {"REGULATED": "SUPPLY"}
    missing = min(
        ([s for s in needed if s not in {as_one.get(n, n) for n in h}] for h in p.flange.headers),
        key=len,
    )
    faults.unless(not missing, "header_unfed", missing=", ".join(missing), needed=", ".join(needed))


def _refuse_lines(config: Input, parts: tuple[Component, ...], faults: Diagnostics) -> None:
    """Refuse lines from contact to cable that are called like a net of the board's own parts:
    they would be joined."""
    p = config.parameters.flange
    own = {net for part in parts for _, net in part.nets} | set(_supplies(config))
    lines = {*p.signals, *p.headers[0], *p.headers[1]} - BUILT_IN
    taken = sorted(lines & own)
    faults.unless(not taken, "net_taken", taken=", ".join(taken))
