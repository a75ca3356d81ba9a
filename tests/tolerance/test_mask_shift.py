"""How far a mask may be off: the figure in the manual, and where it comes from."""

from functools import partial

import pytest

from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import fingerprint, spreads
from lumitip_fab.docs.wrapping import wrapping_steps
from lumitip_fab.tolerance.bench import bench
from lumitip_fab.tolerance.draws import draw
from lumitip_fab.tolerance.study import MASK_FINGERS, Options, case_of, mask_allowance_mm

MASK = {
    "flaps": [{"number": 1, "reach_mm": 5.0}],
    "apertures": 32,
    "wide_mm": 60.0,
    "long_mm": 60.0,
    "band_mm": 1.0,
}


@pytest.mark.slow
def test_the_figure_of_the_catalogue_is_what_a_study_finds(design: Resolved) -> None:
    config, layout, options = design.config, design.design.layout, Options()
    table = config.catalogue.tolerances
    take = partial(draw, table, spreads(config), len(layout))
    errors = bench(case_of(config, layout, options)).errors
    found = mask_allowance_mm(errors, take(MASK_FINGERS, options.seed), options.goals)
    assert found == design.design.mask.most_shift_mm


def test_the_manual_quotes_it_where_the_mask_is_laid(design: Resolved) -> None:
    steps = {step.title: step.text for step in wrapping_steps(design.design, MASK, "receiver")}
    most_mm = design.design.mask.most_shift_mm
    assert f"The mask may be {most_mm:g} mm off" in steps["Wrap the finger"]
    assert "simulated" in steps["Wrap the finger"]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("mask.hole_mm", 2.4),
        ("stack.silicone_mm", 1.6),
        ("backing.pin_clearance_mm", 0.1),
    ],
)
def test_it_says_nothing_of_a_design_that_was_not_studied(
    design: Resolved, field: str, value: object
) -> None:
    other = derive(design.config.with_values({field: value}))
    assert other.mask.most_shift_mm is None
    texts = [step.text for step in wrapping_steps(other, MASK, "receiver")]
    assert not any("mm off" in text for text in texts)


def test_a_gripper_and_a_mould_change_nothing_of_it(design: Resolved) -> None:
    other = design.config.with_values({"coupling.gripper": "wsg50", "mould.wall_mm": 3.0})
    layout = design.design.layout
    assert fingerprint(other, layout) == fingerprint(design.config, layout)
