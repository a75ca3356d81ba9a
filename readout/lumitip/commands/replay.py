"""`lumitip replay`: go through a recording and tell what is between the fingers."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from lumitip.commands.common import Subparsers

if TYPE_CHECKING:
    from lumitip.processing import Contact

_SLOWEST = 0.001


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Print the contact of every recorded frame, as fast as it was recorded; gaps are cut "
    told += "to a second."
    more = "`lumitip view replay://FILE` shows a recording."
    parser = subparsers.add_parser("replay", help=told, description=f"{told} {more}")
    parser.add_argument("file", type=Path, metavar="FILE", help="to read")
    parser.add_argument(
        "--speed",
        type=float,
        default=1.0,
        metavar="N",
        help="N times as fast (1); 0 is as fast as possible",
    )


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.processing import Tracker
    from lumitip.recording import LONGEST_GAP_S, Reader, RecordingError

    if not (options.speed == 0.0 or options.speed >= _SLOWEST):
        raise RecordingError(
            f"--speed {options.speed:g} given, {_SLOWEST:g} or more is needed, or 0"
        )
    reader = Reader(options.file)
    track = Tracker(reader.layout)
    begun, first, last, due_s = time.monotonic(), None, 0.0, 0.0
    for frame in reader:
        first, last = (frame.t_wall, frame.t_wall) if first is None else (first, last)
        elapsed_s = frame.t_wall - first
        due_s += min(max(frame.t_wall - last, 0.0), LONGEST_GAP_S)
        last = frame.t_wall
        if options.speed:
            time.sleep(max(begun + due_s / options.speed - time.monotonic(), 0.0))
        contact = track(reader.metadata.values(frame))
        lost = f"  {frame.dropped_before} lost before" if frame.dropped_before else ""
        print(f"{elapsed_s:10.3f} s  {frame.seq:>8}  {_told(contact)}{lost}")
    return 0


def _told(contact: "Contact") -> str:
    parts = [f"{contact.shape:<8}"]
    if contact.centre_mm is not None:
        parts.append("centre {:7.2f} {:7.2f} mm".format(*contact.centre_mm))
    if contact.shape == "cable" and contact.cable is not None:
        cable = contact.cable
        parts.append(f"axis {cable.angle_deg:6.1f}°, {cable.width_mm:.1f} mm wide")
    elif contact.shape == "corner" and contact.corner is not None:
        corner = contact.corner
        parts.append("vertex {:.2f} {:.2f} mm, ".format(*corner.vertex_mm))
        parts[-1] += f"opens {corner.opening_deg:.0f}°"
    elif contact.line is not None:
        parts.append(f"line {contact.line.angle_deg:6.1f}°, rms {contact.line.rms_mm:.2f} mm")
    return "  ".join(parts)
