"""Messages from `lumitip serve` to its clients over TCP.

A client sends one line, a JSON object: `{"lumitip": 1, "token": "…"}`. The server answers with
messages, little-endian: kind u8, length of the payload u32, payload. The first is `GREETING` or
`REFUSED`.

    1 GREETING  JSON: device_id, connected, layout (the text of layout.json)
    2 REFUSED   JSON: why, full (whether it is for want of room only, and a later try may do)
    3 PACKET    a packet of version 2, see `lumitip.protocol.packet`
    4 LEGACY    codes of a legacy frame, one byte for each cell
    5 FAULT     JSON: cause, packets, why, foreign ([design, cells] or null)
    6 EVENT     JSON: kind ("connected", "lost" or "failed"), detail
"""

import json
import struct
from enum import IntEnum
from typing import Any

from lumitip.errors import LumitipError

VERSION = 1
MOST_BYTES = 1 << 24
"""Longest payload; a layout of thousands of cells is far shorter."""
MOST_REQUEST_BYTES = 4096
"""Longest line of a client."""
_HEADER = struct.Struct("<BI")


class MessageError(LumitipError, ValueError):
    """Bytes that are not messages of `lumitip serve`."""


class Kind(IntEnum):
    """Kind of a message."""

    GREETING = 1
    REFUSED = 2
    PACKET = 3
    LEGACY = 4
    FAULT = 5
    EVENT = 6


_KINDS = frozenset(Kind)


def encode(kind: Kind, payload: bytes) -> bytes:
    """The bytes of a message."""
    return _HEADER.pack(kind, len(payload)) + payload


def encode_json(kind: Kind, record: dict[str, Any]) -> bytes:
    """The bytes of a message whose payload is JSON."""
    return encode(kind, json.dumps(record).encode())


def encode_request(token: str | None) -> bytes:
    """The line of a client."""
    return json.dumps({"lumitip": VERSION, "token": token or ""}).encode() + b"\n"


def decode_request(line: bytes) -> str:
    """The token in the line of a client.

    Raises:
        MessageError: if it is not the line of a client of this version.
    """
    record = decode_json(line)
    if record.get("lumitip") != VERSION:
        raise MessageError(
            f"the version of the protocol is {record.get('lumitip')!r:.20}; {VERSION} is needed"
        )
    return str(record.get("token", ""))


def decode_json(payload: bytes) -> dict[str, Any]:
    """The JSON object of a payload.

    Raises:
        MessageError: if it is none.
    """
    try:
        record = json.loads(payload)
    except (ValueError, RecursionError) as error:
        raise MessageError(f"the payload is {payload!r:.40}; a JSON object is needed") from error
    if not isinstance(record, dict):
        raise MessageError(f"the payload is {payload!r:.40}; a JSON object is needed")
    return record


class MessageDecoder:
    """Decodes a stream of messages, in bounded memory. Not thread-safe."""

    def __init__(self) -> None:
        self._rest = bytearray()

    def feed(self, chunk: bytes) -> list[tuple[Kind, bytes]]:
        """The messages that end within this chunk.

        Raises:
            MessageError: if the bytes are not messages.
        """
        self._rest += chunk
        found = []
        while len(self._rest) >= _HEADER.size:
            number, length = _HEADER.unpack_from(self._rest)
            if number not in _KINDS or length > MOST_BYTES:
                raise MessageError("this is not the stream of `lumitip serve`")
            end = _HEADER.size + length
            if len(self._rest) < end:
                break
            found.append((Kind(number), bytes(self._rest[_HEADER.size : end])))
            del self._rest[:end]
        return found
