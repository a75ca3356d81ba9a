"""The sketch folder: the code that all designs share, and `layout.h` and `protocol.h` of this
one."""

import json
import math
from binascii import crc_hqx
from collections.abc import Iterable

from lumitip.layout import Layout
from lumitip.protocol import bluetooth as legacy
from lumitip.protocol import bluetooth as uuids
from lumitip.protocol import packet
from lumitip_fab.design import Controller, Design, Title, Wiring
from lumitip_fab.design.electrical import Electrical
from lumitip_fab.paths import firmware_sources
from lumitip_fab.pipeline.artefact import Artefact

_HEAD = """\
// Written by lumitip-fab for {title}. Do not edit: build the design again.
#pragma once

#include <stdint.h>
"""


def layout_header(
    layout: Layout, wiring: Wiring, controller: Controller, electrical: Electrical, title: Title
) -> str:
    """Cells and how they are wired."""
    lines = len(wiring.select_pins)
    line_pf = electrical.channel.line_pf + electrical.channel.detector_pf
    return f"""{_head(title)}
// Pins of {json.dumps(controller.title)}: one analog input for each multiplexer, U1 first; select
// lines, lowest bit first.
#define LUMITIP_ADC_PINS {", ".join(map(_pin, wiring.adc_pins))}
#define LUMITIP_SELECT_PINS {", ".join(map(_pin, wiring.select_pins))}
{_switching(wiring, electrical)}
namespace lumitip {{

constexpr char LAYOUT_HASH[] = "{layout.design_hash}";

constexpr uint16_t CELLS = {len(layout)};
constexpr uint16_t MUXES = {wiring.muxes};
constexpr uint8_t SELECT_LINES = {lines};
constexpr uint16_t CHANNELS = {2**lines};
constexpr uint8_t ADC_BITS = {controller.adc_bits};
constexpr uint32_t PULL_UP_OHM = {round(layout.optics.pull_up_ohm)};
constexpr uint32_t LINE_PF = {math.ceil(line_pf)};  // what the pull-up charges
// What a photodetector needs after a change of input; 0 where it is not known.
constexpr uint32_t DETECTOR_US = {math.ceil(electrical.channel.wait_us or 0)};

// Multiplexer of each cell, 0 is U1, in frame order.
constexpr uint16_t MUX[CELLS] = {{
{_table(layout.mux.tolist())}
}};

// Input of that multiplexer.
constexpr uint8_t CHANNEL[CELLS] = {{
{_table(layout.channel.tolist())}
}};

}}  // namespace lumitip
"""


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
    return f"""{_head(title)}
#define LUMITIP_DEVICE_NAME {_text(controller.name)}

namespace lumitip {{

constexpr uint8_t MAGIC = 0x{packet.MAGIC:02x};
constexpr uint8_t VERSION = {packet.VERSION};
constexpr uint16_t DESIGN_CODE = 0x{packet.design_code(layout.design_hash):04x};
constexpr uint8_t DESIGN_HASH[8] = {{{code}}};

constexpr char SERVICE_UUID[] = "{uuids.SERVICE}";
constexpr char FRAMES_UUID[] = "{uuids.FRAMES}";
constexpr char STATUS_UUID[] = "{uuids.STATUS}";
constexpr char LEGACY_SERVICE_UUID[] = "{_short(legacy.LEGACY_SERVICE)}";
constexpr char LEGACY_FRAMES_UUID[] = "{_short(legacy.LEGACY_FRAMES)}";

// The layout.h that this file was made with; the compiler holds the two against each other.
constexpr char PROTOCOL_HASH[] = "{layout.design_hash}";
constexpr uint16_t WIRING_SUM = 0x{wiring_sum(layout):04x};

}}  // namespace lumitip
"""


def wiring_sum(layout: Layout) -> int:
    """CRC of multiplexer (two bytes) and channel of each cell in turn, as `wiring.h` has it."""
    pairs = zip(layout.mux.tolist(), layout.channel.tolist(), strict=True)
    records = (bytes([mux & 0xFF, mux >> 8, channel]) for mux, channel in pairs)
    return crc_hqx(b"".join(records), 0xFFFF)


def _head(title: Title) -> str:
    # Quoted as JSON, a name can neither end the comment nor continue it on the next line.
    return _HEAD.format(title=f"{json.dumps(title.name)}, revision {title.revision}")


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
