"""What is in a zip."""

import zipfile
import zlib
from pathlib import Path


def unpacked(path: Path) -> dict[str, bytes]:
    """Every file in a zip, by name.

    Raises:
        OSError: if there is none.
        ValueError: if it is spoilt, holds a name twice, or is packed as no board house or slicer
            unpacks it.
    """
    try:
        with zipfile.ZipFile(path) as package:
            names = package.namelist()
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:  # which of the two a board house takes is not known
                raise ValueError(f"packed more than once: {', '.join(twice)}")
            return {name: package.read(name) for name in names}
    # A spoilt header may ask for a password or for a method that is not known.
    except (zipfile.BadZipFile, zlib.error, RuntimeError, EOFError) as error:
        raise ValueError(f"no zip that can be unpacked: {error}") from error
