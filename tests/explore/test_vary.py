"""What `--vary` asks for, and what it refuses."""

import itertools
from pathlib import Path

import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.errors import InputError
from lumitip_fab.explore.run import without_price
from lumitip_fab.explore.vary import axes, changed, combinations, same_size


@pytest.fixture(scope="module")
def config(design_dir: Path) -> Input:
    return load(design_dir / "fingertip.toml")


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("grid.pitch_mm=3:8", (3.0, 4.25, 5.5, 6.75, 8.0)),
        ("grid.pitch_mm=3:4:0.25", (3.0, 3.25, 3.5, 3.75, 4.0)),
        ("mask.hole_mm=0.5:0.9:0.3", (0.5, 0.8)),
        ("mask.hole_mm = 1.5, 2", (1.5, 2)),
        ("emitter.string_leds=2:4", (2, 3, 4)),
        ("grid.columns=[[5, 4, 5], [4, 5]]", ((5, 4, 5), (4, 5))),
        ("receiver.multiplexer=74HC4051PW,74HC4067PW", ("74HC4051PW", "74HC4067PW")),
        ('mask.hole_shape="circle"', ("circle",)),
        ("backing.flare_mm=auto,2.0", ("auto", 2.0)),
    ],
)
def test_values_of_a_field(config: Input, text: str, values: tuple[object, ...]) -> None:
    (axis,) = axes(config, [text], points=5)
    assert axis.values == values
    assert [type(v) for v in axis.values] == [type(v) for v in values]


def test_the_last_field_varies_fastest(config: Input) -> None:
    asked = axes(config, ["grid.pitch_mm=5,6", "mask.hole_mm=2,3"], points=2)
    made = [tuple(value for _, value in changes) for changes in combinations(asked)]
    assert made == [(5, 2), (5, 3), (6, 2), (6, 3)]
    parameters = changed(config, (("grid.pitch_mm", 5), ("mask.hole_mm", 2))).parameters
    assert (parameters.grid.pitch_mm, parameters.mask.hole_mm) == (5, 2)
    assert parameters.grid.columns == config.parameters.grid.columns


def test_an_automatic_value_is_left_to_the_derivation(config: Input) -> None:
    field, start = "backing.flare_mm", config.parameters.backing.flare_mm
    written = changed(config, ((field, 2.0),))
    assert (written.value(field), field in written.automatic) == (2.0, False)
    again = changed(written, ((field, "auto"),))
    assert (again.value(field), field in again.automatic) == (start, True)
    (axis,) = axes(config, ["emitter.led=auto,VSMY1850"], points=2)
    assert axis.values == ("auto", "VSMY1850")
    assert without_price(config, [axis]) == [], "each LED of the catalogue has a price"
    with pytest.raises(InputError, match=r"grid\.pitch_mm is 'auto'"):
        axes(config, ["grid.pitch_mm=auto,5"], points=2)


def test_every_fault_of_every_text_is_told_at_once(config: Input) -> None:
    texts = [
        "grid.pich_mm=3:8",
        "mask.hole_mm",
        "mask.hole_mm=4:1",
        "mask.flap_mm=5:x",
        "stack.film_mm=0.1:0.2:0",
        "grid.columns=[[5, 4",
        "emitter.led=none",
        "tip.edge_mm=9",
        "tip.edge_mm=0.5",
        "grid.columns=[]",
        "mould.draft_deg=inf:3",
    ]
    with pytest.raises(InputError) as caught:
        axes(config, texts, points=6)
    told = str(caught.value)
    for part in (
        "Did you mean 'grid.pitch_mm'?",
        "FIELD=FROM:TO",
        "FROM must be below TO",
        "is '5:x'; FROM",
        "has a step of 0;",
        "no TOML list",
        "is 'none', which does not exist",
        "Names in parts/leds.toml:",
        "is 9; at most 5 is allowed",
        "tip.edge_mm is there twice",
        "is an empty list",
        "is 'inf:3'; FROM",
    ):
        assert part in told, part
    assert all(problem.file == "--vary" for problem in caught.value.problems)


def test_no_more_designs_than_can_be_evaluated(config: Input) -> None:
    with pytest.raises(InputError, match="makes 40000 designs; at most 10000"):
        axes(config, ["grid.pitch_mm=3:8", "mask.hole_mm=1:4"], points=200)
    with pytest.raises(InputError, match="has 1 points; a range needs at least 2"):
        axes(config, ["grid.pitch_mm=3:8"], points=1)


@pytest.mark.parametrize("columns", [(5, 4, 5, 4, 5, 4, 5), (4, 5, 4), (4, 5, 6, 5)])
def test_a_grid_keeps_its_size_with_another_pitch(columns: tuple[int, ...]) -> None:
    assert same_size((5, 4, 5, 4, 5, 4, 5), 6.0, 6.0) == (5, 4, 5, 4, 5, 4, 5)
    for new_mm in (3.0, 4.3, 6.0, 8.0):
        made = same_size(columns, 6.0, new_mm)
        assert {abs(a - b) for a, b in itertools.pairwise(made)} == {1}
        assert abs((len(made) - 1) * new_mm - (len(columns) - 1) * 6.0) <= new_mm / 2.0 + 1e-9
        assert abs((max(made) - 1) * new_mm - (max(columns) - 1) * 6.0) <= new_mm / 2.0 + 1e-9
        assert (made[0] < made[1]) == (columns[0] < columns[1])


@pytest.mark.parametrize(
    ("columns", "new_mm", "wanted"),
    [
        ((7,), 3.0, (13,)),
        ((4, 4, 4, 4), 3.0, (7, 7, 7, 7, 7, 7, 7)),
        ((1, 2, 3, 2, 1), 3.0, (1, 2, 3, 4, 5, 4, 3, 2, 1)),
        ((1, 2, 3, 2, 1), 12.0, (1, 2, 1)),
        ((5, 2, 5), 3.0, (9, 6, 3, 6, 9)),
        ((4, 5, 6, 5), 3.0, (7, 8, 9, 10, 11, 10, 9)),
    ],
)
def test_any_grid_keeps_its_silhouette_with_another_pitch(
    columns: tuple[int, ...], new_mm: float, wanted: tuple[int, ...]
) -> None:
    assert same_size(columns, 6.0, 6.0) == columns
    assert same_size(columns, 6.0, new_mm) == wanted
