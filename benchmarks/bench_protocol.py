"""Speed of the codec: packets of the published sensor's 32 cells, and a serial stream.

Run by `make bench`; exits 1 if the goal is missed. Wall time depends on the machine, so every
figure comes with a ratio to `binascii.crc_hqx` over the same bytes, which no codec can do without.
"""

import sys
import timeit
from binascii import crc_hqx
from collections.abc import Callable
from functools import partial

import numpy as np

from common import Goals
from lumitip.protocol import cobs
from lumitip.protocol.cobs import StreamDecoder
from lumitip.protocol.packet import Packet, decode, encode, largest_batch

CELLS = 32
MTU = 242
LIMIT_SHARE = 0.05  # of a core, a tenth of what a whole link may take at 500 frames/s


def seconds(function: Callable[[], object]) -> float:
    """Time of one call, the best of five rounds (s)."""
    timer = timeit.Timer(function)
    number, _ = timer.autorange()
    return min(timer.repeat(5, number)) / number


def packets() -> None:
    """One frame a packet, and as many as a notification takes."""
    print("packets of 32 cells        us to decode   us to encode   decode to CRC alone")
    for bits in (8, 10, 12):
        for frames in (1, largest_batch(MTU, CELLS, bits)):
            values = np.random.default_rng(0).integers(0, 1 << bits, (frames, CELLS))
            whole = values.astype(np.uint8) if bits == 8 else values.astype(np.uint16)
            packet = Packet(1, 2, bits, 3, 4, whole)
            data = encode(packet)
            reading = seconds(partial(decode, data, CELLS))
            writing = seconds(partial(encode, packet))
            crc = seconds(partial(crc_hqx, data, 0xFFFF))
            print(
                f"  {bits:2} bits, {frames} frames      {1e6 * reading:8.1f}       "
                f"{1e6 * writing:8.1f}       {reading / crc:8.1f} x"
            )


def stream() -> float:
    """A second of a serial line at 500 frames a second, in pieces as they come; the share of a
    core that reading it takes."""
    values = np.random.default_rng(0).integers(0, 256, (1, CELLS)).astype(np.uint8)
    line = b"".join(
        cobs.encode(encode(Packet(1, n, 8, 2000 * n, 2000, values))) + b"\0" for n in range(500)
    )
    pieces = [line[i : i + 64] for i in range(0, len(line), 64)]

    def read() -> None:
        decoder = StreamDecoder(CELLS)
        found = sum(len(decoder.feed(piece)) for piece in pieces)
        assert found == 500

    taken = seconds(read)
    print(
        f"serial at 500 frames/s: {100 * taken:.2f} % of a core, {500 / taken:.0f} frames/s at most"
    )
    return taken


if __name__ == "__main__":
    packets()
    goals = Goals()
    goals.at_most("serial at 500 frames/s", stream(), LIMIT_SHARE, "of a core")
    sys.exit(goals.exit_code())
