"""The rules of copper that hold on a board."""

from dataclasses import replace

from lumitip_fab.design import Design, Rules

COMMON_MM = {"track_mm": 0.2, "copper_gap_mm": 0.2, "via_mm": 0.6, "via_drill_mm": 0.3}
"""Tracks, gaps and vias that common PCB fabs make without extra charge, and KiCad's stock rules
allow."""


def rules_of(design: Design, name: str) -> Rules:
    """Rules of a board, or of a panel of it: finer ones than common are for fingers alone, for
    other boards have room.

    Args:
        design: the sensor.
        name: of the board or the panel, as of its folder.
    """
    board = next((panel.board for panel in design.panels if panel.name == name), name)
    if any(finger.name == board for finger in design.fingers):
        return design.rules
    coarser = {of: max(getattr(design.rules, of), least) for of, least in COMMON_MM.items()}
    supply_mm = max(design.rules.supply_track_mm, coarser["track_mm"])
    return replace(design.rules, **coarser, supply_track_mm=supply_mm)
