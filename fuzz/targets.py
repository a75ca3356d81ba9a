"""Readers of bytes from outside, each with good inputs to start from."""

from binascii import crc_hqx
from collections.abc import Sequence
from functools import cache

import numpy as np

from fuzz.engine import Target
from fuzz.layouts import layouts, read_layout
from fuzz.mutate import BINARY, TEXT
from fuzz.recordings import read_recording, recordings
from lumitip.errors import LayoutError
from lumitip.protocol import cobs
from lumitip.protocol.bluetooth import Fault, Status, decode_legacy
from lumitip.protocol.cobs import StreamDecoder
from lumitip.protocol.messages import Kind, MessageDecoder, MessageError, decode_json, encode_json
from lumitip.protocol.messages import encode as encode_message
from lumitip.protocol.packet import Packet, PacketError, decode, encode
from lumitip.recording import RecordingError

CELLS = 12


@cache
def packets() -> tuple[bytes, ...]:
    """Packets of every number of bits, of one and of several frames."""
    rng = np.random.default_rng(1)
    made = []
    for bits in (8, 10, 12):
        for frames in (1, 2, 7):
            values = rng.integers(0, 1 << bits, (frames, CELLS)).astype(np.uint16)
            made.append(encode(Packet(0xBEEF, 65535, bits, 2**32 - 1, 1000, values)))
    return tuple(made)


def sealed(data: bytes) -> bytes:
    """The same with a checksum that fits."""
    body = data[:-2]
    return body + crc_hqx(body, 0xFFFF).to_bytes(2, "little")


def read_packet(data: bytes) -> None:
    """Decode a packet; what is accepted must be worth what it says."""
    packet = decode(data, CELLS)
    assert packet.values.shape == (packet.frames, CELLS)
    assert int(packet.values.max()) < 1 << packet.bits
    assert len(encode(packet)) == len(data)


def lines() -> Sequence[bytes]:
    """Packets on a serial line."""
    return [b"".join(cobs.encode(p) + b"\0" for p in packets()[i : i + 4]) for i in range(6)]


def read_line(data: bytes) -> None:
    """Decode a stream in two pieces; each delimiter ends one packet or one loss."""
    decoder = StreamDecoder(CELLS)
    half = len(data) // 2
    found = decoder.feed(data[:half]) + decoder.feed(data[half:])
    assert len(found) + sum(decoder.dropped.values()) <= data.count(0)


def read_cobs(data: bytes) -> None:
    """Decode COBS; what comes out goes in again."""
    plain = cobs.decode(data)
    assert cobs.decode(cobs.encode(plain)) == plain


def statuses() -> Sequence[bytes]:
    """Values of the status characteristic."""
    return [
        Status((1, 0, 0), "0123456789abcdef", 32, mtu, 51, faults).encode()
        for mtu, faults in ((23, Fault.MTU_TOO_SMALL), (247, Fault(0)), (65535, Fault(31)))
    ]


def read_status(data: bytes) -> None:
    """Decode a status; what is accepted encodes to the same bytes."""
    assert Status.decode(data).encode() == data[:20]


def read_legacy(data: bytes) -> None:
    """Decode a frame of version 1."""
    assert decode_legacy(data, CELLS).tobytes() == data


def streams() -> Sequence[bytes]:
    """Messages of a server."""
    event = encode_json(Kind.EVENT, {"kind": "lost", "detail": "gone"})
    return [event + encode_message(Kind.PACKET, packet) + event for packet in packets()]


def read_stream(data: bytes) -> None:
    """Decode messages in two pieces; those found encode to the same bytes."""
    decoder = MessageDecoder()
    half = len(data) // 2
    found = decoder.feed(data[:half]) + decoder.feed(data[half:])
    assert data.startswith(b"".join(encode_message(*message) for message in found))
    for kind, payload in found:
        if kind == Kind.EVENT:
            decode_json(payload)


TARGETS = (
    Target("packet", 0.35, packets, read_packet, (PacketError,), BINARY, sealed),
    Target("stream", 0.1, lines, read_line, (), BINARY),
    Target("messages", 0.05, streams, read_stream, (MessageError,), BINARY),
    Target(
        "cobs",
        0.15,
        lambda: [cobs.encode(p) for p in packets()],
        read_cobs,
        (cobs.CobsError,),
        BINARY,
    ),
    Target("status", 0.05, statuses, read_status, (PacketError,), BINARY),
    Target("legacy", 0.05, lambda: [bytes(range(CELLS))], read_legacy, (PacketError,), BINARY),
    Target("layout", 0.15, layouts, read_layout, (LayoutError,), TEXT),
    Target("recording", 0.1, recordings, read_recording, (RecordingError,), BINARY),
)
