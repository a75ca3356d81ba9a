"""Sizes of drawing paper."""

MARGIN_MM = 20.32
_TITLE_MM = 35.0  # of the title block, at the bottom right
_PAPERS = {
    "A4": (297, 210),
    "A3": (420, 297),
    "A2": (594, 420),
    "A1": (841, 594),
    "A0": (1189, 841),
}


def paper_for(width_mm: float, height_mm: float) -> tuple[str, int]:
    """The smallest paper for a drawing, and its place among them; A0 for what is larger."""
    for place, (name, (wide, high)) in enumerate(_PAPERS.items()):
        if width_mm + 2 * MARGIN_MM <= wide and height_mm + MARGIN_MM + _TITLE_MM <= high:
            return name, place
    return "A0", len(_PAPERS)
