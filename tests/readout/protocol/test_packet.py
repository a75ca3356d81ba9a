"""Packets: the bytes of a written-out example, any values there and back, every fault named."""

from binascii import crc_hqx
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumitip.protocol.packet import (
    HEADER_BYTES,
    ForeignPacketError,
    Packet,
    PacketError,
    decode,
    design_code,
    encode,
    frame_bytes,
    largest_batch,
    needed_mtu,
    packet_bytes,
)

KNOWN = Packet(0xBEEF, 0x0102, 10, 0x01020304, 1000, np.array([[1, 0x3FF, 0x155]], np.uint16))
# Codes 0x001, 0x3FF, 0x155 from the lowest bit on: 0x155_FFC_01 of 30 bits, lowest byte first.
KNOWN_BODY = bytes.fromhex("4c 02 efbe 0201 01 0a 04030201 e803 01fc5f15".replace(" ", ""))


@st.composite
def packets(draw: st.DrawFn) -> Packet:
    bits = draw(st.sampled_from((8, 10, 12)))
    shape = draw(st.tuples(st.integers(1, 5), st.integers(1, 40)))
    seed = draw(st.integers(0, 2**32 - 1))
    values = np.random.default_rng(seed).integers(0, 1 << bits, shape)
    whole = [draw(st.integers(0, (1 << width) - 1)) for width in (16, 16, 32, 16)]
    kind = np.uint8 if bits == 8 else np.uint16
    return Packet(whole[0], whole[1], bits, whole[2], whole[3], values.astype(kind))


def resealed(data: bytes) -> bytes:
    """The packet with a checksum that fits again."""
    return data[:-2] + crc_hqx(data[:-2], 0xFFFF).to_bytes(2, "little")


def test_bytes_of_an_example_worked_out_by_hand() -> None:
    assert KNOWN_BODY[-4:] == ((0x155 << 20) | (0x3FF << 10) | 1).to_bytes(4, "little")
    assert encode(KNOWN) == resealed(KNOWN_BODY + b"\0\0")


@settings(max_examples=60)
@given(packets())
def test_any_packet_comes_back(packet: Packet) -> None:
    data = encode(packet)
    frames, cells = packet.values.shape
    assert len(data) == packet_bytes(frames, cells, packet.bits)
    back = decode(data, cells)
    assert np.array_equal(back.values, packet.values)
    assert back.values.dtype == (np.uint8 if packet.bits == 8 else np.uint16)
    assert not back.values.flags.writeable
    assert back.frames == frames
    assert encode(back) == data


def test_packing_is_lowest_bit_first() -> None:
    """Against the definition, bit by bit."""
    rng = np.random.default_rng(3)
    for bits in (8, 10, 12):
        values = rng.integers(0, 1 << bits, (3, 31))
        stream = sum(int(v) << (i * bits) for i, v in enumerate(values.ravel()))
        wanted = stream.to_bytes((values.size * bits + 7) // 8, "little")
        packet = Packet(0, 0, bits, 0, 0, values.astype(np.uint16))
        assert encode(packet)[HEADER_BYTES:-2] == wanted


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda d: d[:0], "length"),
        (lambda d: d[:15], "length"),
        (lambda d: d[:-1], "length"),
        (lambda d: d + b"\0", "length"),
        (lambda d: d[:6] + b"\2" + d[7:], "length"),
        (lambda d: resealed(d[:6] + b"\0" + d[7:-6] + b"\0\0"), "length"),
        (lambda d: b"\x4d" + d[1:], "magic"),
        (lambda d: resealed(d[:1] + b"\3" + d[2:]), "version"),
        (lambda d: resealed(d[:7] + b"\x0b" + d[8:]), "bits"),
        (lambda d: d[:14] + bytes([d[14] ^ 1]) + d[15:], "crc"),
        (lambda d: d[:-1] + bytes([d[-1] ^ 0x80]), "crc"),
    ],
)
def test_each_fault_has_its_reason(damage: Any, reason: str) -> None:
    with pytest.raises(PacketError) as caught:
        decode(damage(encode(KNOWN)), 3)
    assert caught.value.reason == reason


