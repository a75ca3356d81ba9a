"""Tables of comma-separated values, and zips, as whoever orders by them reads them."""

import csv
import io
import zipfile
import zlib
from pathlib import Path


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


def unpacked(path: Path) -> dict[str, bytes]:
    """Every file in a zip, by name.

    Raises:
        OSError: if there is none.
        ValueError: if it is damaged, holds a name twice, or is packed in a way that PCB fabs and
            slicers do not unpack.
    """
    try:
        with zipfile.ZipFile(path) as package:
            names = package.namelist()
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:  # which of the two a PCB fab takes is not known
                raise ValueError(f"packed more than once: {', '.join(twice)}")
            return {name: package.read(name) for name in names}
    # A spoilt header may ask for a password or for a method that is not known.
    except (zipfile.BadZipFile, zlib.error, RuntimeError, EOFError) as error:
        raise ValueError(f"no zip that can be unpacked: {error}") from error
