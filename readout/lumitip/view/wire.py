"""The messages of the stream: binary for frames, JSON for estimates and status.

A binary message, little-endian, every array aligned to its own size:

    u8 kind (1), u8 0, u16 finger, u16 frames, u16 cells, u16 markers, u16 0, u32 number,
    u32 skipped, u32 0                                  24 bytes
    f64 × frames          time since the first frame of this finger (s)
    f32 × 20              contact, see `_contact`; NaN: does not apply
    f32 × 2 markers       markers (mm)
    u32 × frames          sequence numbers, modulo 2^32
    u16 × frames × cells  values in 1/256 of a count, 65535 is NaN

An estimate is `{"estimate": …}`, see `lumitip.view.pose`, with finger, number and time.
"""

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

from lumitip.frame import Frame
from lumitip.processing import SHAPES, Contact

HEADER = struct.Struct("<BxHHHHxxIIxxxx")
FRAMES = 1
CONTACT_FIELDS = 20
_NOT_A_NUMBER = 65535


def encode(
    finger: int,
    number: int,
    frames: Sequence[Frame],
    contact: Contact,
    skipped: int = 0,
    since: float = 0.0,
) -> bytes:
    """Encode one or more frames of one finger, in order.

    Args:
        finger: number of the finger.
        number: of this message, for its acknowledgement.
        contact: of the last frame.
        skipped: number of frames skipped before these.
        since: `Frame.t` of time 0 (s).
    """
    markers = contact.markers_mm if contact.markers_mm is not None else np.empty((0, 2))
    cells = frames[0].values.size
    head = HEADER.pack(FRAMES, finger, len(frames), cells, len(markers), number, skipped)
    values = np.rint(np.stack([f.values for f in frames]) * np.float32(256.0))
    codes = np.where(np.isfinite(values), values, _NOT_A_NUMBER).astype("<u2")
    return b"".join(
        (
            head,
            np.array([f.t - since for f in frames], "<f8").tobytes(),
            np.array(_contact(contact), "<f4").tobytes(),
            markers.astype("<f4").tobytes(),
            np.array([f.seq % 2**32 for f in frames], "<u4").tobytes(),
            codes.tobytes(),
        )
    )


def _contact(contact: Contact) -> list[float]:
    """Shape, λ, contrast, centre (2), line (4), corner (6), cable (5); order as in `Contact`."""
    nan = float("nan")
    line, corner, cable = contact.line, contact.corner, contact.cable
    return [
        float(SHAPES.index(contact.shape)),
        nan if contact.threshold is None else contact.threshold,
        nan if contact.contrast is None else contact.contrast,
        *(contact.centre_mm or (nan, nan)),
        *((*line.point_mm, line.angle_deg, line.rms_mm) if line else [nan] * 4),
        *(
            (*corner.vertex_mm, *corner.directions_deg, corner.opening_deg, corner.rms_mm)
            if corner
            else [nan] * 6
        ),
        *(
            (*cable.axis_point_mm, cable.angle_deg, cable.width_mm, cable.rms_mm)
            if cable
            else [nan] * 5
        ),
    ]


def encode_estimate(finger: int, number: int, t_s: float, described: dict[str, Any]) -> str:
    """Encode an estimate.

    Args:
        finger: number of the finger.
        number: of this message, for its acknowledgement.
        t_s: time of its frame since the first frame of the finger (s).
        described: see `lumitip.view.pose.described`.
    """
    return json.dumps({"estimate": {"finger": finger, "number": number, "t": t_s, **described}})
