"""Corners of a binary STL file, read without a mesh library, whose import takes half a second."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.errors import OutputError

_HEADER = 84  # 80 bytes of text, and how many triangles follow
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def corners_mm(path: Path) -> NDArray[np.float64]:
    """Corners of all triangles, shape (3 · triangles, 3), in the file's frame.

    Raises:
        OutputError: if the file is missing, is no binary STL, or holds no or no finite corner.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise OutputError(f"cannot be read: {error.strerror}") from error
    count = int.from_bytes(data[_HEADER - 4 : _HEADER], "little")
    if not count or len(data) != _HEADER + count * _TRIANGLE.itemsize:
        raise OutputError(f"is no binary STL: {len(data)} bytes for {count} triangles")
    corners = np.frombuffer(data, _TRIANGLE, offset=_HEADER)["corners"].reshape(-1, 3)
    if not np.isfinite(corners).all():
        raise OutputError("has corners that are not finite")
    return corners.astype(float)
