"""Corners of binary STL files, and the files that are none."""

import struct
from pathlib import Path

import pytest

from lumitip_fab.checks.readers.vertices import corners_mm
from lumitip_fab.errors import OutputError


def binary(*corners: float, count: int = 1) -> bytes:
    """One triangle from nine coordinates, in a file that tells of `count`."""
    return bytes(80) + struct.pack("<I12fH", count, 0, 0, 1, *corners, 0)


def test_corners(tmp_path: Path) -> None:
    (tmp_path / "part.stl").write_bytes(binary(0, 0, 0, 1, 0, 0, 0, 2, -3))
    assert corners_mm(tmp_path / "part.stl").tolist() == [[0, 0, 0], [1, 0, 0], [0, 2, -3]]


@pytest.mark.parametrize(
    ("told", "why"),
    [
        (b"", "no binary STL: 0 bytes for 0 triangles"),
        (b"solid part\nendsolid part\n", "no binary STL"),
        (binary(*range(9), count=2), "no binary STL: 134 bytes for 2 triangles"),
        (binary(*range(9))[:-1], "no binary STL"),
        (binary(float("nan"), *range(8)), "not finite"),
    ],
)
def test_no_mesh(tmp_path: Path, told: bytes, why: str) -> None:
    (tmp_path / "part.stl").write_bytes(told)
    with pytest.raises(OutputError, match=why):
        corners_mm(tmp_path / "part.stl")


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="No such file"):
        corners_mm(tmp_path / "part.stl")
