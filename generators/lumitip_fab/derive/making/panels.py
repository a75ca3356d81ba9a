"""Panels of the boards that are too small for PCB fabs to assemble alone."""

import math
from dataclasses import dataclass

from lumitip_fab.catalogue.ordering import PanelLimits
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.design import AuxiliaryBoard, Box, Panel, PanelRules, Point

_RAIL_STEP_MM = 0.5
_GAP_STEP_MM = 0.1
_NOISE_MM = 1e-9


@dataclass(frozen=True)
class _Blank:
    """A board as a panel sees it: its outline, and what reaches beyond each side of it."""

    name: str
    box: Box
    over: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """Beyond the left, right, lower and upper edge."""


def derive_panels(
    config: Input, finger: Box, auxiliary: tuple[AuxiliaryBoard, ...], faults: Diagnostics
) -> tuple[Panel, ...]:
    """A panel of each board that is smaller than the smallest that every PCB fab assembles; none
    where `board.panel` does not ask for them. Fabs make panels of flexible boards themselves.

    Args:
        config: the parameters.
        finger: outline of the fingers' boards.
        auxiliary: the boards outside the fingers.
        faults: collects panels that no fab makes.
    """
    limits = [fab.panel for fab in config.catalogue.fabs.values() if fab.panel]
    if config.parameters.board.panel == "none" or not limits:
        return ()
    rules = _strictest(limits)
    fingers = () if is_flex(config.parameters) else ("emitter", "receiver")
    blanks = [*(_Blank(name, finger) for name in fingers), *map(_blank, auxiliary)]
    small = [blank for blank in blanks if not _fits(blank.box, rules.least_mm, math.inf)]
    edge_mm, least = config.parameters.board.edge_gap_mm, rules.bite_inset_mm + rules.copper_mm
    faults.unless(not small or edge_mm >= least - _NOISE_MM, "panel_edge", least=least, rules=rules)
    panels = tuple(_panel(blank, rules, config.parameters.board.edge_gap_mm) for blank in small)
    for panel in panels:
        faults.unless(
            _fits(panel.box, (0.0, 0.0), rules.most_mm),
            "panel_large",
            panel=panel,
            most=rules.most_mm[0],
            most_y=rules.most_mm[1],
        )
    return panels


def _strictest(limits: list[PanelLimits]) -> PanelRules:
    """Figures that suit every PCB fab."""
    return PanelRules(
        least_mm=(max(fab.least_mm[0] for fab in limits), max(fab.least_mm[1] for fab in limits)),
        most_mm=(min(fab.most_mm[0] for fab in limits), min(fab.most_mm[1] for fab in limits)),
        bites=max(fab.bites for fab in limits),
        fiducial_mm=max(max(fab.fiducial_mm, fab.fiducial_opening_mm / 2) for fab in limits),
        **{
            name: max(getattr(fab, name) for fab in limits)
            for name in (
                "rail_mm",
                "fiducial_opening_mm",
                "fiducial_edge_mm",
                "tooling_mm",
                "gap_mm",
                "bite_mm",
                "bite_web_mm",
                "copper_mm",
                "part_mm",
                "pad_mm",
            )
        },
        tab_every_mm=min(fab.tab_every_mm for fab in limits),
    )


def _fits(box: Box, least: Point, most: Point | float) -> bool:
    highest = (most, most) if isinstance(most, float) else most
    sides = box.width_mm, box.length_mm
    return all(
        low - _NOISE_MM <= side <= high + _NOISE_MM
        for low, side, high in zip(least, sides, highest, strict=True)
    )


def _blank(board: AuxiliaryBoard) -> _Blank:
    box, bodies = board.box, [part.body_on_board for part in board.components]
    over = (
        max(box.x_min_mm - body.x_min_mm for body in bodies),
        max(body.x_max_mm - box.x_max_mm for body in bodies),
        max(box.y_min_mm - body.y_min_mm for body in bodies),
        max(body.y_max_mm - box.y_max_mm for body in bodies),
    )
    left, right, low, high = (max(0.0, by) for by in over)
    return _Blank(board.name, box, (left, right, low, high))


def _panel(blank: _Blank, rules: PanelRules, edge_mm: float) -> Panel:
    """As few copies as make the panel large enough for every PCB fab."""
    marks = rules.fiducial_edge_mm + rules.fiducial_opening_mm + edge_mm
    rail = max(rules.rail_mm, _up(marks, _RAIL_STEP_MM))
    left, right, low, high = blank.over
    box, gap = blank.box, rules.gap_mm
    columns, width, at_x, pitch_x = _row(box.width_mm, (left, right), gap, rail, rules.least_mm[0])
    rows, length, at_y, pitch_y = _row(box.length_mm, (low, high), gap, rail, rules.least_mm[1])
    outline = Box(-width / 2, width / 2, -length / 2, length / 2)
    return Panel(
        board=blank.name,
        columns=columns,
        rows=rows,
        box=outline,
        inside=outline.grown(-rail),
        first=(
            outline.x_min_mm + at_x - box.x_min_mm,
            outline.y_min_mm + at_y - box.y_min_mm,
        ),
        pitch=(pitch_x, pitch_y),
        rail_mm=rail,
        tabs=max(2, math.ceil(box.length_mm / rules.tab_every_mm)),
        rules=rules,
    )


def _row(
    side_mm: float, over: tuple[float, float], gap_mm: float, rail_mm: float, least_mm: float
) -> tuple[int, float, float, float]:
    """Copies along a side: their number, the panel's side, the first copy's edge from that of the
    panel, and copy to copy. Beside what reaches over an edge a whole gap is free."""
    before, after = (_up(gap_mm + by, _GAP_STEP_MM) for by in over)
    between = _up(gap_mm + sum(over), _GAP_STEP_MM)
    frame = 2 * rail_mm + before + after
    room = least_mm - frame + between
    count = max(1, math.ceil(room / (side_mm + between) - _NOISE_MM))
    return (
        count,
        frame + count * (side_mm + between) - between,
        rail_mm + before,
        side_mm + between,
    )


def _up(value_mm: float, step_mm: float) -> float:
    """Rounded up to a step."""
    return round(math.ceil(value_mm / step_mm - _NOISE_MM) * step_mm, 6)
