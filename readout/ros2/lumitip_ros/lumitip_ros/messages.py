"""Messages of a frame: metres and radians, in the frame of the receiver's link."""

import math
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, TransformStamped
from lumitip_msgs.msg import Contact, Estimate, Values
from std_msgs.msg import Header

from lumitip import Frame, processing
from lumitip.estimation import Estimate as Estimated

_METRE = 1e-3  # of a millimetre
_NAN = math.nan
_SCALES = {"_mm": _METRE, "_deg": math.pi / 180.0, "_per_mm": 1.0 / _METRE}


def header(stamp_s: float, frame_id: str) -> Header:
    """A time (seconds since 1970), and the frame in which lengths are."""
    seconds = math.floor(stamp_s)
    carried, nanosec = divmod(round((stamp_s - seconds) * 1e9), 1_000_000_000)
    return Header(stamp=Time(sec=seconds + carried, nanosec=nanosec), frame_id=frame_id)


def values(frame: Frame, header: Header) -> Values:
    """Light of all cells."""
    dropped = -1 if frame.dropped_before is None else frame.dropped_before
    return Values(header=header, values=frame.values.tolist(), dropped_before=dropped)


def contact(found: processing.Contact, header: Header) -> Contact:
    """Contact by the published method."""
    line = found.line if found.shape == "edge" else None
    cable = found.cable if found.shape == "cable" else None
    corner = found.corner if found.shape == "corner" else None
    turned = cable or line
    return Contact(
        header=header,
        shape=found.shape,
        threshold=_NAN if found.threshold is None else float(found.threshold),
        contrast=_NAN if found.contrast is None else float(found.contrast),
        centre=_point(found.centre_mm),
        angle=math.radians(turned.angle_deg) if turned else _NAN,
        width=cable.width_mm * _METRE if cable else _NAN,
        vertex=_point(corner.vertex_mm if corner else None),
        opening=math.radians(corner.opening_deg) if corner else _NAN,
    )


def estimate(found: Estimated, header: Header) -> Estimate:
    """Pose with its covariance."""
    named = [_in_si(name) for name in found.parameters]
    covariance = [
        float(value) * row_scale * column_scale
        for (_, row_scale), row in zip(named, found.covariance.tolist(), strict=True)
        for (_, column_scale), value in zip(named, row, strict=True)
    ]
    return Estimate(
        header=header,
        kind=found.kind,
        flags=list(found.flags),
        offset=float(found.offset_mm) * _METRE,
        angle=math.radians(found.angle_deg),
        dark_side=found.dark_side,
        width=float(found.width_mm) * _METRE,
        curvature=float(found.curvature_per_mm) / _METRE,
        vertex=_point(found.vertex_mm),
        direction=math.radians(found.direction_deg),
        opening=math.radians(found.opening_deg),
        parameters=[name for name, _ in named],
        covariance=covariance,
        transmittance=float(found.transmittance),
        gain=float(found.gain),
        rms_counts=float(found.rms_counts),
        left_out=list(found.left_out),
    )


def line_transform(found: Estimated, header: Header, child_frame_id: str) -> TransformStamped:
    """The line of an estimate as a frame: its origin is the point of the line that is nearest to
    the origin of the sensor, its x axis runs along the line."""
    angle = math.radians(found.angle_deg)
    offset = float(found.offset_mm) * _METRE
    placed = TransformStamped(header=header, child_frame_id=child_frame_id)
    placed.transform.translation.x = -offset * math.sin(angle)
    placed.transform.translation.y = offset * math.cos(angle)
    placed.transform.rotation.z = math.sin(angle / 2.0)
    placed.transform.rotation.w = math.cos(angle / 2.0)
    return placed


def _in_si(name: str) -> tuple[str, float]:
    """A parameter's name without its unit, and its unit in metres or radians."""
    for ending, scale in sorted(_SCALES.items(), key=lambda each: -len(each[0])):
        if name.endswith(ending):
            return name.removesuffix(ending), scale
    return name, 1.0


def _point(at_mm: tuple[float, float] | None) -> Any:
    if at_mm is None:
        return Point(x=_NAN, y=_NAN, z=_NAN)
    return Point(x=float(at_mm[0]) * _METRE, y=float(at_mm[1]) * _METRE, z=0.0)
