"""The changes that a refusal names: found where values that work are few, and none without need."""

from typing import Any

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.derive.auto.remedies import Plan, plan_of, remedy_lines
from lumitip_fab.derive.auto.resolve import RuleError
from lumitip_fab.derive.auto.search import bounds

pytestmark = pytest.mark.slow

CROSSED = "[outline]\nshoulder_margin_mm = 2.0\ntip_margin_mm = 1.0\nend_margin_mm = 1.0\n"


@pytest.fixture
def plan(file: Any) -> Any:
    """`plan(text)`: what is named for a refused file."""

    def named(text: str) -> Plan:
        with pytest.raises(RuleError) as caught:
            resolve(load(file(text)))
        return plan_of(caught.value.verdict)

    return named


def test_a_number_or_a_word_has_the_bounds_of_the_number() -> None:
    assert bounds("holder.body_mm") == (20, 200)
    assert bounds("mask.hole_mm") == (0.3, 20)


def test_a_body_that_is_too_small_gets_a_diameter(plan: Any) -> None:
    found = plan("[holder]\nbody_mm = 40.0\n")
    assert found.complete
    (remedy,) = found.steps[0].remedies[:1]
    assert remedy.field == "holder.body_mm"
    assert 45.8 <= remedy.value < 60


def test_few_values_that_work_are_found(plan: Any) -> None:
    """From 5 mm, steps that double lead past 2.1 to 3 mm."""
    found = plan("[breakout]\nhole_mm = 5.0\n")
    assert [(r.field, r.value) for r in found.steps[0].remedies] == [("breakout.hole_mm", 3.0)]


def test_one_change_is_named_where_it_is_enough(plan: Any, file: Any) -> None:
    found = plan("[emitter]\ncurrent_ma = 30.0\nstring_leds = 5\n")
    assert found.complete
    (step,) = found.steps
    assert {r.field for r in step.remedies} == {"emitter.current_ma"}
    current = step.remedies[0].value
    assert 7 < current < 9  # the heat that the glue bears
    resolve(load(file(f"[emitter]\ncurrent_ma = {current}\nstring_leds = 5\n")))


def test_a_limit_is_not_raised_that_a_later_change_makes_needless(plan: Any) -> None:
    found = plan("[mask]\nhole_mm = 5.8\n[emitter]\ncurrent_ma = 60.0\n")
    assert found.complete
    assert sorted(s.remedies[0].field for s in found.steps) == [
        "emitter.current_ma",
        "mask.hole_mm",
    ]


def test_values_are_named_as_the_file_has_them(plan: Any) -> None:
    found = plan("[supply]\nvoltage_v = 36.0\n")
    by_field = {r.field: r for step in found.steps for r in step.remedies}
    assert by_field["supply.voltage_v"].was == 36.0
    assert by_field["supply.voltage_v"].value == 24.0, "no TVS diode protects more"
    assert by_field["flange.enabled"].value is False
    assert found.steps[0].remedies[0].field == "supply.voltage_v"


@pytest.mark.parametrize(
    ("text", "field", "value"),
    [
        ("[receiver]\npull_up_ohm = 70000.0\n", "receiver.pull_up_ohm", 69800.0),
        ("[stack]\nfilm_mm = 0.2\n", "stack.film_mm", 0.1),
        (
            '[controller]\nboard = "nrf52840_module"\n[flange]\nenabled = false\n',
            "flange.enabled",
            True,
        ),
        ("[tip]\nslant_start_mm = 20.0\nedge_mm = 0.3\n", "tip.edge_mm", 0.45),
        (
            "[tip]\nangle_deg = 10.0\nedge_mm = 0.5\n[outline]\ntip_margin_mm = 6.2\n",
            "tip.edge_mm",
            1.35,
        ),
        ("[tip]\nangle_deg = 30.0\nslant_start_mm = 6.0\n", "tip.slant_start_mm", 3.3),
        ("[tip]\nangle_deg = 30.0\nslant_start_mm = 5.0\nedge_mm = 0.5\n", "tip.angle_deg", "auto"),
        ("[wiring]\nsection_mm2 = 1.0\n", "wiring.section_mm2", 0.71),
    ],
)
def test_what_a_message_asks_for_is_named(plan: Any, text: str, field: str, value: object) -> None:
    found = plan(text)
    assert found.complete
    assert (field, value) in [(r.field, r.value) for r in found.steps[0].remedies]


def test_an_outline_that_crosses_itself_is_refused(file: Any) -> None:
    with pytest.raises(RuleError, match="shoulder_margin_mm is 2; at least waist_margin_mm"):
        resolve(load(file(CROSSED)))


def test_several_changes_are_said_to_work_together(file: Any) -> None:
    with pytest.raises(RuleError) as caught:
        resolve(load(file("[mask]\nhole_mm = 5.8\n[stack]\nfloor_mm = 0.5\n")))
    first, *changes = remedy_lines(plan_of(caught.value.verdict))
    assert first == "Smallest changes that together work, each tried:"
    assert changes == ["  mask.hole_mm = 5.6 (now 5.8)", "  stack.floor_mm = 0.8 (now 0.5)"]


def test_more_supply_is_asked_for_than_the_least_current_needs_and_no_more(plan: Any) -> None:
    """32 LEDs from 12 V are four strings. At 19.2 mA a bare detector takes 300 uA, and the largest
    pull-up, 150 kohm, gives (3.3 - 0.2) V / 150 kohm: each string needs 1.3 mA for full light."""
    found = plan('[supply]\nvoltage_v = 12.0\nmax_ma = 5.0\n[receiver]\npull_up_ohm = "auto"\n')
    (remedy,) = found.steps[0].remedies
    assert remedy.field == "supply.max_ma"
    needed_ma = 4 * 19.2 * (3.3 - 0.2) / 150e3 / 300e-6
    assert needed_ma <= remedy.value <= needed_ma + 1
