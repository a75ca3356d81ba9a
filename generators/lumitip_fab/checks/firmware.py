"""The sketch folder against the layout: channel map, pins, identity and name in the written
headers, and all other files as they are shipped. That `layout.json` is the same layout is checked
in `layout`."""

import math
import re
from binascii import crc_hqx
from collections.abc import Iterator, Mapping
from pathlib import Path

from lumitip.layout import Layout
from lumitip.protocol import bluetooth, packet
from lumitip_fab.checks.places import files_in
from lumitip_fab.checks.readers.header import faults, uncommented
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design
from lumitip_fab.paths import firmware_sources
from lumitip_fab.pipeline.manifest import sha256_of

READS = ("firmware/*",)
_LAYOUT, _PROTOCOL = "firmware/layout.h", "firmware/protocol.h"
_SETTINGS = {
    _LAYOUT: (
        "LUMITIP_ADC_PINS",
        "LUMITIP_SELECT_PINS",
        "LUMITIP_EMITTER_PIN",
        "LUMITIP_EMITTER_US",
        "LUMITIP_PERIOD_US",
    ),
    _PROTOCOL: ("LUMITIP_DEVICE_NAME",),
}
_TYPES = {
    _LAYOUT: {
        "LAYOUT_HASH": "char[]",
        "CELLS": "uint16_t",
        "MUXES": "uint16_t",
        "SELECT_LINES": "uint8_t",
        "CHANNELS": "uint16_t",
        "ADC_BITS": "uint8_t",
        "PULL_UP_OHM": "uint32_t",
        "LINE_PF": "uint32_t",
        "DETECTOR_US": "uint32_t",
        "MUX": "uint16_t[CELLS]",
        "CHANNEL": "uint8_t[CELLS]",
    },
    _PROTOCOL: {
        "MAGIC": "uint8_t",
        "VERSION": "uint8_t",
        "DESIGN_CODE": "uint16_t",
        "DESIGN_HASH": "uint8_t[8]",
        "SERVICE_UUID": "char[]",
        "FRAMES_UUID": "char[]",
        "STATUS_UUID": "char[]",
        "LEGACY_SERVICE_UUID": "char[]",
        "LEGACY_FRAMES_UUID": "char[]",
        "PROTOCOL_HASH": "char[]",
        "WIRING_SUM": "uint16_t",
    },
}
"""Type of each constant, as the shared files of the sketch use it."""
_SKETCH = "firmware/firmware.ino"


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read both headers as a compiler would, and hold them against the cells."""
    layout = design.layout
    wired, protocol = (uncommented(_text(outputs / f)) for f in (_LAYOUT, _PROTOCOL))
    yield _channels(wired, layout)
    yield _pins(wired, layout, design)
    yield _converter(wired, layout, design)
    yield _hash(wired, protocol, layout)
    name = re.search(
        r'#define LUMITIP_DEVICE_NAME "((?:[^"\\]|\\.)*)"[ \t]*$', protocol, re.MULTILINE
    )
    same = name is not None and _read_string(name[1]) == design.controller.name.encode()
    yield _faults("firmware.name", _PROTOCOL, int(not same), "Bluetooth name")
    yield _protocol(protocol, layout)
    yield _form({_LAYOUT: wired, _PROTOCOL: protocol})
    yield _sources(outputs)


def _channels(text: str, layout: Layout) -> Measurement:
    """Multiplexer and channel of every cell, in frame order."""
    mux, channel = _table(text, "MUX"), _table(text, "CHANNEL")
    if not len(mux) == len(channel) == len(layout) == _number(text, "CELLS"):
        reason = f"{len(mux)} multiplexers and {len(channel)} channels, {len(layout)} cells"
        return unreadable("firmware.channels", _LAYOUT, reason)
    pairs = zip(mux, channel, layout.mux.tolist(), layout.channel.tolist(), strict=True)
    wrong = sum((m, c) != (wanted_m, wanted_c) for m, c, wanted_m, wanted_c in pairs)
    note = f"of {len(layout)} on another input than in the layout"
    return Measurement("firmware.channels", _LAYOUT, float(wrong), 0, 0, "cells", note)


def _pins(text: str, layout: Layout, design: Design) -> Measurement:
    """The analog pin that reads each cell, and the order of the select lines."""
    analog, select = _list(text, "LUMITIP_ADC_PINS"), _list(text, "LUMITIP_SELECT_PINS")
    wanted = dict(zip(layout.mux.tolist(), layout.adc_pin.tolist(), strict=True))
    faults = sum(analog[m : m + 1] != [pin] for m, pin in wanted.items())
    faults += abs(len(analog) - len(wanted))
    # Arduino's functions take D6 as 6, and A0 by its name.
    numbers = [re.sub(r"^D(?=\d+$)", "", pin) for pin in design.wiring.select_pins]
    faults += int(select != numbers)
    switched = design.wiring.emitter_pin
    wanted_pin = None if switched is None else re.sub(r"^D(?=\d+$)", "", switched)
    faults += int(_setting(text, "LUMITIP_EMITTER_PIN") != wanted_pin)
    return _faults("firmware.pins", _LAYOUT, faults, "analog and select pins")


def _converter(text: str, layout: Layout, design: Design) -> Measurement:
    """Inputs of the scan timing: lines, inputs, bits, pull-up and capacitance."""
    lines, channel = len(design.wiring.select_pins), design.electrical.channel
    wanted = {
        "MUXES": design.wiring.muxes,
        "SELECT_LINES": lines,
        "CHANNELS": 2**lines,
        "ADC_BITS": design.controller.adc_bits,
        "PULL_UP_OHM": round(layout.optics.pull_up_ohm),
        "LINE_PF": math.ceil(channel.line_pf + channel.detector_pf),
        "DETECTOR_US": math.ceil(channel.wait_us or 0),
    }
    wrong = [name for name, value in wanted.items() if _number(text, name) != value]
    ambient = design.electrical.ambient
    waits = {"EMITTER_US": ambient.light_us, "PERIOD_US": ambient.period_us} if ambient else {}
    for name, us in waits.items():
        if _setting(text, f"LUMITIP_{name}") != str(math.ceil(us)):
            wrong.append(name)
    return _faults("firmware.converter", _LAYOUT, len(wrong), ", ".join(wrong) or "inputs, bits")


def _hash(wired: str, protocol: str, layout: Layout) -> Measurement:
    """The design hash, whole in both headers and shortened for packets and status."""
    wanted = layout.design_hash
    hash_bytes = re.search(r"DESIGN_HASH\[8\] = \{([^}]*)\}", protocol)
    code = re.search(r"DESIGN_CODE = (0x[0-9a-f]{4});", protocol)
    faults = int(f'LAYOUT_HASH[] = "{wanted}"' not in wired)
    faults += int(f'PROTOCOL_HASH[] = "{wanted}"' not in protocol)
    faults += int(code is None or int(code[1], 16) != int(wanted[:4], 16))
    shortened = [f"0x{wanted[i : i + 2]}" for i in range(0, 16, 2)]
    faults += int(hash_bytes is None or hash_bytes[1].split(", ") != shortened)
    return _faults("firmware.hash", _LAYOUT, faults, "equals the layout's")


def _protocol(text: str, layout: Layout) -> Measurement:
    """Values that packets, links and the compiler are held against, as the readout has them."""
    pairs = zip(layout.mux.tolist(), layout.channel.tolist(), strict=True)
    wired = b"".join(bytes([mux & 0xFF, mux >> 8, channel]) for mux, channel in pairs)
    wanted = {
        "MAGIC": f"0x{packet.MAGIC:02x}",
        "VERSION": f"{packet.VERSION}",
        "WIRING_SUM": f"0x{crc_hqx(wired, 0xFFFF):04x}",
        "SERVICE_UUID[]": f'"{bluetooth.SERVICE}"',
        "FRAMES_UUID[]": f'"{bluetooth.FRAMES}"',
        "STATUS_UUID[]": f'"{bluetooth.STATUS}"',
        "LEGACY_SERVICE_UUID[]": f'"{bluetooth.LEGACY_SERVICE[4:8]}"',
        "LEGACY_FRAMES_UUID[]": f'"{bluetooth.LEGACY_FRAMES[4:8]}"',
    }
    wrong = [name for name, value in wanted.items() if f" {name} = {value};" not in text]
    return _faults("firmware.protocol", _PROTOCOL, len(wrong), ", ".join(wrong) or "UUIDs, sums")


def _form(headers: Mapping[str, str]) -> Measurement:
    """Whether a compiler can read both headers and takes each value as it is."""
    wrong = [
        fault for f, text in headers.items() for fault in faults(text, _SETTINGS[f], _TYPES[f])
    ]
    return count("firmware.form", _LAYOUT, wrong, "faults")


def _sources(outputs: Path) -> Measurement:
    """The files that all designs share are there, as they are shipped, and none else but both
    headers: a compiler takes all that lies in the folder."""
    shipped = firmware_sources()
    if not shipped:
        return unreadable("firmware.sources", _SKETCH, "this installation has no firmware")
    wrong = [
        source.name
        for source in shipped
        if sha256_of(outputs / "firmware" / source.name) != sha256_of(source)
    ]
    wanted = {f"firmware/{source.name}" for source in shipped} | {_LAYOUT, _PROTOCOL}
    there = {f"firmware/{name}" for name in files_in(outputs / "firmware")}
    wrong += sorted(name.removeprefix("firmware/") for name in there - wanted)
    return count("firmware.sources", _SKETCH, wrong, "files are not as this version ships them")


def _faults(check: str, subject: str, faults: int, note: str) -> Measurement:
    return Measurement(check, subject, float(faults), 0, 0, "faults", note)


def _text(file: Path) -> str:
    """The text of a file; none where it cannot be read, which no figure then fits."""
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""


def _read_string(text: str) -> bytes:
    """The bytes of a C++ string: an octal number, or a character of its own, after a backslash."""

    def read(found: re.Match[str]) -> str:
        return chr(int(found[1], 8)) if found[1] else found[2]

    return re.sub(r"\\(?:([0-7]{3})|(.))", read, text).encode("latin-1", "replace")


def _number(text: str, name: str) -> int | None:
    found = re.search(rf"^constexpr \w+ {name} = (\d+);", text, re.MULTILINE)
    return int(found[1]) if found else None


def _table(text: str, name: str) -> list[int]:
    found = re.search(rf"^constexpr \w+ {name}\[CELLS\] = \{{([\d,\s]*)\}};", text, re.MULTILINE)
    return [int(value) for value in re.findall(r"\d+", found[1])] if found else []


def _setting(text: str, name: str) -> str | None:
    """A value that an option of the compiler can replace."""
    found = re.search(rf"^#ifndef {name}\n#define {name} (\S+) ", text, re.MULTILINE)
    return found[1] if found else None


def _list(text: str, name: str) -> list[str]:
    found = re.search(rf"^#define {name} (.*)$", text, re.MULTILINE)
    return found[1].split(", ") if found else []
