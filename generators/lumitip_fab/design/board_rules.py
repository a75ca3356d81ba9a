"""The rules of copper that hold on a board."""

from dataclasses import replace

from lumitip_fab.design import Design, Rules

COMMON_MM = {"track_mm": 0.2, "copper_gap_mm": 0.2, "via_mm": 0.6, "via_drill_mm": 0.3}
"""Tracks, gaps and vias that common PCB fabs make without extra charge, and KiCad's stock rules
allow."""
COMMON_EDGE_MM = 0.5
"""From copper to an edge, likewise."""


def rules_of(design: Design, name: str) -> Rules:
    """Rules of a board, or of a panel of it: finer ones than common are for the receiver alone, for
    other boards have room. Where its tracks are finer, so is its gap at the edge.

    Args:
        design: the sensor.
        name: of the board or the panel, as of its folder.
    """
    board = next((panel.board for panel in design.panels if panel.name == name), name)
    if board == "receiver":
        return design.rules
    coarser = {of: max(getattr(design.rules, of), least) for of, least in COMMON_MM.items()}
    if design.rules.track_mm < COMMON_MM["track_mm"]:
        coarser["edge_gap_mm"] = max(design.rules.edge_gap_mm, COMMON_EDGE_MM)
    supply_mm = common_supply_mm(max(design.rules.supply_track_mm, coarser["track_mm"]))
    return replace(design.rules, **coarser, supply_track_mm=supply_mm)


def common_supply_mm(written_mm: float) -> float:
    """Width of a supply's tracks on a board that keeps to what is common."""
    return max(written_mm, COMMON_MM["track_mm"])
