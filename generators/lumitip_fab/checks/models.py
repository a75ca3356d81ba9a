"""The parts' 3D models: each part of a board has one, of its own size, the right way round."""

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

import numpy as np

from lumitip_fab.checks.board_read import names_of, path_of, read_any
from lumitip_fab.checks.readers.kicad_board import Model
from lumitip_fab.checks.readers.vertices import step_mm, vrml_mm
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Box, Design, Footprint, footprints
from lumitip_fab.errors import OutputError

READS = ("boards/*/*.kicad_pcb", "boards/models/*")
SIZE_MM = 0.01
_PROJECT = "${KIPRJMOD}/"
_HALF_PIN_MM = 0.32
_STRAIGHT, _WHOLE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Models that are missing or turned, board by board; then the size of each model, once."""
    known = {shape.name: shape for _, shape in footprints.of_design(design)}
    sizes: dict[Path, Footprint] = {}
    for name in names_of(design):
        try:
            read = read_any(outputs, design, name)
        except (OutputError, LookupError) as error:
            yield unreadable("models.files", path_of(name), str(error))
            continue
        lost, turned = [], []
        for part in read.board.parts:
            if not part.terminals or not part.bought:
                continue
            shape = known.get(part.footprint)
            path = _path(outputs, name, part.models)
            if path is None or shape is None or not path.is_file():
                lost.append(part.ref)
                continue
            if not _straight(part.models[0]):
                turned.append(part.ref)
            sizes[path] = shape
        for check, wrong in (("files", lost), ("places", turned)):
            yield count(f"models.{check}", read.subject, wrong, "parts")
    for path, shape in sorted(sizes.items()):
        subject = path.relative_to(outputs.resolve())
        yield _size("size", path, subject, shape)
        drawn, same = path.with_suffix(".wrl"), subject.with_suffix(".wrl")
        yield _size("vrml", drawn, same, shape)


def _path(outputs: Path, board: str, models: tuple[Model, ...]) -> Path | None:
    """The file of a part's only model, if it is in the output folder."""
    if len(models) != 1 or not models[0].path.startswith(_PROJECT):
        return None
    relative = PurePosixPath(models[0].path.removeprefix(_PROJECT))
    path = (outputs / "boards" / board / relative).resolve()
    return path if path.is_relative_to(outputs.resolve()) else None


def _straight(model: Model) -> bool:
    """Whether a model lies in its footprint's frame."""
    return model.offset_mm == model.rotate_deg == _STRAIGHT and model.scale == _WHOLE


def _size(check: str, path: Path, subject: Path, shape: Footprint) -> Measurement:
    """How far the sides and the top of a model are from the body's."""
    try:
        corners = vrml_mm(path) if check == "vrml" else step_mm(path)
    except OutputError as error:
        return unreadable(f"models.{check}", subject.as_posix(), str(error))
    box = _seen(shape)
    wanted = np.array([*box.bounds_mm, shape.height_mm])
    low, high = corners.min(axis=0), corners.max(axis=0)
    off = np.abs(np.array([*low[:2], *high]) - wanted)
    note = f"from {box.width_mm:g} x {box.length_mm:g} x {shape.height_mm:g} mm"
    return Measurement(
        f"models.{check}", subject.as_posix(), float(off.max()), 0, SIZE_MM, "mm", note
    )


def _seen(shape: Footprint) -> Box:
    """A package from above: body and leads, or the shroud and the pins behind it."""
    body, tips = shape.body, shape.lead_tips_mm / 2
    if shape.shroud is None:
        return Box(
            body.x_min_mm, body.x_max_mm, min(body.y_min_mm, -tips), max(body.y_max_mm, tips)
        )
    box = shape.shroud.box
    pins = min(pad.y_mm for pad in shape.pads) - _HALF_PIN_MM
    return Box(box.x_min_mm, box.x_max_mm, pins, box.y_max_mm)
