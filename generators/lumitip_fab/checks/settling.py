"""How far a reading is from its settled value when the firmware takes it: the phototransistor by
the equations of Ebers and Moll, integrated over time, at the corners of its spread.

    supply ── R ──┬── R_on ── line, C ── ADC        a pull-up for each photodetector
                  └── collector ── C_b ── base

With one pull-up for all, which is on the line, a collector floats until its turn.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.electrical import Channel

THERMAL_V = 0.0258520
SATURATION_A = 1e-14
REVERSE_GAIN = 2.0
OPEN_OHM = 1e12
COUNTS, MOST_COUNTS = 255.0, 0.5
LIGHTS = (0.0, 0.4, 0.7, 0.9, 0.94)
"""On the photodetector that is read, as shares of what saturates its pull-up; it settles last just
before that, and soon beyond. The one before it was in full light or in the dark."""
LINE_FACTOR, SENT_BITS = 2.0, 8
"""By which the firmware waits where it does not know the photodetector."""
_REST_S = 10.0


def measure_settling(read: ReadBoard) -> Iterator[Measurement]:
    """The largest error after a change of channel, at the firmware's shortest wait."""
    if not read.muxes:
        return
    channel, own = read.design.electrical.channel, read.design.wiring.own_pull_ups
    values = [ohm(part.value) for ref, part in read.parts.items() if ref.startswith("R")]
    pull_up_ohm = max(values, default=math.nan)
    line_us = pull_up_ohm * (channel.line_pf + channel.detector_pf) * 1e-6
    wait_us = channel.wait_us or LINE_FACTOR * line_us * math.log(2.0) * (SENT_BITS + 1)
    worst, note = math.nan, "no pull-up"
    if not math.isnan(pull_up_ohm):
        errors = {
            (gain, base_pf): max(
                _error_counts(
                    _Cell(channel, pull_up_ohm, own, gain, base_pf, light), line_v, wait_us
                )
                for light, line_v in product(LIGHTS, (0.0, channel.supply_v))
            )
            for gain, base_pf in product(_spread(channel.gain), channel.base_pf)
        }
        (gain, base_pf), worst = max(errors.items(), key=lambda item: item[1])
        note = f"of 255, {wait_us:.0f} us after a change of channel; hFE {gain:g}, {base_pf:g} pF"
    note += "" if own else "; shared pull-ups: reported only"
    yield read.figure("settling", worst, 0, MOST_COUNTS if own else COUNTS, "counts", note)


def _spread(ends: tuple[float, float]) -> tuple[float, float, float]:
    """Both ends and their geometric mean."""
    return ends[0], math.sqrt(ends[0] * ends[1]), ends[1]


@dataclass(frozen=True)
class _Cell:
    """A photodetector that the multiplexer turns to."""

    channel: Channel
    pull_up_ohm: float
    own: bool
    gain: float
    base_pf: float
    light: float

    def error_counts(self, line_v: float, wait_us: float) -> float:
        """Distance of the reading from its settled value, after a line that was at `line_v`."""
        collector_v, base_v = self._run(_REST_S, (line_v, 0.0, 0.0), OPEN_OHM)[1:]
        start = line_v, float(collector_v), float(base_v)
        on_ohm = self.channel.on_resistance_ohm
        read, settled = (self._run(s, start, on_ohm)[0] for s in (wait_us * 1e-6, _REST_S))
        return COUNTS * abs(float(read - settled)) / self.channel.supply_v

    def _run(
        self, seconds: float, start: tuple[float, float, float], on_ohm: float
    ) -> NDArray[np.float64]:
        """Voltages of line, collector and base after some time; shape `(3,)`."""
        channel, pf = self.channel, self.base_pf * 1e-12
        full_a, dark_a = channel.light_current_ua * 1e-6, channel.dark_current_na * 1e-9
        saturated_a = (channel.supply_v - channel.saturation_v) / self.pull_up_ohm
        lit_a = (dark_a + min(full_a, saturated_a) * self.light) / (self.gain + 1)
        line_f, own_f = channel.line_pf * 1e-12, channel.detector_pf * 1e-12
        at_line_ohm, at_collector_ohm = (
            (OPEN_OHM, self.pull_up_ohm) if self.own else (self.pull_up_ohm, OPEN_OHM)
        )
        # The base's capacitor couples the collector to it.
        coupled = np.linalg.inv(np.array([[own_f + pf, -pf], [-pf, 2 * pf]]))

        def slope(_: float, volts: NDArray[np.float64]) -> list[float]:
            line, collector, base = volts.tolist()
            forward = SATURATION_A * math.expm1(min(base / THERMAL_V, 80.0))
            reverse = SATURATION_A * math.expm1(min((base - collector) / THERMAL_V, 80.0))
            through = (collector - line) / on_ohm
            pulled = (channel.supply_v - collector) / at_collector_ohm
            into_collector = pulled - through - forward + reverse * (1 + 1 / REVERSE_GAIN) - lit_a
            into_base = lit_a - forward / self.gain - reverse / REVERSE_GAIN
            rise, base_rise = coupled @ (into_collector, into_base)
            fed = (channel.supply_v - line) / at_line_ohm
            return [(fed + through) / line_f, float(rise), float(base_rise)]

        end = solve_ivp(slope, (0.0, seconds), start, method="LSODA", rtol=1e-6, atol=1e-7)
        return np.asarray(end.y[:, -1], dtype=np.float64)


@lru_cache(maxsize=1024)
def _error_counts(cell: _Cell, line_v: float, wait_us: float) -> float:
    """`cell.error_counts`, integrated once a process: boards that are checked again and again have
    the same photodetectors."""
    return cell.error_counts(line_v, wait_us)
