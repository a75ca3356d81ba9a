"""The process of the estimates: its answers, its failures and its end."""

import json
import os
import time
from collections.abc import Callable

import numpy as np
import pytest

from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.frame import Frame
from lumitip.twin import Cable, Twin
from lumitip.view.estimating import Estimates, Expected
from lumitip.view.finger import Finger
from lumitip.view.pose_process import answers

WaitFor = Callable[[Callable[[], bool]], None]


def frame(values: np.ndarray, seq: int = 0) -> Frame:
    raw = np.zeros(len(values), np.uint8)
    return Frame(seq, 0.0, 0.0, 0.0, 0.0, raw, 8, values.astype(np.float32), 0, "test")


@pytest.mark.slow
def test_answers_are_those_of_the_estimator(layout: Layout) -> None:
    values = Twin(layout).values(Cable(offset_mm=1.0, angle_deg=20.0, diameter_mm=5.0))
    first = {"layout": json.loads(layout.to_json()), "gap_mm": 3.0, "diameter_mm": 5.0}
    ready, shown = answers([json.dumps(first), json.dumps(values.tolist())])
    assert ready == {"ready": True}
    expected = PoseEstimator(layout, diameter_mm=5.0)(values)
    assert shown["kind"] == "cable"
    assert shown["width_mm"] == pytest.approx(expected.width_mm, abs=0.05)
    assert list(answers([])) == []


@pytest.mark.slow
def test_an_estimate_comes_for_the_newest_frame_and_close_ends_the_process(
    layout: Layout, wait_for: WaitFor
) -> None:
    estimates = Estimates(layout)
    estimates.start(lambda: None)
    time.sleep(0.1)
    assert estimates._process is None  # nobody looks
    values = Twin(layout).values(Cable(angle_deg=20.0))
    values[3] = np.nan
    asked = [frame(values, seq) for seq in range(5)]
    for number, one in enumerate(asked):
        estimates.ask(one, number)
    wait_for(lambda: estimates.newest is not None and estimates.newest.frame is asked[-1])
    assert estimates.newest
    assert estimates.newest.shown["kind"] == "cable"
    assert estimates.state == "ready"
    process = estimates._process
    assert process is not None
    estimates.close()
    assert process.poll() is not None


def test_close_does_not_wait_for_tables(make_layout: Callable[..., Layout]) -> None:
    many = make_layout((16,) + (15, 16) * 15)
    estimates = Estimates(many)
    estimates.start(lambda: None)
    estimates.ask(frame(np.full(len(many), 255.0)), 1)
    time.sleep(0.5)
    begun = time.monotonic()
    estimates.close()
    assert time.monotonic() - begun < 5.0
    assert estimates.state == "preparing"


def test_a_process_that_is_killed_is_reported(layout: Layout, wait_for: WaitFor) -> None:
    estimates = Estimates(layout)
    estimates.start(lambda: None)
    estimates.ask(frame(np.full(len(layout), 255.0)), 1)
    wait_for(lambda: estimates.newest is not None)
    assert estimates._process
    os.kill(estimates._process.pid, 9)
    estimates.ask(frame(np.full(len(layout), 250.0)), 2)
    wait_for(lambda: estimates.state == "failed")
    assert estimates.detail == "the process of the estimates has ended, exit code -9"
    estimates.close()


def test_expected_gap_and_diameter_are_those_of_the_twin_unless_asked() -> None:
    assert Expected.of("twin://cable?gap=5&diameter=4") == Expected(5.0, 4.0)
    assert Expected.of("twin://cable?gap=5", 2.0, 6.0) == Expected(2.0, 6.0)
    assert Expected.of("twin://cable?diameter=0.1") == Expected(3.0, 0.3)
    assert Expected.of("ble://Lumitip") == Expected()
    assert Expected.of("replay://a?b.mcap") == Expected()


@pytest.mark.slow
def test_reading_goes_on_at_full_rate_while_tables_and_fits_are_computed(
    wait_for: WaitFor,
) -> None:
    class Asks:
        """Asks for an estimate of each frame, as many browsers would."""

        def take(self, finger: Finger, frame: Frame) -> None:
            finger.estimates.ask(frame, finger.count)

    finger = Finger.open("twin://demo?rate=200", sinks=(Asks(),))
    finger.start(lambda: None)
    wait_for(lambda: finger.estimates.newest is not None)
    wait_for(lambda: finger.count > 600)
    stats = finger.tip.stats
    finger.close()
    assert stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 0}
    assert stats.received - finger.count <= 20
