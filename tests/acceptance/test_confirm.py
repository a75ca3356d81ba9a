"""Refusals are confirmed by physics, and denied where a value would have been accepted."""

import pytest

from acceptance.confirm import confirm, lack_of_power, least_current_ma, reasons
from acceptance.generator import Design
from acceptance.limits import Values
from acceptance.search import way_out
from acceptance.trial import Refusal, Trial, derive_file, design_folder


def _design(**edits: object) -> Design:
    fields = {field.replace("__", "."): value for field, value in edits.items()}
    return Design("by_hand", "published", ("by hand",), fields)


def _trial(design: Design) -> Trial:
    with design_folder() as folder:
        file = folder / "by_hand.toml"
        file.write_text(design.text, encoding="utf-8")
        return derive_file(file)


def test_a_file_within_the_ranges_is_accepted_and_one_with_a_typing_error_is_not() -> None:
    assert _trial(_design(grid__pitch_mm=6.5)).accepted
    refused = _trial(_design(grid__pich_mm=6.5))
    assert [r.field for r in refused.refusals] == ["grid.pich_mm"]
    assert not refused.accepted


def test_an_exception_that_no_user_should_see_is_a_crash(monkeypatch: pytest.MonkeyPatch) -> None:
    import lumitip_fab.derive

    def fail(_: object) -> None:
        raise ZeroDivisionError("by a pitch of 0")

    monkeypatch.setattr(lumitip_fab.derive, "derive", fail)
    trial = _trial(_design(grid__pitch_mm=6.5))
    assert not trial.accepted
    assert "ZeroDivisionError: by a pitch of 0" in trial.crash


def test_silicone_thinner_than_the_parts_is_confirmed(monkeypatch: pytest.MonkeyPatch) -> None:
    design = _design(stack__silicone_mm=0.8)
    monkeypatch.setattr("acceptance.confirm.way_out", lambda _: None)
    verdict = confirm(design, _trial(design), search=False)
    assert verdict.confirmed
    assert verdict.text.startswith("confirmed: cover: 0.8 mm of silicone")


@pytest.mark.slow
def test_a_groove_deeper_than_the_plate_allows_is_confirmed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("acceptance.confirm.way_out", lambda _: None)
    bends = {"backing__variant": "flex", "backing__material": "TPU 98A", "stack__pcb_mm": 0.11}
    thin = _design(**bends, stack__floor_mm=1.1)
    assert {r.field for r in _trial(thin).refusals} == {"flex.groove_depth_mm"}
    verdict = confirm(thin, _trial(thin), search=False)
    assert verdict.text == (
        "confirmed: groove: a plate of 1.1 mm, a wall of 0.8 mm and a rim of 0.45 mm"
    )
    assert not reasons(Values(_design(**bends, stack__floor_mm=1.5).edits, thin.base))


@pytest.mark.slow
def test_a_wall_thinner_than_a_printed_line_is_confirmed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acceptance.confirm.way_out", lambda _: None)
    wide = _design(printer__profile="fdm 0.6", printer__fit_mm=0.05)
    assert {r.field for r in _trial(wide).refusals} == {"coupling.gripper"}
    verdict = confirm(wide, _trial(wide), search=False)
    assert verdict.text == "confirmed: block: 0.55 mm between bolt and pins, a line of 0.65 mm"
    assert not reasons(Values(_design(printer__profile="fdm 0.6").edits, wide.base))


def test_a_refusal_without_a_physical_reason_is_not_confirmed() -> None:
    design = _design(mask__hole_mm=2.5, tip__edge_mm=0.5)
    trial = Trial("by_hand", refusals=(Refusal("tip.edge_mm", "0.5 given"),))
    verdict = confirm(design, trial, search=False)
    assert not verdict.confirmed
    assert verdict.text == "NOT CONFIRMED: no physical reason for tip.edge_mm"


def test_one_reason_does_not_confirm_the_refusal_of_another_field() -> None:
    design = _design(stack__silicone_mm=0.8, name="Finger")
    problems = (Refusal("stack.silicone_mm", "0.8 given"), Refusal("name", "'Finger' given"))
    verdict = confirm(design, Trial("by_hand", refusals=problems), search=False)
    assert (verdict.confirmed, verdict.text.rpartition(" ")[2]) == (False, "name")


def test_a_way_out_denies_what_physics_would_confirm(monkeypatch: pytest.MonkeyPatch) -> None:
    design = _design(stack__silicone_mm=0.8)
    found = {"receiver.multiplexer": "flat"}
    monkeypatch.setattr("acceptance.confirm.way_out", lambda _: found)
    verdict = confirm(design, _trial(design), search=False)
    assert (verdict.confirmed, verdict.text) == (False, f"NOT CONFIRMED: accepted with {found}")


@pytest.mark.slow
def test_the_search_finds_what_a_refused_file_lacks() -> None:
    """A tip margin that the tip's wedge reaches beyond: it starts nearer to the tip."""
    design = _design(outline__tip_margin_mm=5.6)
    if _trial(design).refusals:
        assert set(way_out(design) or {}) == {"tip.slant_start_mm"}


def test_power_is_lacking_where_no_division_into_strings_has_enough() -> None:
    """At least 2.51 mA: 95 % of the 41.3 uA of the pull-up's full scale, of 300 uA at 19.2 mA."""
    values = Values({}, "published")
    assert least_current_ma(values) == pytest.approx(0.95 * 19.2 * 3.1 / 75e3 * 1e6 / 300)
    assert lack_of_power(values) == ""
    weak = Values({"supply.max_ma": 4.9}, "published")  # two strings of 16
    assert lack_of_power(weak) == "power: 5.0 mA needed, 4.9 mA there"
    assert "emitter.current_ma" in reasons(weak)
    hot = Values({"emitter.max_heat_w": 0.1}, "published")
    assert lack_of_power(hot).startswith("power: 0.12 W needed")
    assert lack_of_power(Values({"supply.voltage_v": 1.1}, "published")).startswith("power: an LED")
