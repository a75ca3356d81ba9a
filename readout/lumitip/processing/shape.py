"""The rule by which a contact is called edge, corner or cable; `pitch` is the grid's.

1. No contrast: `"covered"` when the middle value is below the level for a covered finger, else
   `"none"`.
2. `"edge"`: one line leaves no more than 0.2 pitch rms; or it leaves more than a fifth of the sum
   of squares about the mean, and no dark cell, or no light one, is at the rim of the grid: the
   border is round and closed. Neither corner nor cable applies then.
3. `"cable"`: there is light on both sides of the dark, and two parallel borders leave no more than
   0.5 pitch rms, and no more than two rays do, unless these open less than 25°.
4. `"corner"`: two rays leave no more than 0.5 pitch rms, open 15° to 165°, and meet over the cells
   or within half a pitch of them.
5. `"edge"`: every other contact.

The limits come from 600 random poses of each shape on two grids, with light edges 1.3 to 4.5 mm
wide and two counts of noise. One straight border leaves up to 0.20 pitch, as markers lie on the
segments between cells: the bias of the method. The right fit leaves up to 0.39 of a cable and 0.18
of a corner; markers of cells that are dark by chance leave 0.54 and more.
"""

from lumitip.processing.contact import Cable, Corner, Line
from lumitip.processing.fits import Border, fit_rays

Rectangle = tuple[float, float, float, float]

_LINE_RMS = 0.2
_OTHER_RMS = 0.5
_ROUND = 0.2
_OPENING_DEG = (15.0, 165.0)
_PARALLEL_DEG = 25.0
_TIE = 1e-9  # relative, and mm: two exact fits differ by less, by chance


def fit_others(
    border: Border, line: Line | None, closed: bool, pitch_mm: float, reach_mm: Rectangle
) -> tuple[Corner | None, Cable | None]:
    """Corner and cable where they describe the markers, each `None` where it does not.

    Args:
        border: the markers.
        line: through all of them, or `None`.
        closed: whether all dark cells, or all light ones, lie within the grid.
        pitch_mm: of the grid.
        reach_mm: rectangle of the cells, `(left, bottom, right, top)`.
    """
    if line is not None and line.rms_mm <= _LINE_RMS * pitch_mm:
        return None, None
    if closed and (line is None or _is_round(border, line)):
        return None, None
    corner, cable = fit_rays(border)
    if cable is not None and cable.rms_mm > _OTHER_RMS * pitch_mm:
        cable = None
    if corner is not None and not _is_corner(corner, pitch_mm, reach_mm):
        corner = None
    return corner, cable


def shape_of(corner: Corner | None, cable: Cable | None) -> str:
    """`"edge"`, `"corner"` or `"cable"`, from the fits that apply."""
    if cable is not None and (
        corner is None
        or cable.rms_mm <= corner.rms_mm * (1 + _TIE) + _TIE
        or corner.opening_deg < _PARALLEL_DEG
    ):
        return "cable"
    return "edge" if corner is None else "corner"


def _is_round(border: Border, line: Line) -> bool:
    return line.rms_mm**2 * border.markers.size > _ROUND * border.size


def _is_corner(corner: Corner, pitch_mm: float, reach_mm: Rectangle) -> bool:
    (x_mm, y_mm), (left, bottom, right, top) = corner.vertex_mm, reach_mm
    margin = pitch_mm / 2.0
    return (
        left - margin < x_mm < right + margin
        and bottom - margin < y_mm < top + margin
        and _OPENING_DEG[0] < corner.opening_deg < _OPENING_DEG[1]
        and corner.rms_mm <= _OTHER_RMS * pitch_mm
    )
