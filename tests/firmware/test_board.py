"""The sketch on a board that is played: its pins, what it serves, and when it keeps quiet."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip.layout import Layout
from lumitip.protocol import bluetooth as uuids
from lumitip.protocol.bluetooth import Fault, Status, decode_legacy
from lumitip.protocol.cobs import StreamDecoder
from lumitip.protocol.packet import decode

STUBS = f"-I{Path(__file__).parent / 'stubs'}"
LEGACY = "c134"


class Seen:
    """What `host/sketch.cpp` printed: lines by their first word, those of each phase apart."""

    def __init__(self, text: str) -> None:
        self.phases: dict[str, dict[str, list[list[str]]]] = {}
        lines = self.phases.setdefault("setup", {})
        for line in text.splitlines():
            what, *rest = line.split(" ")
            if what == "phase":
                lines = self.phases.setdefault(rest[0], {})
            else:
                lines.setdefault(what, []).append(rest)

    def of(self, phase: str, what: str) -> list[list[str]]:
        """What follows a word in each of its lines."""
        return self.phases[phase].get(what, [])

    def sent(self, phase: str, what: str) -> list[bytes]:
        """Bytes of each of the lines."""
        return [bytes.fromhex(rest[0]) for rest in self.of(phase, what)]


@pytest.fixture(scope="module")
def played(host_program: Callable[..., Path], run: Callable[..., Any]) -> Callable[..., Seen]:
    """`played("silent")`: a run, there with Bluetooth that does not start."""

    def get(*arguments: str) -> Seen:
        done = run(str(host_program("sketch", "published", STUBS)), *arguments)
        assert done.returncode == 0, done.stderr
        return Seen(done.stdout)

    return get


@pytest.fixture(scope="module")
def seen(played: Callable[..., Seen]) -> Seen:
    """A run with all that works."""
    return played()


@pytest.fixture
def measured(sketch: Callable[[str], Path]) -> Any:
    """Codes of 8 bits that the played board gives, in cell order."""
    layout = Layout.load(sketch("published").parent / "layout.json")
    return (layout.mux * 977 + layout.channel * 131) % 4096 >> 4


def test_what_is_served_and_asked_for(seen: Seen) -> None:
    served = [[uuids.FRAMES], [uuids.STATUS], [LEGACY]]
    assert seen.of("setup", "serves") == served
    assert seen.of("setup", "characteristic") == [
        [uuids.FRAMES, "16", "244", "0"],
        [uuids.STATUS, "18", "20", "1"],
        [LEGACY, "18", "32", "1"],
    ]
    assert seen.of("setup", "name") == [["Lumitip"]]
    assert seen.of("setup", "interval") == [["6", "12"]]  # 7.5 to 15 ms
    assert seen.of("setup", "timeout") == [["100"]]  # 1 s, well below that of the watchdog
    assert seen.of("setup", "resolution") == [["12"]]
    assert sorted(seen.of("setup", "pin")) == [["13", "1"], ["6", "1"], ["7", "1"], ["8", "1"]]


def test_the_watchdog_runs_and_is_fed_by_every_turn_of_the_loop(seen: Seen) -> None:
    assert seen.of("setup", "watchdog") == [["1", str(10 * 32768 - 1)]]
    for phase in ("alone", "mtu_23", "mtu_247", "serial"):
        assert seen.of(phase, "unfed") == [["0"]]


def test_every_frame_arrives_whole_and_in_cell_order(seen: Seen, measured: Any) -> None:
    packets = [decode(data, 32) for data in seen.sent("mtu_247", uuids.FRAMES)]
    assert len(packets) in (2048 // 5, 2048 // 5 + 1)
    assert all(np.array_equal(values, measured) for p in packets for values in p.values)
    legacy = [decode_legacy(data, 32) for data in seen.sent("mtu_247", LEGACY)]
    assert len(legacy) == len(packets)
    assert all(np.array_equal(values, measured) for values in legacy)


def test_nothing_is_cut_off_at_a_small_mtu(seen: Seen) -> None:
    assert seen.sent("mtu_23", uuids.FRAMES) == []
    assert seen.sent("mtu_23", LEGACY) == []
    (status,) = map(Status.decode, seen.sent("mtu_23", uuids.STATUS))
    assert status.faults == Fault.MTU_TOO_SMALL | Fault.WATCHDOG
    assert (status.mtu, status.needed_mtu) == (23, 51)
    (status,) = map(Status.decode, seen.sent("mtu_247", uuids.STATUS))
    assert (status.mtu, status.faults) == (247, Fault.WATCHDOG)


def test_the_radio_gets_time_of_its_own_between_frames(seen: Seen) -> None:
    for phase in ("alone", "mtu_23", "mtu_247", "serial"):
        ((rests,),) = seen.of(phase, "rests")
        assert 2048 // 5 - 2 <= int(rests) <= 2 * 2048 // 5
    (status,) = map(Status.decode, seen.sent("mtu_247", uuids.STATUS))
    assert not status.faults & Fault.LATE


def test_serial_carries_the_same_packets(seen: Seen, measured: Any) -> None:
    decoder = StreamDecoder(32)
    packets = decoder.feed(b"".join(seen.sent("serial", "serial")))
    assert sum(decoder.dropped.values()) == 0
    assert len(packets) >= 2048 // 5
    assert all(np.array_equal(values, measured) for p in packets for values in p.values)


def test_serial_works_where_bluetooth_does_not_start(played: Callable[..., Seen]) -> None:
    seen = played("silent")
    assert seen.of("setup", "serves") == []
    decoder = StreamDecoder(32)
    assert len(decoder.feed(b"".join(seen.sent("serial", "serial")))) >= 2048 // 5
    assert flashes(seen, "alone") == flashes(seen, "serial") == 3


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("preset", "defines", "pin"),
    [("published", ("-DLUMITIP_EMITTER_PIN=9",), "9"), ("flex", (), "5")],
)
def test_an_emitter_that_is_switched_takes_ambient_light_off(
    host_program: Callable[..., Path],
    run: Callable[..., Any],
    sketch: Callable[[str], Path],
    preset: str,
    defines: tuple[str, ...],
    pin: str,
) -> None:
    done = run(str(host_program("sketch", preset, STUBS, *defines)))
    assert done.returncode == 0, done.stderr
    seen = Seen(done.stdout)
    assert [pin, "1"] in seen.of("setup", "pin")
    layout = Layout.load(sketch(preset).parent / "layout.json")
    wanted = np.maximum((layout.mux * 977 + layout.channel * 131) % 4096, 300) >> 4
    packets = [decode(data, 32) for data in seen.sent("mtu_247", uuids.FRAMES)]
    frames = sum(len(p.values) for p in packets)
    assert frames > 0.8 * 2_048_000 / packets[0].period_us
    assert all(np.array_equal(values, wanted) for p in packets for values in p.values)


@pytest.mark.slow
def test_a_switched_emitter_may_stay_on_for_the_full_rate(
    host_program: Callable[..., Path], run: Callable[..., Any]
) -> None:
    defines = ("-DLUMITIP_AMBIENT=0", "-DLUMITIP_PERIOD_US=5000")
    done = run(str(host_program("sketch", "flex", STUBS, *defines)))
    assert done.returncode == 0, done.stderr
    seen = Seen(done.stdout)
    switched = [level for pin, level in seen.of("mtu_247", "pin") if pin == "5"]
    assert ["5", "1"] in seen.of("setup", "pin")
    assert switched == []
    packets = [decode(data, 32) for data in seen.sent("mtu_247", uuids.FRAMES)]
    assert {p.period_us for p in packets} == {5000}
    assert sum(len(p.values) for p in packets) > 0.8 * 2_048_000 / 5000


def test_the_light_tells_the_state(seen: Seen) -> None:
    assert flashes(seen, "alone") == 1
    assert flashes(seen, "mtu_23") == 2
    for phase in ("mtu_247", "serial"):
        ((_, lit_ms),) = seen.of(phase, "light")
        assert int(lit_ms) >= 2040


def flashes(seen: Seen, phase: str) -> int:
    """Flashes in the 2.048 s of a phase, each of 120 ms; one may lie across its ends."""
    ((rises, lit_ms),) = seen.of(phase, "light")
    count = round(int(lit_ms) / 120)
    assert abs(int(lit_ms) - 120 * count) < 12
    assert int(rises) - count in (0, 1)
    return count
