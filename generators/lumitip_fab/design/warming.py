"""How far a current warms a track on the outside of a board, by the formula of IPC-2221."""

MOST_K = 20.0
"""Of a supply's track, at most, with the greatest current."""
_FACTOR, _OF_RISE, _OF_SECTION = 0.048, 0.44, 0.725
"""IPC-2221, outer layers: current in A from the rise in K and the section in square mils."""
_MIL_MM = 0.0254


def bearable_a(width_mm: float, copper_um: float, rise_k: float = MOST_K) -> float:
    """The current that warms a track by so much."""
    section_mil2 = width_mm * copper_um / 1000 / _MIL_MM**2
    return float(_FACTOR * rise_k**_OF_RISE * section_mil2**_OF_SECTION)


def warming_k(current_a: float, width_mm: float, copper_um: float) -> float:
    """By how much a current warms a track."""
    return float((current_a / bearable_a(width_mm, copper_um, 1.0)) ** (1 / _OF_RISE))
