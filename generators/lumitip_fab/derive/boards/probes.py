"""Test points of the flange's board: pads to hold a probe to, on the side that is open on a bench.

```
│ [ header J3 ]  5V 24V GND │   the outputs, beside the header that they leave by
│       24V_IN              │   above the contacts
│ [ header J2 ]  485+       │   data lines, beside the header that they leave by
│                485-       │
```

The breakout has none: its wire pads have the same nets and their names.
"""

from lumitip_fab.catalogue.controllers import OPEN
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Component, Point
from lumitip_fab.design.components import probe

PAD_MM = 1.5
"""Wide enough for the tip of a probe that is held by hand."""
OUTPUT_AT: Point = (6.9, 17.3)
SUPPLY_AT: Point = (9.6, 17.3)
GROUND_AT: Point = (12.5, 17.3)
INPUT_AT: Point = (3.9, 7.4)
DATA_AT: tuple[Point, ...] = ((6.6, -15.65), (6.6, -17.4), (6.6, -13.9))


def flange_probes(
    config: Input, supplies: tuple[str, str, str], faults: Diagnostics
) -> tuple[Component, ...]:
    """A test point for each supply, for ground and for each data line of the coupling.

    Args:
        config: the input.
        supplies: nets of the contacts' supply, of the same after the MOSFET, and of the output.
        faults: where more data lines than there is room for are refused.
    """
    raw, supply, output = supplies
    lines = _data_lines(config)
    faults.refuse_unless(
        len(lines) <= len(DATA_AT),
        "flange.signals",
        f"has {', '.join(lines)} on data contacts; test points of {len(DATA_AT)} have room. Leave "
        f"contacts open ({OPEN}).",
    )
    places = dict(zip(lines, DATA_AT, strict=False))
    places |= {raw: INPUT_AT, supply: SUPPLY_AT, "GND": GROUND_AT, output: OUTPUT_AT}
    return tuple(
        probe(f"TP{number}", net, at, "front", PAD_MM)
        for number, (net, at) in enumerate(places.items(), start=1)
    )


def _data_lines(config: Input) -> tuple[str, ...]:
    """Signals on the coupling's data contacts, which go on to a header; each once."""
    contacts = config.parts.flange.coupling.contacts
    signals = zip(config.parameters.flange.signals, contacts, strict=False)
    lines = (signal for signal, contact in signals if contact.kind == "data" and signal != OPEN)
    return tuple(dict.fromkeys(lines))
