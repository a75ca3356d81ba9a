"""User files that once failed, derived anew; and random ones, built and checked."""

from pathlib import Path

import pytest

from acceptance.generator import design
from acceptance.trial import Trial, build_file, derive_file, design_folder

CASES = sorted((Path(__file__).parent / "cases").glob("*.toml"))
REFUSED_STILL = frozenset(
    {
        "bluetooth_name_in_japanese",
        "cells_13",
        "cells_160_on_another_controller",
        "cells_22",
        "cells_23",
        "cells_3",
        "cells_76",
        "equal_columns",
        "five_volts",
        "five_volts_narrow_pitch",
        "flex_with_a_thicker_plate",
        "larger_screws_of_the_breakout",
        "many_leds_from_9_volts",
        "more_cells_than_small_multiplexers_read",
        "name_in_chinese",
        "one_column",
        "patch_of_irregular_columns",
        "preset_extended",
        "shorter_tip_margin",
        "three_short_columns",
        "wide_grid_with_many_cells",
    }
)
"""Cases that no automatic choice mends yet; one that is mended leaves the list."""
BUILT = 10


def test_only_cases_that_exist_are_said_to_be_refused_still() -> None:
    assert {case.stem for case in CASES} >= REFUSED_STILL


def _derived(text: str, name: str) -> Trial:
    with design_folder() as folder:
        file = folder / f"{name}.toml"
        file.write_text(text, encoding="utf-8")
        return derive_file(file)


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, id=case.stem, marks=[pytest.mark.xfail(strict=True)])
        if case.stem in REFUSED_STILL
        else pytest.param(case, id=case.stem)
        for case in CASES
    ],
)
def test_a_design_that_was_refused_is_accepted(case: Path) -> None:
    trial = _derived(case.read_text(encoding="utf-8"), case.stem)
    assert not trial.crash, trial.crash
    assert trial.refusals == ()


@pytest.mark.slow
@pytest.mark.parametrize("number", range(BUILT))
def test_a_random_design_is_built_and_passes_every_check(number: int) -> None:
    """The first accepted design of a tenth of the seed's first hundred."""
    with design_folder() as folder:
        for index in range(number * 10, number * 10 + 10):
            drawn = design(1, index)
            file = folder / f"{drawn.name}.toml"
            file.write_text(drawn.text, encoding="utf-8")
            if derive_file(file).accepted:
                break
        trial = build_file(file)
    assert not trial.crash, trial.crash
    assert trial.failed == ()