@pytest.mark.parametrize("bit", range(8))
def test_a_damaged_version_is_damage_and_no_other_firmware(bit: int) -> None:
    data = encode(KNOWN)
    with pytest.raises(PacketError, match="the checksum of 20 bytes is wrong") as caught:
        decode(data[:1] + bytes([data[1] ^ 1 << bit]) + data[2:], 3)
    assert caught.value.reason == "crc"
    with pytest.raises(PacketError, match="flash the firmware") as other:
        decode(resealed(data[:1] + bytes([data[1] ^ 1 << bit]) + data[2:]), 3)
    assert other.value.reason == "version"


@pytest.mark.parametrize("bits", [0x0B, 0x0E, 0x2A, 0x8A])
def test_damaged_bits_are_damage(bits: int) -> None:
    data = encode(KNOWN)
    with pytest.raises(PacketError, match="checksum") as caught:
        decode(data[:7] + bytes([bits]) + data[8:], 3)
    assert caught.value.reason == "crc"


def test_every_single_bit_flipped_is_noticed() -> None:
    data = encode(KNOWN)
    for bit in range(8 * len(data)):
        flipped = bytearray(data)
        flipped[bit // 8] ^= 1 << bit % 8
        with pytest.raises(PacketError):
            decode(bytes(flipped), 3)


def test_a_packet_of_another_number_of_cells_is_refused() -> None:
    with pytest.raises(PacketError, match="has 20 bytes; 1 frames of 32 cells") as caught:
        decode(encode(KNOWN), 32)
    assert caught.value.reason == "length"


@pytest.mark.parametrize("bits", [8, 10, 12])
@pytest.mark.parametrize("cells", [1, 3, 31])
def test_an_undamaged_packet_tells_its_design_and_cells(bits: int, cells: int) -> None:
    for frames in (1, 2, 7):
        data = encode(Packet(0xBEEF, 0, bits, 0, 0, np.ones((frames, cells), np.uint16)))
        with pytest.raises(ForeignPacketError, match=f"fingertip of {cells} cells") as caught:
            decode(data, 64)
        assert (caught.value.design, caught.value.cells) == (0xBEEF, cells)
        with pytest.raises(PacketError, match="was cut off") as cut:
            decode(data[:-1], 64)
        assert not isinstance(cut.value, ForeignPacketError)


@pytest.mark.parametrize(
    "wrong",
    [
        {"bits": 9},
        {"bits": 8},
        {"sequence": 65536},
        {"time_us": -1},
        {"period_us": 70000},
        {"design": 1 << 16},
        {"values": np.zeros((0, 3), np.uint16)},
        {"values": np.zeros((256, 3), np.uint16)},
        {"values": np.zeros((1, 0), np.uint16)},
        {"values": np.zeros(3, np.uint16)},
        {"values": np.zeros((1, 3))},
        {"values": np.full((1, 3), -1)},
        {"values": np.full((1, 3), 1024)},
    ],
    ids=str,
)
def test_what_no_packet_can_carry_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(PacketError):
        encode(replace(KNOWN, **wrong))


def test_sizes_of_the_published_sensor() -> None:
    assert frame_bytes(32, 8) == 32
    assert packet_bytes(1, 32, 8) == 48
    assert needed_mtu(32, 8) == 51
    assert largest_batch(50, 32, 8) == 0
    assert largest_batch(51, 32, 8) == 1
    assert largest_batch(23, 32, 8) == 0
    assert largest_batch(247, 32, 8) == 7
    assert largest_batch(247, 32, 12) == 4
    assert largest_batch(65535, 1, 8) == 255


@given(st.integers(0, 600), st.integers(1, 200), st.sampled_from((8, 10, 12)))
def test_the_largest_batch_fits_and_one_more_does_not(mtu: int, cells: int, bits: int) -> None:
    frames = largest_batch(mtu, cells, bits)
    assert frames == 0 or packet_bytes(frames, cells, bits) + 3 <= mtu
    assert frames == 255 or packet_bytes(frames + 1, cells, bits) + 3 > mtu
    assert (frames >= 1) == (mtu >= needed_mtu(cells, bits))


def test_the_design_code_is_the_first_16_bits() -> None:
    assert design_code("beef" + "0" * 60) == 0xBEEF
