"""Device time fitted to host time: bunched, late and drifting arrivals."""

import numpy as np
import pytest

from lumitip.session.timing import DeviceClock


def _arrivals(skew_ppm: float, seconds: float, rate_hz: float = 97.0) -> np.ndarray:
    """Rows of device time, host time of reading, host time of arrival (s): 2 ms at the least, in
    bunches of a 30 ms connection interval, now and then stalled for up to 3 s."""
    rng = np.random.default_rng(7)
    read = 5000.0 + np.arange(0.0, seconds, 1.0 / rate_hz)
    device = 3.0 + (read - 5000.0) / (1.0 + skew_ppm * 1e-6)
    arrival = np.ceil((read + 0.002) / 0.03) * 0.03 + rng.exponential(0.001, read.size)
    for start in rng.uniform(5000.0, 5000.0 + seconds, 4):
        stalled = (arrival > start) & (arrival < start + 3.0)
        arrival[stalled] = start + 3.0
    return np.column_stack([device, read, np.maximum.accumulate(arrival)])


@pytest.mark.parametrize("skew_ppm", [-300.0, 0.0, 80.0, 1500.0])
def test_the_fit_tells_when_cells_were_read(skew_ppm: float) -> None:
    clock = DeviceClock()
    errors = []
    for device, read, arrival in _arrivals(skew_ppm, 90.0):
        clock.add(device, arrival)
        errors.append(clock.host(device) - read)
    settled = np.array(errors[3000:])
    # Late by the shortest delay that there is, 2 ms, while arrivals are up to 3 s late.
    assert settled.min() > 0.001
    assert settled.max() < 0.003
    assert clock.skew_ppm == pytest.approx(skew_ppm, abs=40.0)


def test_no_frame_is_fitted_behind_its_arrival() -> None:
    clock = DeviceClock()
    for device, _, arrival in _arrivals(80.0, 60.0):
        clock.add(device, arrival)
        assert clock.host(device) <= arrival + 1e-9


def test_arrivals_that_all_come_late_are_corrected_by_one_that_does_not() -> None:
    clock = DeviceClock()
    for i in range(50):
        clock.add(i * 0.01, 100.0 + i * 0.01 + 2.0)
    assert clock.host(0.5) == pytest.approx(102.5)
    clock.add(0.5, 100.51)
    assert clock.host(0.6) == pytest.approx(100.61)


def test_noise_is_not_taken_for_a_clock_that_runs_wild() -> None:
    clock = DeviceClock()
    for i in range(12):
        clock.add(float(i), 100.0 + i * 1.5)
    assert clock.skew_ppm == pytest.approx(2000.0)
