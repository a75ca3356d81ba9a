"""A Bluetooth adapter that is not there: bleak unmodified, `org.bluez` faked on a private bus."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from lumitip import Layout
from lumitip.protocol.bluetooth import Fault, Status
from lumitip.protocol.packet import Packet, design_code, encode, needed_mtu
from programs import program
from serial_line import Line

PERIOD_US = 2000


class Device:
    """What a device of a layout sends, as bytes."""

    def __init__(self, layout: Layout, design: str | None = None, mtu: int = 247) -> None:
        self.layout = layout
        self.design = design or layout.design_hash
        self.mtu = mtu
        self.faults = Fault(0)

    def status(self) -> bytes:
        needed = needed_mtu(len(self.layout), 8)
        design, cells = self.design[:16], len(self.layout)
        return Status((1, 0, 0), design, cells, self.mtu, needed, self.faults).encode()

    def packet(self, sequence: int, frames: int = 1, time_us: int | None = None) -> bytes:
        """Frames whose values are their number modulo 251."""
        numbers = ((sequence + np.arange(frames)) % 251).astype(np.uint8)
        values = np.repeat(numbers[:, None], len(self.layout), axis=1)
        at = sequence * PERIOD_US if time_us is None else time_us
        return encode(
            Packet(design_code(self.design), sequence % 2**16, 8, at % 2**32, PERIOD_US, values)
        )


@pytest.fixture
def device(layout: Layout) -> Device:
    """Bytes of a device of the published layout."""
    return Device(layout)


@pytest.fixture
def until() -> Callable[..., None]:
    """`until(lambda: tip.stats.received == 5)`: wait for it, ten seconds at most."""

    def wait(true: Callable[[], bool], timeout_s: float = 10.0) -> None:
        end = time.monotonic() + timeout_s
        while not true():
            assert time.monotonic() < end, "did not happen"
            time.sleep(0.002)

    return wait


@pytest.fixture(scope="session")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A private D-Bus, taken for the system's by all that follows."""
    program("dbus-daemon")
    from private_bus import private_bus

    with private_bus(tmp_path_factory.mktemp("bus")) as address, pytest.MonkeyPatch.context() as m:
        m.setenv("DBUS_SYSTEM_BUS_ADDRESS", address)
        yield address


@pytest.fixture
def bluez(bus: str, monkeypatch: pytest.MonkeyPatch) -> Iterator["object"]:
    """A fake `org.bluez` without devices; bleak is as installed."""
    from fake_bluez import FakeBluez

    monkeypatch.setattr("lumitip.links.ble_device.SETTLE_S", 0.1)
    monkeypatch.setattr("lumitip.links.ble_device.MTU_WAIT_S", 0.2)
    service = FakeBluez(bus)
    yield service
    service.stop()


@pytest.fixture
def line(tmp_path: Path) -> Iterator[Line]:
    made = Line(tmp_path / "ttyACM0")
    yield made
    if made.path.is_symlink():
        made.unplug()
