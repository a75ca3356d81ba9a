"""Packets that C++ writes and Python reads, and the other way round."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumitip.protocol import cobs
from lumitip.protocol.packet import Packet, decode, encode

COUNT = 60


def some_packets() -> list[Packet]:
    """Packets of every number of bits, with full-scale and empty codes among them."""
    rng = np.random.default_rng(7)
    packets = []
    for number in range(COUNT):
        bits, cells = (8, 10, 12)[number % 3], (1, 3, 7, 32)[number % 4]
        shape = (int(rng.integers(1, 7)), cells)
        values = rng.integers(0, 1 << bits, shape, dtype=np.uint16)
        values[rng.random(shape) < 0.1] = (1 << bits) - 1
        values[rng.random(shape) < 0.1] = 0
        whole = rng.integers(0, 1 << 16, 3).tolist()
        time_us = int(rng.integers(0, 1 << 32))
        packets.append(Packet(whole[0], whole[1], bits, time_us, whole[2], values))
    return packets


@pytest.mark.slow
def test_packets_agree_in_both_directions(
    host_program: Callable[..., Path], run: Callable[..., object]
) -> None:
    packets = some_packets()
    asked = [*map(_pack, packets), *map(_read, packets)]
    done = run(str(host_program("packets", "published")), input="\n".join(asked) + "\n")
    assert done.returncode == 0, done.stderr
    answers = done.stdout.splitlines()
    assert len(answers) == 2 * COUNT
    for packet, written, read in zip(packets, answers[:COUNT], answers[COUNT:], strict=True):
        data = bytes.fromhex(written)
        assert data == encode(packet)
        back = decode(data, packet.values.shape[1])
        assert np.array_equal(back.values, packet.values)
        assert (back.sequence, back.time_us) == (packet.sequence, packet.time_us)
        assert read.split() == [str(code) for code in packet.values.ravel().tolist()]


@pytest.mark.slow
def test_cobs_agrees(host_program: Callable[..., Path], run: Callable[..., object]) -> None:
    rng = np.random.default_rng(11)
    texts = [bytes(n) for n in (1, 2, 300)] + [b"\1" * n for n in (253, 254, 255, 508, 509, 762)]
    texts += [b"\1" * 254 + b"\0", b"\0" + b"\1" * 254, b"\1" * 253 + b"\0" + b"\2" * 255]
    texts += [
        rng.integers(0, 4, int(n)).astype(np.uint8).tobytes() for n in rng.integers(1, 900, 40)
    ]
    asked = "\n".join(f"cobs {text.hex()}" for text in texts) + "\n"
    done = run(str(host_program("packets", "published")), input=asked)
    assert done.returncode == 0, done.stderr
    for text, answer in zip(texts, done.stdout.splitlines(), strict=True):
        assert bytes.fromhex(answer) == cobs.encode(text) + b"\0"


def test_a_full_packet_takes_no_more(
    host_program: Callable[..., Path], run: Callable[..., object]
) -> None:
    asked = "pack 3 8 0 0 0 0 7 " + "1 " * 21 + "\n"
    assert run(str(host_program("packets", "published")), input=asked).stdout == "full at 6\n"


def _pack(packet: Packet) -> str:
    frames, cells = packet.values.shape
    codes = " ".join(map(str, packet.values.ravel().tolist()))
    return (
        f"pack {cells} {packet.bits} {packet.design} {packet.sequence} {packet.time_us} "
        f"{packet.period_us} {frames} {codes}"
    )


def _read(packet: Packet) -> str:
    return f"read {packet.values.shape[1]} {cobs.encode(encode(packet)).hex()}"
