"""The smooth film of the moulds' floor, from the parameters: its size, its price and its limits."""

from dataclasses import replace
from typing import Any

import pytest
import shapely

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.derive.making.insert import derive_inserts
from lumitip_fab.derive.making.supplies import sheets
from lumitip_fab.design import Box, Insert
from lumitip_fab.errors import InputError

PRESETS = ("published", "dense", "asymmetric", "flex", "wsg50", "franka_hand", "robotiq_2f140")


@pytest.fixture
def filmed(inputs: dict[str, Input], vary: Any) -> Input:
    """The published sensor with a film."""
    varied: Input = vary(inputs["published"], {"mould.insert": "PET 100um"})
    return varied


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_has_room_for_a_film(preset: str, inputs: dict[str, Input], vary: Any) -> None:
    config = inputs[preset]
    bare, design = derive(config), derive(vary(config, {"mould.insert": "PET 100um"}))
    assert not bare.inserts and bare.mould.floor_mm == bare.mould.wall_mm
    (insert,) = design.inserts
    assert insert.thickness_mm == 0.1
    assert design.mould.floor_mm == pytest.approx(design.mould.wall_mm + 0.1)
    assert design.mould.off_layer_mm == 0.0
    assert (design.stack, design.outline, design.keys) == (bare.stack, bare.outline, bare.keys)
    (film,) = [p for p in design.purchase.pieces if p.where == "floor of both moulds"]
    assert (film.pack, film.quantity, film.unit) == ("PET 100um", 1, "sheet")
    assert len(design.purchase.pieces) == len(bare.purchase.pieces) + 1
    assert ("insert", insert.film) in {
        (p.name, p.material) for p in design.heat_steps["cure"].parts
    }


@pytest.mark.parametrize(
    ("half_mm", "margin_mm"), [(30.0, 2.0), (19.0, 1.1), (18.7, 0.8), (18.6, None)]
)
def test_a_narrow_floor_leaves_less_margin_or_no_film(
    half_mm: float, margin_mm: float | None, filmed: Input
) -> None:
    receiver = derive(filmed).receiver
    inserts = derive_inserts(filmed, shapely.box(-half_mm, -30, half_mm, 30), receiver)
    if margin_mm is None:
        assert not inserts
        return
    (insert,) = inserts
    reach_mm = 2.5 / 3**0.5 + max(x for x, _ in receiver.cells)
    assert insert.box.x_max_mm - reach_mm == pytest.approx(margin_mm, abs=0.011)
    assert insert.recess.x_max_mm + 0.5 <= half_mm


def test_the_mould_is_printed_in_layers_that_the_film_is_whole_of(filmed: Input) -> None:
    mould = derive(filmed).mould
    heights = (mould.wall_mm, mould.floor_mm, mould.floor_mm + 1.5)
    assert all(abs(h / mould.layer_mm - round(h / mould.layer_mm)) < 1e-6 for h in heights)
    assert mould.layer_mm == 0.1


def test_a_film_that_the_cure_would_soften_is_refused(filmed: Input) -> None:
    films = filmed.catalogue.films
    weak = films["PET 100um"].model_copy(update={"limit_c": 21.0})
    entries = {"films": {**films, "PET 100um": weak}}
    config = replace(filmed, catalogue=filmed.catalogue.model_copy(update=entries))
    with pytest.raises(InputError) as caught:
        derive(config)
    (problem,) = caught.value.problems
    assert "the insert of PET transparency 100 µm withstands 21 °C" in problem.text


@pytest.mark.parametrize(
    ("size_mm", "number"), [((38.0, 30.0), 1), ((95.0, 250.0), 1), ((160.0, 160.0), 2)]
)
def test_two_films_are_cut_from_one_sheet_where_they_fit(
    size_mm: tuple[float, float], number: int
) -> None:
    for wide, long in (size_mm, size_mm[::-1]):
        box = Box(-wide / 2, wide / 2, 0.0, long)
        assert sheets(Insert("insert", "film", 0.1, box, 0.3)) == number
