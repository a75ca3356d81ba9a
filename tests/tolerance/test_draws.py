"""Deviations have the stated spread, follow the design, and are written with source and level."""

import math
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.errors import InputError
from lumitip_fab.tolerance.draws import FACTORS, draw
from lumitip_fab.tolerance.streams import Stream, generator


@pytest.mark.parametrize("name", FACTORS)
def test_a_deviation_has_its_stated_spread(design: Resolved, name: str) -> None:
    table = design.config.catalogue.tolerances
    spread = spreads(design.config)
    drawn = draw(table, spread, 32, 4000, seed=3)[name]
    uniform = getattr(table, name).distribution == "uniform"
    expected = spread[name] / math.sqrt(3.0) if uniform else spread[name]
    assert drawn.std() == pytest.approx(expected, rel=0.06)
    assert abs(drawn.mean()) < 0.06 * expected
    assert (np.abs(drawn).max() <= spread[name]) == uniform


def test_print_accuracy_follows_the_printer_and_play_the_clearances(design: Resolved) -> None:
    fine, coarse = (
        spreads(design.config.with_values({"printer.profile": name}))
        for name in ("fdm 0.25", "fdm 0.6")
    )
    assert coarse["print"] / fine["print"] == pytest.approx(0.65 / 0.28)
    assert coarse["silicone"] / fine["silicone"] == pytest.approx(0.3 / 0.1)
    loose = design.config.with_values(
        {"backing.pin_clearance_mm": 0.4, "backing.pocket_clearance_mm": 0.3}
    )
    assert spreads(design.config)["board"] == 0.15
    assert spreads(loose)["board"] == 0.3, "the pocket holds what the pins do not"


def test_more_fingers_begin_with_the_same_ones_and_seeds_differ(design: Resolved) -> None:
    table, spread = design.config.catalogue.tolerances, spreads(design.config)
    few, many, other = (
        draw(table, spread, 32, count, seed) for count, seed in ((3, 1), (9, 1), (3, 2))
    )
    for name in FACTORS:
        assert np.array_equal(few[name], many[name][:3])
        assert not np.array_equal(few[name], other[name])


def test_ones_own_figures_replace_those_of_the_catalogue(design_dir: Path, tmp_path: Path) -> None:
    file = tmp_path / "fingertip.toml"
    file.write_bytes((design_dir / "fingertip.toml").read_bytes())
    (tmp_path / "parts").mkdir()
    text = (design_dir / "parts" / "tolerances.toml").read_text(encoding="utf-8")
    own = tmp_path / "parts" / "tolerances.toml"
    own.write_text(text.replace('spread = 0.25\nmeasure = "with', 'spread = 0.1\nmeasure = "with'))
    assert spreads(load(file))["mask_shift"] == 0.1


@pytest.mark.parametrize(
    ("name", "line", "place"),
    [
        ("mask_turn", 'unit = "mm"', r"mask_turn\.unit is 'mm'"),
        ("gap", 'unit = "deg"', r"gap\.unit is 'deg'"),
        ("led", 'unit = "mm"', r"led\.unit is 'mm'"),
        ("hole", 'of = "pin"', r"hole\.of is 'pin'"),
        ("print", 'of = "layer"', r"print\.of is 'layer'"),
    ],
)
def test_each_deviation_has_its_unit_and_length(
    design_dir: Path, tmp_path: Path, name: str, line: str, place: str
) -> None:
    file = tmp_path / "fingertip.toml"
    file.write_bytes((design_dir / "fingertip.toml").read_bytes())
    (tmp_path / "parts").mkdir()
    text = (design_dir / "parts" / "tolerances.toml").read_text(encoding="utf-8")
    before, after = text.split(f"[{name}]\n")
    entry, *rest = after.split("\n\n")
    key = line.split(" ", maxsplit=1)[0]
    kept = [one for one in entry.split("\n") if not one.startswith(f"{key} =")]
    changed = "\n\n".join(["\n".join([line, *kept]), *rest])
    own = tmp_path / "parts" / "tolerances.toml"
    own.write_text(f"{before}[{name}]\n{changed}", encoding="utf-8")
    with pytest.raises(InputError, match=rf"tolerances\.toml:\d+: {place}"):
        load(file)


def test_no_two_uses_of_random_numbers_share_a_stream(design: Resolved) -> None:
    table = design.config.catalogue.tolerances
    ones = dict.fromkeys(FACTORS, 1.0)
    first, other = (draw(table, ones, 32, 40, 2, part) for part in (0, 1))
    begins = [
        *(tuple(draws[name].ravel()[:2]) for draws in (first, other) for name in FACTORS),
        *(tuple(generator(2, stream).standard_normal(2)) for stream in Stream),
    ]
    assert len(set(begins)) == len(begins)
