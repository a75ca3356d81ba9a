"""Messages with Foxglove's own schemas, which its 3D panel draws: light as a grid, cells and lines
as a scene, and the place of each fingertip.

Lengths are in metres, in the sensor frame of the receiver: x to the right, y towards the tip.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.Vector2_pb2 import Vector2
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

from lumitip.foxglove.panels import ROOT
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.view.drawn import MISSING

METRE = 1e-3
"""A millimetre in metres."""
STEPS = 6
"""Squares of the grid in a pitch."""
_REACH = 0.58  # of a pitch: how far from the middle of a cell the grid is coloured
_LEVEL_MM = 0.2  # of lines over cells, and of cells over the grid
_SIZE = 0.8  # of a cell, in pitches
_LINE_MM = 0.3
_SPARE_MM = 20.0  # between fingertips


def stamp(at_ns: int) -> Timestamp:
    """A time (ns since 1970)."""
    return Timestamp(seconds=at_ns // 1_000_000_000, nanos=at_ns % 1_000_000_000)


class Raster:
    """The cells of a layout as squares of a grid: each square has the light of the nearest cell."""

    def __init__(self, layout: Layout) -> None:
        step_mm = layout.pitch_mm / STEPS
        x_mm, y_mm = (
            np.arange(low - layout.pitch_mm, high + layout.pitch_mm, step_mm)
            for low, high in (
                (layout.x_mm.min(), layout.x_mm.max()),
                (layout.y_mm.min(), layout.y_mm.max()),
            )
        )
        across, along = np.meshgrid(x_mm + step_mm / 2, y_mm + step_mm / 2)
        apart_mm = np.hypot(across[..., None] - layout.x_mm, along[..., None] - layout.y_mm)
        self.cell = apart_mm.argmin(axis=-1)
        """Index of the cell of each square, shape `(rows, columns)`."""
        self.shown = apart_mm.min(axis=-1) <= _REACH * layout.pitch_mm
        """Whether the square is coloured."""
        self.corner_mm = float(x_mm[0]), float(y_mm[0])
        self.step_mm = step_mm

    def grid(self, values: Values, frame_id: str, at_ns: int) -> Grid:
        """The light of a frame, grey, with the value of each square as `light`; squares of a cell
        without a value are red."""
        light = values.astype(np.float32)[self.cell]
        missing = ~np.isfinite(light)
        grey = np.nan_to_num(light).clip(0, 255).astype(np.uint8)
        squares = np.zeros(self.cell.shape, _SQUARE)
        for colour, value in zip(("red", "green", "blue"), MISSING, strict=True):
            squares[colour] = np.where(missing, value, grey)
        squares["alpha"] = np.where(self.shown, 255, 0)
        squares["light"] = light
        return Grid(
            timestamp=stamp(at_ns),
            frame_id=frame_id,
            pose=_pose(*self.corner_mm, 0.0),
            column_count=self.cell.shape[1],
            cell_size=Vector2(x=self.step_mm * METRE, y=self.step_mm * METRE),
            row_stride=self.cell.shape[1] * _SQUARE.itemsize,
            cell_stride=_SQUARE.itemsize,
            fields=[
                PackedElementField(name=name, offset=offset, type=kind)
                for name, (offset, kind) in _FIELDS.items()
            ],
            data=squares.tobytes(),
        )


_BYTE, _FLOAT = PackedElementField.UINT8, PackedElementField.FLOAT32
_FIELDS = {
    "red": (0, _BYTE),
    "green": (1, _BYTE),
    "blue": (2, _BYTE),
    "alpha": (3, _BYTE),
    "light": (4, _FLOAT),
}
"""Offset in a square of the grid, and type of each of its values."""
_SIZES = {_BYTE: "u1", _FLOAT: "<f4"}
_SQUARE = np.dtype([(name, _SIZES[kind]) for name, (_, kind) in _FIELDS.items()])


def cells(layout: Layout, values: Values, frame_id: str, at_ns: int) -> SceneUpdate:
    """A disc for each cell, as light as it reads; a cell without a value is red."""
    size = Vector3(
        x=_SIZE * layout.pitch_mm * METRE, y=_SIZE * layout.pitch_mm * METRE, z=_LEVEL_MM * METRE
    )
    discs = [
        CylinderPrimitive(
            pose=_pose(x, y, _LEVEL_MM), size=size, bottom_scale=1.0, top_scale=1.0, color=_grey(v)
        )
        for x, y, v in zip(layout.x_mm.tolist(), layout.y_mm.tolist(), values.tolist(), strict=True)
    ]
    entity = SceneEntity(
        timestamp=stamp(at_ns), frame_id=frame_id, id="cells", frame_locked=True, cylinders=discs
    )
    return SceneUpdate(entities=[entity])


def lines(
    layout: Layout,
    drawn: Sequence[Floats],
    colour: Sequence[float],
    name: str,
    frame_id: str,
    at_ns: int,
) -> SceneUpdate:
    """Straight lines as far as they are on the face; none clear those of the frame before.

    Args:
        layout: the cells.
        drawn: both ends of each line, shape `(2, 2)` (mm).
        colour: red, green and blue, 0 to 255.
        name: of the entity.
        frame_id: of the sensor frame.
        at_ns: time of the frame.
    """
    strips = [
        LinePrimitive(
            type=LinePrimitive.LINE_STRIP,
            pose=_pose(0.0, 0.0, 2 * _LEVEL_MM),
            thickness=_LINE_MM * METRE,
            scale_invariant=False,
            points=[Point3(x=x * METRE, y=y * METRE, z=0.0) for x, y in ends],
            color=_colour(colour),
        )
        for line in drawn
        if (ends := _on_face(np.asarray(line), layout))
    ]
    entity = SceneEntity(
        timestamp=stamp(at_ns), frame_id=frame_id, id=name, frame_locked=True, lines=strips
    )
    return SceneUpdate(entities=[entity])


def _on_face(line: Floats, layout: Layout) -> list[list[float]]:
    """Both ends of the part of a line that is within a pitch of the cells (mm), if any."""
    places = np.column_stack([layout.x_mm, layout.y_mm])
    low, high = places.min(axis=0) - layout.pitch_mm, places.max(axis=0) + layout.pitch_mm
    start, way = line[0], line[1] - line[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = np.sort(np.stack([(low - start) / way, (high - start) / way]), axis=0)
    along = way != 0.0
    if not ((low <= start) & (start <= high))[~along].all():
        return []
    first, last = max(0.0, *crossed[0][along]), min(1.0, *crossed[1][along])
    ends: list[list[float]] = [(start + t * way).tolist() for t in (first, last)]
    return ends if first < last else []


def places(layouts: Sequence[tuple[str, Layout]], at_ns: int) -> FrameTransforms:
    """The fingertips beside each other, in their order, around the middle of `ROOT`."""
    wide_mm = [float(np.ptp(layout.x_mm)) + layout.pitch_mm for _, layout in layouts]
    total_mm = sum(wide_mm) + _SPARE_MM * (len(layouts) - 1)
    middles = _middles(wide_mm, -total_mm / 2)
    return FrameTransforms(
        transforms=[
            FrameTransform(
                timestamp=stamp(at_ns),
                parent_frame_id=ROOT,
                child_frame_id=name,
                translation=Vector3(x=x_mm * METRE, y=0.0, z=0.0),
                rotation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0),
            )
            for (name, _), x_mm in zip(layouts, middles, strict=True)
        ]
    )


def _middles(wide_mm: Sequence[float], from_mm: float) -> Iterator[float]:
    for wide in wide_mm:
        yield from_mm + wide / 2
        from_mm += wide + _SPARE_MM


def _pose(x_mm: float, y_mm: float, z_mm: float) -> Pose:
    return Pose(
        position=Vector3(x=x_mm * METRE, y=y_mm * METRE, z=z_mm * METRE),
        orientation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0),
    )


def _grey(value: float) -> Color:
    if not math.isfinite(value):
        return _colour(MISSING)
    return _colour([min(max(value, 0.0), 255.0)] * 3)


def _colour(values: Sequence[float]) -> Color:
    red, green, blue = (value / 255.0 for value in values)
    return Color(r=red, g=green, b=blue, a=1.0)
