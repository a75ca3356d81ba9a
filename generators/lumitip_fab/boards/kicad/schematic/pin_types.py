"""Electrical types of the pins of chips, by the names that the catalogue gives to their leads.

Contacts are passive, as in KiCad's libraries: what is plugged in decides. A socket is the
controller that it is for.
"""

import re

from lumitip_fab.design import Component

_TYPES = {
    "regulator": {
        **dict.fromkeys(("VIN", "IN", "GND"), "power_in"),
        **dict.fromkeys(("FB", "EN"), "input"),
        "OUT": "power_out",
        "SW": "output",
    },
    "module": {
        **dict.fromkeys(("GND", "VDD", "VDDH", "VBUS"), "power_in"),
        "SWDCLK": "input",
        **dict.fromkeys(("SWDIO", "USB_DM", "USB_DP"), "bidirectional"),
    },
    "socket": {
        **dict.fromkeys(("GND", "VIN"), "power_in"),
        **dict.fromkeys(("3V3", "VUSB"), "power_out"),
        **dict.fromkeys(("RST", "REC", "RX"), "input"),
        "TX": "output",
    },
}
_PORT = re.compile(r"[AD]\d+|P\d_\d+")
"""Pins of a controller that its firmware makes inputs or outputs."""


def pin_type(part: Component, name: str) -> str:
    """Type of a part's pin, such as `"power_in"`; passive where its name says nothing."""
    known = _TYPES.get(part.kind, {})
    port = part.kind in ("module", "socket") and _PORT.fullmatch(name)
    return known.get(name, "bidirectional" if port else "passive")


def pin_names(part: Component) -> dict[str, str]:
    """Name of each pad; none where a part has no names."""
    return dict(zip((pad.number for pad in part.footprint.pads), part.pins, strict=False))
