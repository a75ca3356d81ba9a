"""Frames of built fingers against the twin, and what each mistake must do to them."""

from dataclasses import replace

import numpy as np
import pytest

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Misregistration, Model, Twin
from lumitip.twin.built import Lines, Rays
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.tolerance.bench import Bench, Case
from lumitip_fab.tolerance.draws import FACTORS, Draws, built, draw

ANGLES, OFFSETS = np.radians([5.0, -20.0, 40.0, -65.0, 85.0]), np.array([0.3, -3.0, 5.0, 1.0, -6.0])
EDGES, CABLES = (Lines(kind, np.stack([ANGLES, OFFSETS], axis=1)) for kind in ("edge", "cable"))


@pytest.fixture(scope="session")
def layout(design: Resolved) -> Layout:
    return design.design.layout


@pytest.fixture(scope="session")
def exact(design: Resolved) -> Draws:
    """One pair of fingers without any deviation."""
    table = design.config.catalogue.tolerances
    drawn = draw(table, spreads(design.config), len(design.design.layout), 1, 0)
    return {name: 0.0 * drawn[name] for name in FACTORS}


def shares(layout: Layout, model: Model, draws: Draws, lines: Lines) -> Floats:
    return Rays(layout, model).of(built(layout, model, draws, 0)).shares(lines)


def expected(twin: Twin, lines: Lines) -> Floats:
    table = twin.edge_table() if lines.kind == "edge" else twin.cable_table()
    angle, offset = lines.poses.T
    taken = table.of_lines(twin.layout, offset, np.degrees(angle), np.zeros(len(angle)))
    return 1.0 - taken


def changed(exact: Draws, **values: object) -> Draws:
    return {**exact, **{name: np.array([value], float) for name, value in values.items()}}


@pytest.mark.slow
@pytest.mark.parametrize("lines", [EDGES, CABLES], ids=["edge", "cable"])
@pytest.mark.parametrize(
    ("deviation", "model", "place"),
    [
        ({}, {}, {}),
        ({"finger_shift": [0.5, -0.4]}, {}, {"x_mm": 0.5, "y_mm": -0.4}),
        ({"gap": [0.8]}, {"gap_mm": 3.8}, {}),
        ({"finger_tilt": [2.0]}, {}, {"tilt_deg": 2.0}),
        ({"hole": [-0.3, -0.3]}, {"hole_mm": 2.2}, {}),
        ({"scatter": [-0.2]}, {"alpha": 0.4}, {}),
        ({"silicone": [0.3, 0.3]}, {"emitter_depth_mm": 1.2 / 1.41 + 0.1,
                                    "detector_depth_mm": 1.2 / 1.41 + 0.1}, {}),
    ],
)  # fmt: skip
def test_a_mistake_that_the_twin_knows_gives_the_twins_frame(
    layout: Layout,
    exact: Draws,
    lines: Lines,
    deviation: dict[str, list[float]],
    model: dict[str, float],
    place: dict[str, float],
) -> None:
    drawing = Model.from_layout(layout)
    found = shares(layout, drawing, changed(exact, **deviation), lines)
    twin = Twin(layout, drawing.changed(**model), misregistration=Misregistration(**place))
    away = 255.0 * (found - expected(twin, lines))
    assert np.sqrt(np.mean(away**2)) < 0.8
    if deviation and "silicone" not in deviation:
        off = 255.0 * (found - expected(Twin(layout, drawing), lines))
        assert np.sqrt(np.mean(off**2)) > 2.0 * np.sqrt(np.mean(away**2)), "the mistake shows"


def test_cells_with_holes_of_their_own_give_the_twins_frame(layout: Layout, exact: Draws) -> None:
    sizes = np.random.default_rng(3).uniform(0.7, 1.3, len(layout)).round(2)
    other = replace(layout, hole_share=sizes)
    model = Model.from_layout(other)
    found = shares(other, model, exact, EDGES)
    away = 255.0 * (found - expected(Twin(other, model), EDGES))
    alike = 255.0 * (found - expected(Twin(layout, model), EDGES))
    assert np.sqrt(np.mean(away**2)) < 1.2
    assert np.sqrt(np.mean(alike**2)) > 2.0 * np.sqrt(np.mean(away**2)), "the sizes show"


