"""Orientation of LEDs and photodetectors at their cells: along x, or turned along y."""

from lumitip.grid import column_pitch_mm
from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.faults import Faults

TRACK_SPACE_MM = 1.5  # between columns, for tracks; with less, parts are turned along y


def derive_turned(p: Parameters, field: str, name: str, chip: Chip, faults: Faults) -> bool:
    """Whether parts are turned along y; refused where they fit neither way.

    Land patterns keep a straight lane between columns and between rows, so that tracks pass.
    """
    along, across = chip.over_pads_mm
    pitch, columns = p.grid.pitch_mm, column_pitch_mm(p.grid.pitch_mm)
    gap = p.board.clearance_mm
    flat = columns >= along + gap and pitch >= across + gap
    turned = columns >= across + gap and pitch >= along + gap
    if not (flat or turned):
        least = max(along + gap, (across + gap) * pitch / columns)
        faults.refuse(
            field,
            f"is {name!r}, {along:g} mm over its pads and {across:g} mm wide; with "
            f"{gap:g} mm of clearance it needs a pitch of at least {least:.2f} mm, but "
            f"grid.pitch_mm is {pitch:g}",
        )
    roomy = columns >= along + TRACK_SPACE_MM
    return turned and not (flat and roomy)
