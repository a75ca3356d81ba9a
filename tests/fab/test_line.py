"""The capacitance of a wire to the controller, in the firmware's wait."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.electrical import Channel
from lumitip_fab.docs.spec_circuit import channel_rows

Write = Callable[[str], Path]
EACH = '[receiver]\nload = "each"\npull_up_ohm = "auto"\n'
PF_PER_M = 100.0
DEFAULT_MM = 150.0  # from the fingers to the controller


@pytest.fixture
def channel(file: Write) -> Callable[[str], Channel]:
    def of(text: str) -> Channel:
        return derive(load(file(EACH + text))).electrical.channel

    return of


def test_a_longer_wire_has_more_capacitance_and_a_longer_wait(
    channel: Callable[[str], Channel],
) -> None:
    usual, longer, longest = (
        channel(f"[wiring]\ncontroller_mm = {mm}\n") for mm in (DEFAULT_MM, 1000.0, 2000.0)
    )
    assert usual.wire_pf == 0.3 * PF_PER_M, "as a wire of 300 mm, at least"
    assert longest.wire_pf - longer.wire_pf == pytest.approx(PF_PER_M)
    assert longest.line_pf - longer.line_pf == pytest.approx(PF_PER_M)
    assert usual.wait_us and longer.wait_us and longest.wait_us
    share = (longest.wait_us - longer.wait_us) / (longer.wait_us - usual.wait_us)
    assert share == pytest.approx(PF_PER_M / (longer.wire_pf - usual.wire_pf))


def test_slack_and_stroke_count(channel: Callable[[str], Channel]) -> None:
    far = "[wiring]\ncontroller_mm = 1000.0\nslack_mm = {}\n"
    slack, less = (channel(far.format(mm)) for mm in (140.0, 40.0))
    assert slack.wire_pf - less.wire_pf == pytest.approx(0.1 * PF_PER_M)
    wide = '[coupling]\ngripper = "robotiq_2f140"\n'
    assert channel(far.format(40.0) + wide).wire_pf > less.wire_pf


INPUTS, MOST_MS = 16, 5.0


@pytest.mark.parametrize("current_ma", ['"auto"', "3.0"])
def test_an_automatic_pull_up_is_fast_enough_over_any_wire(file: Write, current_ma: str) -> None:
    far = (
        '[receiver]\nload = "each"\npull_up_ohm = "auto"\nmultiplexer = "74HC4067PW"\n'
        f"[emitter]\ncurrent_ma = {current_ma}\n[wiring]\ncontroller_mm = 2000.0\n"
    )
    design = derive(load(file(far)))
    wait_us = design.electrical.channel.wait_us
    scan_ms = INPUTS * (wait_us or 0.0) / 1000 + 32 * 0.03
    assert 0.8 * MOST_MS < scan_ms <= MOST_MS
    (reason,) = [c.reason for c in design.choices if c.field == "receiver.pull_up_ohm"]
    assert "settles too slowly" in reason
    assert f"{100 * design.electrical.channel.light_share:.0f} % of its range" in reason


def test_the_spec_names_a_pull_up_that_is_fast_enough(file: Write) -> None:
    own = '[receiver]\nload = "each"\npull_up_ohm = {}\n'

    def reason(ohm: float) -> str:
        rows = channel_rows(derive(load(file(own.format(ohm)))))
        return next(r.reason for r in rows if r.quantity == "... of a phototransistor")

    found = re.search(r"fewer than 200 a second. A pull-up of (\d+) Ω is faster", reason(75e3))
    assert found is not None
    fast_ohm = float(found[1])
    assert "fewer than" not in reason(fast_ohm)
    wait_us = derive(load(file(own.format(fast_ohm)))).electrical.channel.wait_us
    assert wait_us and 8 * wait_us / 1000 + 32 * 0.03 <= MOST_MS
    assert "fewer than" in reason(1.1 * fast_ohm // 1000 * 1000)
