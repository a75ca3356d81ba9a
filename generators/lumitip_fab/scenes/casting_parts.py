"""Screws, nuts and wires round a finger in its mould, in the frame of the mould's bed."""

from collections.abc import Iterator, Sequence

import numpy as np

from lumitip_fab.design import Clamp, Design, Fastener, Finger, Point, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.casting_page import Wire
from lumitip_fab.scenes.system import disc, prism, ring

_CORNERS = 6  # of a nut
_OVER_MM = 0.6  # of a wire over what it lies on
_PAST_MM = 16.0  # of the wires, beyond the mould


def screws_of(clamps: tuple[Clamp, ...]) -> tuple[Mesh, ...]:
    """The screws in the rails, each with the nut that fixes it."""
    return tuple(mesh for clamp in clamps for at in clamp.screws for mesh in _fixed(clamp, at))


def _fixed(clamp: Clamp, at: Point) -> Iterator[Mesh]:
    """From the rail up, the nut last: it is nearer to the viewer than the screw in it."""
    yield _placed(disc(clamp.screw.thread_mm, clamp.rail_mm, clamp.screw_length_mm), at)
    yield nut(clamp.screw, at, clamp.rail_mm)


def nuts_of(clamps: tuple[Clamp, ...]) -> tuple[Mesh, ...]:
    """The nuts that press the clamp down, and the ends of the screws over them."""
    return tuple(mesh for clamp in clamps for at in clamp.screws for mesh in _pressing(clamp, at))


def _pressing(clamp: Clamp, at: Point) -> Iterator[Mesh]:
    over_mm = clamp.top_mm + clamp.screw.nut_height_mm
    yield nut(clamp.screw, at, clamp.top_mm)
    if clamp.screw_length_mm > over_mm:
        yield _placed(disc(clamp.screw.thread_mm, over_mm, clamp.screw_length_mm), at)


def nut(fastener: Fastener, at: Point, low_mm: float) -> Mesh:
    """A nut round a place of the sensor frame, on a height of the bed."""
    radius = fastener.nut_mm / np.sqrt(3.0)
    return _placed(prism(ring(radius, _CORNERS), low_mm, low_mm + fastener.nut_height_mm), at)


def _placed(mesh: Mesh, at: Point) -> Mesh:
    """The sensor frame's y is -y of the bed."""
    return mesh.moved(frames.translation(at[0], -at[1], 0.0))


def wires_of(
    finger: Finger, colours: Sequence[str], to_bed: frames.Matrix, mould: Mesh, design: Design
) -> tuple[Wire, ...]:
    """From the pads through the notch, over the weir and down to the table."""
    stack, end_y = design.stack, -design.outline.end_y_mm
    rim = design.mould.stops_mm(stack.cover_mm) + _OVER_MM
    low, high = float(mould.points_mm[:, 1].min()), float(mould.points_mm[:, 1].max())
    table = _OVER_MM - (high + _PAST_MM - low) * design.mould.level_slope
    notch_y = (finger.notch.y_min_mm + finger.notch.y_max_mm) / 2
    found = []
    for colour, (x, y) in zip(colours, finger.connector.pads, strict=True):
        held = np.array([(x, y, stack.pocket_z_mm), (x, notch_y, stack.pocket_z_mm - _OVER_MM)])
        lying = np.array(
            [
                (x, end_y + 1.0, rim),
                (x, high, rim),
                (x, high + _PAST_MM / 2, (rim + table) / 2),
                (x, high + _PAST_MM, table),
            ]
        )
        found.append(Wire(colour, held @ to_bed[:3, :3].T + to_bed[:3, 3], lying))
    return tuple(found)
