"""What is in a zip."""

import zipfile
import zlib
from pathlib import Path


def unpacked(path: Path) -> dict[str, bytes]:
    """Every file in a zip, by name.

    Raises:
        OSError: if there is none.
        ValueError: if it is spoilt, or packed as no board house or slicer unpacks it.
    """
    try:
        with zipfile.ZipFile(path) as package:
            return {name: package.read(name) for name in package.namelist()}
    # A spoilt header may ask for a password or for a method that is not known.
    except (zipfile.BadZipFile, zlib.error, RuntimeError, EOFError) as error:
        raise ValueError(f"no zip that can be unpacked: {error}") from error
