"""COBS against the published examples, and packets out of a damaged, cut-up stream."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumitip.protocol import cobs
from lumitip.protocol.cobs import StreamDecoder
from lumitip.protocol.packet import Packet, PacketError, encode

RUN = bytes(range(1, 255))  # 254 bytes, the longest run

# Cheshire and Baker 1999, and the usual edge cases of runs of 254.
KNOWN = [
    (b"", b"\x01"),
    (b"\0", b"\x01\x01"),
    (b"\0\0", b"\x01\x01\x01"),
    (b"\x11\x22\0\x33", b"\x03\x11\x22\x02\x33"),
    (b"\x11\0\0\0", b"\x02\x11\x01\x01\x01"),
    (RUN, b"\xff" + RUN),
    (b"\0" + RUN, b"\x01\xff" + RUN),
    (RUN + b"\xff", b"\xff" + RUN + b"\x02\xff"),
    (RUN + b"\0", b"\xff" + RUN + b"\x01\x01"),
    (RUN + RUN, b"\xff" + RUN + b"\xff" + RUN),
]


def packet(sequence: int, cells: int = 32) -> Packet:
    values = np.arange(2 * cells, dtype=np.uint8).reshape(2, cells)
    return Packet(0x1234, sequence, 8, 1000 * sequence, 1000, values)


def line(*sequences: int) -> bytes:
    return b"".join(cobs.encode(encode(packet(n))) + b"\0" for n in sequences)


@pytest.mark.parametrize(("data", "stuffed"), KNOWN)
def test_cobs_examples(data: bytes, stuffed: bytes) -> None:
    assert cobs.encode(data) == stuffed
    assert cobs.decode(stuffed) == data


@given(st.binary(max_size=600) | st.binary(max_size=3).map(lambda b: b * 300))
def test_cobs_comes_back_without_a_zero(data: bytes) -> None:
    stuffed = cobs.encode(data)
    assert 0 not in stuffed
    assert len(stuffed) <= cobs.encoded_bytes(len(data))
    assert cobs.decode(stuffed) == data


@pytest.mark.parametrize("data", [b"", b"\0", b"\x02", b"\x03\x11\x00", b"\x05\x11\x22"])
def test_cobs_refuses_what_no_encoder_makes(data: bytes) -> None:
    with pytest.raises(cobs.CobsError):
        cobs.decode(data)


@settings(max_examples=40)
@given(st.lists(st.integers(1, 200), max_size=8))
def test_packets_come_out_however_the_stream_is_cut(lengths: list[int]) -> None:
    data, decoder, found = line(1, 2, 3, 4), StreamDecoder(32), []
    for length in [*lengths, 10_000]:
        found += decoder.feed(data[:length])
        data = data[length:]
    assert [p.sequence for p in found] == [1, 2, 3, 4]
    assert decoder.dropped == {"crc": 0, "length": 0}


def test_damage_costs_one_packet_and_is_counted() -> None:
    hurt, short = bytearray(line(2)), line(3)[:-10] + b"\0"
    hurt[30] ^= 0x40
    decoder = StreamDecoder(32)
    found = decoder.feed(line(1) + bytes(hurt) + short + b"\0\0" + line(4))
    assert [p.sequence for p in found] == [1, 4]
    assert decoder.dropped == {"crc": 1, "length": 1}
    assert isinstance(decoder.last_error, cobs.CobsError | PacketError)


def test_the_end_of_a_packet_that_began_before_is_not_a_loss() -> None:
    data = line(1, 2)[20:]
    for mid_stream, lost in ((True, 0), (False, 1)):
        decoder = StreamDecoder(32, mid_stream=mid_stream)
        assert [p.sequence for p in decoder.feed(data)] == [2]
        assert sum(decoder.dropped.values()) == lost


def test_a_stream_without_an_end_holds_little_memory_and_counts_once() -> None:
    decoder = StreamDecoder(32)
    for _ in range(100):
        assert decoder.feed(b"\x55" * 4096) == []
        assert len(decoder._rest) <= 12_400
    assert [p.sequence for p in decoder.feed(b"\0" + line(7))] == [7]
    assert decoder.dropped == {"crc": 0, "length": 1}
