"""The page of packets and recordings: its fields are those of the code."""

import re
from typing import Any

import pytest
from markdown_it import MarkdownIt

from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.protocol import bluetooth, messages, packet
from lumitip.recording import message, metadata
from lumitip.recording.writer import TOPIC
from markdown_pages import ROOT

TEXT = (ROOT / "docs/protocol.md").read_text("utf-8")
SIZES = {"u8": "B", "u16": "H", "u32": "I", "u8 × 3": "BBB", "8 bytes": "8s"}


def _tables() -> list[list[list[str]]]:
    """The cells of each table of the page, without its headings."""
    found: list[list[list[str]]] = []
    cells: list[str] = []
    within = False
    for token in MarkdownIt("commonmark").enable("table").parse(TEXT):
        if token.type == "tbody_open":
            found.append([])
            within = True
        elif token.type == "tbody_close":
            within = False
        elif token.type == "tr_open":
            cells = []
        elif token.type == "tr_close" and within:
            found[-1].append(cells)
        elif token.type == "inline" and within:
            cells.append(token.content.replace("`", ""))
    return found


PACKET, UUIDS, STATUS, FAULTS, TCP, FRAME, META = _tables()


def _format(rows: list[list[str]]) -> str:
    return "<" + "".join(SIZES[kind] for _, kind, _ in rows)


def test_the_packet_is_that_of_the_code() -> None:
    header = [row for row in PACKET if row[0] not in ("codes", "checksum")]
    assert _format(header) == packet._HEADER.format
    assert header[0][2] == f"0x{packet.MAGIC:02X}"
    assert header[1][2] == str(packet.VERSION)
    names = [name for name, *_ in header if name not in ("magic", "version", "frames")]
    fields = packet.Packet.__dataclass_fields__
    assert [name for name in fields if name != "values"] == sorted(names, key=list(fields).index)
    assert f"need an ATT MTU of {packet.needed_mtu(32, 8)}" in " ".join(TEXT.split())
    assert _format(header[:-1]) != packet._HEADER.format, "a field that is missing is found"


def test_the_status_is_that_of_the_code() -> None:
    assert _format(STATUS) == bluetooth._STATUS.format
    assert {name for name, *_ in STATUS} == set(bluetooth.Status.__dataclass_fields__)
    assert [(name, int(bit)) for name, bit, _ in FAULTS] == [
        (str(fault.name), fault.value) for fault in bluetooth.Fault
    ]
    assert [uuid for _, uuid, _ in UUIDS] == [
        bluetooth.SERVICE,
        bluetooth.FRAMES,
        bluetooth.STATUS,
        bluetooth.LEGACY_SERVICE,
        bluetooth.LEGACY_FRAMES,
    ]


def test_the_messages_of_the_server_are_those_of_the_code() -> None:
    kinds = [(kind.name, str(kind.value)) for kind in messages.Kind]
    assert [(name, number) for name, number, _ in TCP] == kinds
    assert messages._HEADER.format == "<BI"


def test_the_fields_of_a_recording_are_those_of_its_schema() -> None:
    own = message.schema_text().partition("====")[0]
    fields = re.findall(r"^([\w/\[\]]+) (\w+)$", own, re.MULTILINE)
    assert [(kind, name) for name, kind, _ in FRAME] == fields
    assert TOPIC in TEXT
    assert message.SCHEMA_NAME in TEXT


def test_the_metadata_are_those_of_a_recording() -> None:
    layout: Layout = published_layout()
    made: Any = metadata.Metadata(layout, "x", None, 0.0, {})
    texts = made.to_texts()
    assert [name for name, _ in META] == list(texts)
    assert META[0][1] == metadata.FORMAT
    assert texts["calibration"] == "null"


@pytest.mark.parametrize("name", ["lumitip record", "lumitip serve", "lumitip foxglove"])
def test_the_commands_are_on_the_page(name: str) -> None:
    assert name in TEXT
