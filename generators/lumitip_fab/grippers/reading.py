"""Solids from the files of other CAD programs: STEP, and FreeCAD where there is one shape."""

import io
import zipfile
import zlib
from pathlib import Path

from build123d import Compound, Shape
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Message import Message
from OCP.STEPControl import STEPControl_Reader
from OCP.TopoDS import TopoDS_Shape

from lumitip_fab.config.messages import shown_path
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.grippers.figures import TEXTS
from lumitip_fab.text import table_of

_BEGIN, _END = b"ISO-10303-21;", b"END-ISO-10303-21;"
_TOPOLOGY = b"CASCADE Topology V"
_FREECAD = ".fcstd"


def refusal(file: Path, fault: str, **values: object) -> InputError:
    """The error for a file, with the sentence of a fault in `texts.toml`."""
    text = table_of(TEXTS)["faults"][fault].format(**values)
    return InputError([Problem(shown_path(file), 0, "", text)])


def read_solid(file: Path) -> Shape:
    """The solids in a file, in mm.

    Args:
        file: STEP, or FreeCAD (`.FCStd`) with a single shape.

    Raises:
        InputError: if it cannot be read, or has no solid.
    """
    try:
        data = file.read_bytes()
    except OSError as error:
        problem = Problem(shown_path(file), 0, "", f"cannot be read: {error.strerror}")
        raise InputError([problem]) from error
    shape = _freecad(file, data) if file.suffix.lower() == _FREECAD else _step(file, data)
    solids = [] if shape is None or shape.IsNull() else Compound(shape).solids()
    if not solids:
        raise refusal(file, "step_solid")
    return Compound(solids)


def _step(file: Path, data: bytes) -> TopoDS_Shape | None:
    if not data.lstrip(b"\xef\xbb\xbf \r\n\t").startswith(_BEGIN):
        raise refusal(file, "step_empty")
    if _END not in data[-200:]:
        raise refusal(file, "step_end")
    printers = Message.DefaultMessenger_s().ChangePrinters()
    kept = list(printers)
    printers.Clear()  # the kernel prints its own messages, which name no remedy
    try:
        reader = STEPControl_Reader()
        if reader.ReadFile(str(file)) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise refusal(file, "step_broken")
        reader.TransferRoots()
        return reader.OneShape()
    finally:
        for printer in kept:
            printers.Append(printer)


def _freecad(file: Path, data: bytes) -> TopoDS_Shape:
    """A FreeCAD file holds the shape of every step of its history; only one is unambiguous."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
        shapes = [name for name in archive.namelist() if name.endswith((".brp", ".brep"))]
        if len(shapes) != 1:
            raise refusal(file, "freecad_shapes", count=len(shapes))
        written = archive.read(shapes[0])
    except (zipfile.BadZipFile, zlib.error, RuntimeError) as error:  # RuntimeError: encrypted
        raise refusal(file, "freecad_zip") from error
    if _TOPOLOGY not in written[:200]:
        raise refusal(file, "freecad_shape")
    shape = TopoDS_Shape()
    BRepTools.Read_s(shape, io.BytesIO(written), BRep_Builder())
    return shape
