"""The sketch folder: the code that all designs share, and `layout.h` and `protocol.h` of this
one."""

import json
import math
from binascii import crc_hqx
from collections.abc import Iterable

from lumitip.layout import Layout
from lumitip.protocol import bluetooth, packet
from lumitip_fab.design import Controller, Design, Title, Wiring
from lumitip_fab.design.electrical import Electrical
from lumitip_fab.paths import firmware_sources
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import passage


def layout_header(
    layout: Layout, wiring: Wiring, controller: Controller, electrical: Electrical, title: Title
) -> str:
    """Cells and how they are wired."""
    lines = len(wiring.select_pins)
    line_pf = electrical.channel.line_pf + electrical.channel.detector_pf
    return (
        _head(title)
        + "\n"
        + passage("firmware/headers.txt", "layout").format(
            board=json.dumps(controller.title),
            adc_pins=", ".join(map(_pin, wiring.adc_pins)),
            select_pins=", ".join(map(_pin, wiring.select_pins)),
            switching=_switching(wiring, electrical),
            layout=layout,
            cells=len(layout),
            wiring=wiring,
            lines=lines,
            channels=2**lines,
            controller=controller,
            pull_up_ohm=round(layout.optics.pull_up_ohm),
            line_pf=math.ceil(line_pf),
            detector_us=math.ceil(electrical.channel.wait_us or 0),
            mux=_table(layout.mux.tolist()),
            channel=_table(layout.channel.tolist()),
        )
    )


def _switching(wiring: Wiring, electrical: Electrical) -> str:
    """Settings of a design whose LEDs are switched; empty where they are always on."""
    ambient = electrical.ambient
    if wiring.emitter_pin is None or ambient is None:
        return ""
    settings = (
        ("LUMITIP_EMITTER_PIN", _pin(wiring.emitter_pin), "high turns the LEDs on"),
        ("LUMITIP_EMITTER_US", math.ceil(ambient.light_us), "until light and detectors are steady"),
        ("LUMITIP_PERIOD_US", ambient.period_us, "from frame to frame, for both scans"),
    )
    lines = "\n".join(
        f"#ifndef {name}\n#define {name} {value}  // {words}\n#endif"
        for name, value, words in settings
    )
    return f"""
// Every frame is scanned without the LEDs and with them.
{lines}
"""


def protocol_header(layout: Layout, controller: Controller, title: Title) -> str:
    """Device name and UUIDs, and the checksum that ties it to `layout.h`."""
    code = ", ".join(f"0x{byte:02x}" for byte in bytes.fromhex(layout.design_hash)[:8])
    return (
        _head(title)
        + "\n"
        + passage("firmware/headers.txt", "protocol").format(
            name=_text(controller.name),
            packet=packet,
            design_code=packet.design_code(layout.design_hash),
            code=code,
            uuids=bluetooth,
            layout=layout,
            legacy_service=_short(bluetooth.LEGACY_SERVICE),
            legacy_frames=_short(bluetooth.LEGACY_FRAMES),
            wiring_sum=wiring_sum(layout),
        )
    )


def wiring_sum(layout: Layout) -> int:
    """CRC of multiplexer (two bytes) and channel of each cell in turn, as `wiring.h` has it."""
    pairs = zip(layout.mux.tolist(), layout.channel.tolist(), strict=True)
    records = (bytes([mux & 0xFF, mux >> 8, channel]) for mux, channel in pairs)
    return crc_hqx(b"".join(records), 0xFFFF)


def _head(title: Title) -> str:
    # Quoted as JSON, a name can neither end the comment nor continue it on the next line.
    return passage("firmware/headers.txt", "head").format(
        title=f"{json.dumps(title.name)}, revision {title.revision}"
    )


def _pin(name: str) -> str:
    """A pin as Arduino's functions take it: D6 is 6, as not every board package names it."""
    return name[1:] if name[0] == "D" and name[1:].isdigit() else name


def _text(text: str) -> str:
    """A C++ string of the text's UTF-8."""
    return '"' + "".join(map(_byte, text.encode())) + '"'


def _byte(byte: int) -> str:
    """One byte within a C++ string. Question marks are escaped, since three characters may stand
    for one; an octal number ends after three digits, whatever follows."""
    letter = chr(byte)
    if letter in '"\\?':
        return f"\\{letter}"
    return letter if letter.isascii() else f"\\{byte:03o}"


def _short(uuid: str) -> str:
    """The 16 bits that differ from Bluetooth's base."""
    return uuid[4:8]


def _table(values: Iterable[int]) -> str:
    items = [f"{value}," for value in values]
    return "\n".join("    " + " ".join(items[i : i + 16]) for i in range(0, len(items), 16))


def firmware_files(design: Design) -> tuple[Artefact, ...]:
    """The sketch folder, whose name and that of the sketch are the same, as Arduino asks."""
    layout, controller, title = design.layout, design.controller, design.title
    header = layout_header(layout, design.wiring, controller, design.electrical, title)
    files = {
        "layout.h": header.encode("ascii"),
        "protocol.h": protocol_header(layout, controller, title).encode("ascii"),
    }
    files |= {source.name: source.read_bytes() for source in firmware_sources()}
    return tuple(Artefact(f"firmware/{name}", files[name], frame="") for name in sorted(files))
