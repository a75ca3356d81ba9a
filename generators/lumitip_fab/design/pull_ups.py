"""Arrays of pull-ups beside a multiplexer, and the input that each of their resistors serves.

    RN2 | mux | RN1     towards the cells: inputs of the upper row of leads
    RN4 |     | RN3     towards the connector: inputs of the lower row

A package with few inputs has the right column alone. Tracks from the leads turn under the package
to the arrays, each inside the one before it, so that none crosses another.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from lumitip_fab.catalogue.electronics import Multiplexer, ResistorArray
from lumitip_fab.design import footprints
from lumitip_fab.design.boards import CellInput

MOST_COLUMNS = 2


@dataclass(frozen=True)
class ArraySlot:
    """Place of an array, and what hangs on it."""

    side: int
    """1 to the right of the multiplexer, -1 to the left."""
    end: int
    """1 towards the cells, -1 towards the connector."""
    leads: tuple[int, ...]
    """Lead of the multiplexer at each resistor, from the cells to the connector."""


def columns_of_arrays(mux: Multiplexer, array: ResistorArray) -> int:
    """Columns of two arrays that the inputs of a multiplexer need."""
    in_column = 2 * array.resistors
    return -(-mux.channels // in_column)


def array_slots(mux: Multiplexer, array: ResistorArray) -> tuple[ArraySlot, ...]:
    """The arrays of a multiplexer, those to the right first.

    Raises:
        ValueError: with more inputs than two columns serve.
    """
    columns = columns_of_arrays(mux, array)
    if columns > MOST_COLUMNS:
        raise ValueError(f"{mux.channels} inputs need {columns} columns of arrays")
    at = {int(pad.number): pad for pad in footprints.multiplexer(mux).pads}
    upper, lower = (
        sorted((n for n in mux.input_leads if sign * at[n].y_mm > 0), key=lambda n: at[n].x_mm)
        for sign in (1, -1)
    )
    slots = []
    for side in (1, -1)[:columns]:
        # From the cells to the connector: the nearest leads of a row are at the column's ends.
        rows = [_share(row, side, columns) for row in (upper, lower)]
        nested = (*rows[0][::-side], *rows[1][::side])
        for end, leads in ((1, nested[: array.resistors]), (-1, nested[array.resistors :])):
            if leads:
                slots.append(ArraySlot(side, end, leads))
    return tuple(slots)


def used_slots(
    cells: Sequence[CellInput], mux: Multiplexer, array: ResistorArray
) -> tuple[tuple[int, ArraySlot], ...]:
    """Multiplexer and slot of each array: those at which a photodetector is."""
    read = {(cell.mux, mux.inputs[str(cell.channel)]) for cell in cells}
    slots = array_slots(mux, array)
    return tuple(
        (which, slot)
        for which in sorted({cell.mux for cell in cells})
        for slot in slots
        if any((which, lead) in read for lead in slot.leads)
    )


def _share(leads: list[int], side: int, columns: int) -> list[int]:
    """Leads of a row that a column serves: all, or those of its half."""
    if columns == 1:
        return leads
    middle = len(leads) // 2
    return leads[middle:] if side > 0 else leads[:middle]
