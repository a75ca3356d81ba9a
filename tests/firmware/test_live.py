"""The firmware's own code at the other end of a serial line that `Fingertip` reads."""

import os
import pty
import subprocess
import tty
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip import Fingertip
from lumitip.errors import WrongDesign
from lumitip.layout import Layout

FRAMES = 300
RATE = ("-DLUMITIP_PERIOD_US=2000", "-DLUMITIP_LATENCY_US=6000", "-DLUMITIP_BITS=10")


@pytest.fixture
def port(host_program: Callable[..., Path]) -> Iterator[str]:
    """A serial port at whose other end the firmware of the published design runs."""
    program = host_program("line", "published", *RATE)
    master, slave = pty.openpty()
    tty.setraw(slave)
    with subprocess.Popen([program], stdout=master) as device:
        yield os.ttyname(slave)
        device.terminate()
    os.close(master)
    os.close(slave)


def test_the_robot_reads_what_the_firmware_measures(
    port: str, sketch: Callable[[str], Path]
) -> None:
    layout = Layout.load(sketch("published").parent / "layout.json")
    with Fingertip.open(f"serial://{port}", layout) as tip:
        first = tip.read(timeout=5)
        block = tip.get_data(FRAMES, timeout=20)
        dropped = tip.stats.dropped
    assert dropped is not None
    assert sum(dropped.values()) == 0
    assert first.bits == 10
    assert np.array_equal(np.diff(block.seq), np.ones(FRAMES - 1))
    # The bench makes up codes from the frame's number, here counted from another start.
    base = layout.mux * 977 + layout.channel * 131
    starts = [n for n in range(4096) if np.array_equal((base + n * 37) % 4096 >> 2, block.raw[0])]
    assert any(
        all(
            np.array_equal((base + (n + i) * 37) % 4096 >> 2, raw)
            for i, raw in enumerate(block.raw)
        )
        for n in starts
    )


def test_the_robot_refuses_the_firmware_of_another_design(
    port: str, sketch: Callable[[str], Path]
) -> None:
    design = Layout.load(sketch("published").parent / "layout.json")
    moved = np.roll(design.channel, 1)
    other = replace(design, channel=moved)
    with pytest.raises(WrongDesign), Fingertip.open(f"serial://{port}", other) as tip:
        tip.read(timeout=5)
