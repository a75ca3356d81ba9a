"""The device through everything that can happen to it, on this computer and on a Cortex-M4, and
what it sent decoded by the codec of the robot's side."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip.layout import Layout
from lumitip.protocol.bluetooth import Fault, Status, decode_legacy
from lumitip.protocol.cobs import StreamDecoder
from lumitip.protocol.packet import Packet, decode, design_code, largest_batch, needed_mtu

pytestmark = pytest.mark.slow

ADC_BITS = 12
FRAMES = 24  # of each phase
ALL_FRAMES = 14 * FRAMES
MISSED = 2
"""Frames that there was no time for in the phase `late`."""


@dataclass(frozen=True)
class Variant:
    """A design with its settings."""

    preset: str
    bits: int = 8
    period_us: int = 5000
    latency_us: int = 7500

    @property
    def defines(self) -> list[str]:
        values = {"BITS": self.bits, "PERIOD_US": self.period_us, "LATENCY_US": self.latency_us}
        values["AMBIENT"] = 0  # one scan a frame; two are in test_scans.py
        return [f"-DLUMITIP_{name}={value}" for name, value in values.items()]

    def __str__(self) -> str:
        return f"{self.preset}-{self.bits}-{self.period_us}"


VARIANTS = (
    Variant("published"),
    Variant("published", 12, 2500, 40_000),
    Variant("asymmetric", 10, 4000, 30_000),
    Variant("dense", 10, 12_000, 48_000),
)


@dataclass
class Phase:
    """What was sent in one phase of `host/scenario.cpp`."""

    notified: list[bytes] = field(default_factory=list)
    serial: bytes = b""
    legacy: list[bytes] = field(default_factory=list)
    statuses: list[Status] = field(default_factory=list)


class Outcome:
    """What a whole run printed."""

    def __init__(self, text: str, layout: Layout, variant: Variant) -> None:
        self.layout, self.variant = layout, variant
        phase = Phase()
        self.phases = {"begin": phase}
        self.began_us: dict[int, int] = {}
        for line in text.splitlines():
            what, *rest = line.split()
            if what == "phase":
                phase = self.phases[rest[0]] = Phase()
            elif what == "notify":
                phase.notified.append(bytes.fromhex(rest[1]))
            elif what == "serial":
                phase.serial += bytes.fromhex(rest[1])
            elif what == "legacy":
                phase.legacy.append(bytes.fromhex(rest[1]))
            elif what == "began":
                self.began_us[int(rest[0]) % 65536] = int(rest[1])
            elif what == "status":
                phase.statuses.append(Status.decode(bytes.fromhex(rest[1])))
            else:
                self.selects, self.unsettled = int(rest[0]), int(rest[2])

    def packets(self, phase: str) -> list[Packet]:
        """The notifications of a phase, decoded, with their values held against the wiring."""
        found = [decode(data, len(self.layout)) for data in self.phases[phase].notified]
        self.check(found)
        return found

    def on_serial(self, *phases: str) -> list[Packet]:
        """The packets on the serial line, of which none may be damaged."""
        decoder = StreamDecoder(len(self.layout))
        found = decoder.feed(b"".join(self.phases[name].serial for name in phases))
        assert sum(decoder.dropped.values()) == 0
        self.check(found)
        return found

    def check(self, packets: list[Packet]) -> None:
        """Hold every frame and its time against what the bench measured: the channel map from end
        to end."""
        for packet in packets:
            assert packet.design == design_code(self.layout.design_hash)
            assert (packet.bits, packet.period_us) == (self.variant.bits, self.variant.period_us)
            for offset, values in enumerate(packet.values):
                assert np.array_equal(values, self.measured(packet.sequence + offset, packet.bits))
                began_us = self.began_us[(packet.sequence + offset) % 65536]
                late = (packet.time_us + offset * packet.period_us - began_us + 2**31) % 2**32
                assert abs(late - 2**31) <= packet.period_us / 8

    def measured(self, frame: int, bits: int) -> Any:
        """The codes that `host/bench_board.h` makes up for a frame."""
        codes = self.layout.mux * 977 + self.layout.channel * 131 + frame * 37
        return codes % (1 << ADC_BITS) >> (ADC_BITS - bits)

    def fault(self, phase: str, fault: Fault) -> bool:
        """Whether the last status outcome until the end of a phase has a fault."""
        names = list(self.phases)
        until = names[: names.index(phase) + 1]
        return fault in [s for name in until for s in self.phases[name].statuses][-1].faults


def numbers(packets: list[Packet]) -> list[int]:
    """The sequence number of every frame."""
    return [(p.sequence + i) % 65536 for p in packets for i in range(p.frames)]


@pytest.fixture(scope="module", params=VARIANTS, ids=str)
def outcome(
    request: pytest.FixtureRequest,
    sketch: Callable[[str], Path],
    host_program: Callable[..., Path],
    run: Callable[..., Any],
) -> Outcome:
    """What a device of each variant sends, run with sanitizers on this computer."""
    variant: Variant = request.param
    done = run(str(host_program("scenario", variant.preset, *variant.defines)))
    assert done.returncode == 0, done.stderr
    layout = Layout.load(sketch(variant.preset).parent / "layout.json")
    return Outcome(done.stdout, layout, variant)


@pytest.mark.parametrize("variant", VARIANTS, ids=str)
def test_a_cortex_m4_sends_the_same(
    variant: Variant,
    sketch: Callable[[str], Path],
    host_program: Callable[..., Path],
    arm_output: Callable[..., str],
    run: Callable[..., Any],
) -> None:
    sent = arm_output("scenario", variant.preset, *variant.defines)
    outcome = Outcome(sent, Layout.load(sketch(variant.preset).parent / "layout.json"), variant)
    assert len(numbers(outcome.packets("mtu_247"))) >= FRAMES - 8
    here = run(str(host_program("scenario", variant.preset, *variant.defines))).stdout
    assert sent == here


def test_serial_carries_every_frame_through_the_wrap_of_number_and_time(outcome: Outcome) -> None:
    packets = outcome.on_serial("serial", "mtu_23", "just_enough", "mtu_247", "not_asked")
    found = numbers(packets)
    assert found == [(65520 + i) % 65536 for i in range(len(found))]
    assert len(found) > 5 * FRAMES - 17
    times = [p.time_us for p in packets]
    assert min(times) < times[0] < max(times)  # the clock wrapped


def test_batches_are_as_large_as_mtu_and_latency_allow(outcome: Outcome) -> None:
    cells, v = len(outcome.layout), outcome.variant
    patient = max(v.latency_us // v.period_us, 1)
    for phase, mtu in (("just_enough", needed_mtu(cells, v.bits)), ("mtu_247", 247)):
        packets = outcome.packets(phase)[1:]  # the first may have begun at the MTU before
        assert packets
        assert {p.frames for p in packets} == {min(patient, largest_batch(mtu, cells, v.bits))}


def test_nothing_is_ever_longer_than_the_mtu(outcome: Outcome) -> None:
    mtus = {"mtu_23": 23, "just_enough": needed_mtu(len(outcome.layout), outcome.variant.bits)}
    for name, phase in outcome.phases.items():
        room = mtus.get(name, 247) - 3
        assert all(len(data) <= room for data in phase.notified)


def test_a_frame_that_does_not_fit_is_not_sent_and_the_status_says_so(outcome: Outcome) -> None:
    assert not outcome.fault("serial", Fault.MTU_TOO_SMALL)
    assert outcome.phases["mtu_23"].notified == []
    status = outcome.phases["mtu_23"].statuses[-1]
    assert Fault.MTU_TOO_SMALL in status.faults
    needed = needed_mtu(len(outcome.layout), outcome.variant.bits)
    assert (status.mtu, status.needed_mtu) == (23, needed)
    assert not outcome.fault("just_enough", Fault.MTU_TOO_SMALL)


def test_nobody_gets_frames_who_did_not_ask(outcome: Outcome) -> None:
    assert outcome.phases["not_asked"].notified == []
    assert outcome.phases["serial"].notified == []


def test_a_refused_notification_is_a_fault(outcome: Outcome) -> None:
    assert not outcome.fault("not_asked", Fault.NOTIFY_FAILED)
    assert outcome.fault("refused", Fault.NOTIFY_FAILED)
    assert outcome.phases["refused"].notified == []


def test_a_serial_line_that_nobody_reads_loses_whole_packets_only(outcome: Outcome) -> None:
    assert not outcome.fault("refused", Fault.SERIAL_FULL)
    assert outcome.fault("serial_stuck", Fault.SERIAL_FULL)
    assert outcome.phases["serial_stuck"].serial == b""
    before = ("serial", "mtu_23", "just_enough", "mtu_247", "not_asked", "refused")
    sent = b"".join(outcome.phases[name].serial for name in (*before, "serial_slow"))
    whole = sent[: sent.rindex(b"\0") + 1]
    decoder = StreamDecoder(len(outcome.layout))
    outcome.check(decoder.feed(whole))
    assert sum(decoder.dropped.values()) == 0
    assert outcome.phases["serial_closed"].serial == b""


def test_a_serial_line_opened_again_begins_with_a_whole_packet(outcome: Outcome) -> None:
    assert outcome.phases["serial_cut"].serial
    assert len(outcome.on_serial("serial_reopened")) >= 1


def test_a_late_scan_is_a_fault_and_what_it_missed_counts_as_lost(outcome: Outcome) -> None:
    assert not outcome.fault("serial_closed", Fault.LATE)
    assert outcome.fault("late", Fault.LATE)
    packets = outcome.packets("serial_closed") + outcome.packets("late") + outcome.packets("jitter")
    found = numbers(packets)
    (missed,) = (step - 1 for step in np.diff(found) if step != 1)
    assert missed == MISSED


def test_the_status_tells_the_design_and_the_watchdog(outcome: Outcome) -> None:
    status = outcome.phases["begin"].statuses[0]
    assert outcome.layout.design_hash.startswith(status.design_hash)
    assert (status.cells, status.mtu) == (len(outcome.layout), 0)
    assert status.faults == Fault.WATCHDOG


def test_legacy_frames_are_the_highest_8_bits_in_cell_order(outcome: Outcome) -> None:
    cells, frame = len(outcome.layout), 65520
    for name, phase in outcome.phases.items():
        frame += MISSED if name == "late" else 0
        for data in phase.legacy:
            values = decode_legacy(data, cells)
            assert np.array_equal(values, outcome.measured(frame, 8))
            frame += 1
    assert frame == 65520 + ALL_FRAMES + MISSED


def test_one_select_line_changes_for_each_input_and_each_settles(outcome: Outcome) -> None:
    channels = 16 if outcome.layout.channel.max() > 7 else 8
    scans = 65520 + ALL_FRAMES
    lines = channels.bit_length() - 1
    assert outcome.unsettled == 0
    assert (
        outcome.selects == lines + scans * channels - 1
    )  # the first input is selected at the start


def test_nothing_is_allocated(
    tmp_path: Path, run: Callable[..., Any], sketch: Callable[[str], Path]
) -> None:
    """Not even behind the scenes: what the compiled core calls is `memcmp` and its like."""
    made = run(
        "arm-none-eabi-g++",
        "-std=c++14",
        "-O2",
        "-mcpu=cortex-m4",
        "-mthumb",
        "-c",
        "-I",
        sketch("published"),
        Path(__file__).parent / "host" / "scenario.cpp",
        "-o",
        tmp_path / "scenario.o",
    )
    assert made.returncode == 0, made.stderr
    listed = run("arm-none-eabi-nm", "--undefined-only", tmp_path / "scenario.o").stdout.split()
    called = {name for name in listed if len(name) > 1 and not name.startswith("__aeabi_")}
    assert called <= {"printf", "puts", "putchar", "memcmp", "memcpy", "memset", "memmove"}