def test_a_whole_fingertip_beside_its_place_sees_the_line_on_the_other_side(
    layout: Layout, exact: Draws
) -> None:
    shift = np.array([0.4, -0.3])
    moved = changed(
        exact,
        finger_shift=shift,
        mask_shift=[0.0, 0.0, *shift],
        board=[0.0, 0.0, *shift],
    )
    normal = np.stack([-np.sin(ANGLES), np.cos(ANGLES)])
    model = Model.from_layout(layout)
    follows = Lines("edge", EDGES.poses + np.outer(shift @ normal, [0.0, 1.0]))
    found = shares(layout, model, moved, follows)
    assert np.allclose(found, shares(layout, model, exact, EDGES), atol=1e-4)


def factor(layout: Layout, model: Model) -> float:
    """How far the light of a cell moves in the middle of the gap per shift of the receiver's mask,
    if all of it passes straight from hole to hole: half way between the two holes, and towards the
    LEDs that the hole approaches. The holes are taken as points."""
    middle = int(np.argmin(np.hypot(layout.x_mm, layout.y_mm)))
    leds = np.stack([layout.x_mm - layout.x_mm[middle], layout.y_mm - layout.y_mm[middle]])
    power = (model.led_exponent + model.detector_exponent + 2.0) / 2.0

    def centre_mm(shift_mm: float) -> float:
        x, y = leds[0] - shift_mm, leds[1]
        light = (1.0 + (x * x + y * y) / model.gap_mm**2) ** -power
        return float(light @ (shift_mm + x / 2.0) / light.sum())

    return (centre_mm(0.01) - centre_mm(-0.01)) / 0.02


@pytest.mark.slow_cases
@pytest.mark.parametrize(("exponent", "least", "most"), [(1.0, 0.59, 0.63), (6.0, 0.5, 0.52)])
def test_the_receivers_mask_moves_estimates_by_a_factor_that_geometry_predicts(
    layout: Layout, exact: Draws, exponent: float, least: float, most: float
) -> None:
    model = Model.from_layout(layout, alpha=1.0, led_exponent=exponent)
    predicted = factor(layout, model)
    assert least < predicted < most
    tried = Bench(Case(layout, model, 24, 0))
    shift = np.array([0.1, 0.1])
    moved = changed(exact, mask_shift=[0.0, 0.0, *shift])
    for kind, lines in tried.lines.items():
        estimates = tried.estimates(lines)
        known = estimates.nothing_known(1)
        off, straight = (
            estimates.errors(tried.frames(one, {kind: lines})[kind].tared, lines, known)
            for one in (moved, exact)
        )
        along = shift @ np.stack([-np.sin(lines.poses[:, 0]), np.cos(lines.poses[:, 0])])
        across = np.abs(along) > 0.05
        by_mask = (off - straight)[0, across, 0] / along[across]
        assert np.median(by_mask) == pytest.approx(-predicted, abs=0.05), kind


def test_a_tare_takes_away_the_spread_of_the_detectors(tried: Bench, exact: Draws) -> None:
    uneven = changed(exact, detector=0.3 * np.sin(np.arange(32.0)))
    with_spread, without = (tried.frames(one, tried.lines)["edge"] for one in (uneven, exact))
    assert np.abs(with_spread.raw - without.raw).max() > 25.0
    assert np.abs(with_spread.tared - without.tared).max() <= 4.0, "but for saturation"


def test_a_tare_corrects_the_spread_of_the_leds_only_in_part(tried: Bench, exact: Draws) -> None:
    uneven = changed(exact, led=0.3 * np.sin(2.0 * np.arange(32.0)))
    with_spread, without = (tried.frames(one, tried.lines)["edge"] for one in (uneven, exact))
    left = np.abs(with_spread.tared - without.tared).max()
    assert 4.0 < left < np.abs(with_spread.raw - without.raw).max()
