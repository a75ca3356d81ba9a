"""Tables of comma-separated values as whoever orders by them reads them."""

import csv
import io


def table(text: str) -> list[dict[str, str]]:
    """The rows below the heading, by column.

    Raises:
        ValueError: if it is no such table, or a row is cut short.
    """
    try:
        rows = list(csv.DictReader(io.StringIO(text, newline="")))
    except csv.Error as error:
        raise ValueError(f"no table: {error}") from error
    for number, row in enumerate(rows, start=1):
        if None in row or None in row.values():
            raise ValueError(f"row {number} has not as many fields as the heading")
    return rows
