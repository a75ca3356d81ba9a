"""`lumitip info`, `replay`, `export`, `recover` and `foxglove`: commands that read recordings."""

import argparse
import time
from datetime import UTC, datetime
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lumitip.processing import Contact
    from lumitip.recording import Summary

_SLOWEST = 0.001


def info(options: argparse.Namespace) -> int:
    """Print a summary; exit code 1 if the recording is damaged."""
    from lumitip.recording import summarise

    summary = summarise(options.file, options.finger)
    metadata, calibration = summary.metadata, summary.metadata.calibration
    references = [n for n in ("empty", "dark") if getattr(calibration, n, None) is not None]
    lines = {
        "device": metadata.device_id,
        "design": f"{metadata.layout.design_hash[:16]}, {len(metadata.layout)} cells",
        "begun": datetime.fromtimestamp(metadata.start_wall, UTC).isoformat(" ", "seconds"),
        "frames": f"{summary.frames} in {summary.seconds:.3f} s, {summary.rate_hz:.1f} a second",
        "lost": _lost(summary),
        "calibration": " and ".join(references) or "none",
        "made with": ", ".join(f"{k} {v}" for k, v in sorted(metadata.versions.items())),
        "damage": "; ".join(summary.damage[:5]) or "none",
    }
    for name, text in lines.items():
        print(f"{name:<12} {text}")
    if summary.damage:
        print(f"`lumitip recover {options.file}` saves the readable frames")
    return 1 if summary.damage else 0


def _lost(summary: "Summary") -> str:
    if summary.lost_known:
        return str(summary.lost)
    return f"at least {summary.lost}" if summary.lost else "unknown"


def export(options: argparse.Namespace) -> int:
    """Write the table."""
    from lumitip.recording import export as write_table

    rows = write_table(options.file, options.table, options.finger)
    print(f"{options.table}: {rows} frames")
    return 0


def recover(options: argparse.Namespace) -> int:
    """Write the new recording."""
    from lumitip.recording import RecordingError
    from lumitip.recording import recover as write_readable

    target = options.target or options.file.with_suffix(".recovered.mcap")
    if target.suffix != ".mcap":
        raise RecordingError(f"the new file is {target}; its name must end in .mcap")
    saved = write_readable(options.file, target, options.finger)
    print(f"{saved.path}: {saved.frames} frames; {'; '.join(saved.damage) or 'no damage found'}")
    return 0


def foxglove(options: argparse.Namespace) -> int:
    """Write the file for Foxglove, and the layout of its panels beside it."""
    from lumitip.foxglove import FoxgloveError, by_name, panels, write_scene

    recordings = by_name(options.files)
    layout = options.out.with_suffix(".foxglove.json")
    if layout.exists():
        raise FoxgloveError(f"{layout} exists. Choose another --out")
    written = write_scene(
        options.out,
        recordings,
        gap_mm=options.gap,
        diameter_mm=options.diameter,
        estimates=not options.no_estimate,
    )
    try:
        with layout.open("x", encoding="utf-8") as file:
            file.write(panels(list(recordings)))
    except OSError as error:
        raise FoxgloveError(f"{layout}: cannot be written: {error}") from error
    print(f"{written.path}: {written.frames} frames of {', '.join(recordings)}")
    print(f"{layout}: in Foxglove, menu of layouts, import from file")
    for why in written.damage:
        print(f"left out: {why}")
    return 1 if written.damage else 0


def replay(options: argparse.Namespace) -> int:
    """Print one line per frame."""
    from lumitip.processing import Tracker
    from lumitip.recording import LONGEST_GAP_S, Reader, RecordingError

    if not (options.speed == 0.0 or options.speed >= _SLOWEST):
        raise RecordingError(f"--speed is {options.speed:g}; 0, or {_SLOWEST:g} or more, is needed")
    reader = Reader(options.file, finger=options.finger)
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
        print(f"{elapsed_s:10.3f} s  {frame.seq:>8}  {_line(contact)}{lost}")
    return 0


def _line(contact: "Contact") -> str:
    parts = [f"{contact.shape:<8}"]
    if contact.centre_mm is not None:
        parts.append("centre {:7.2f} {:7.2f} mm".format(*contact.centre_mm))
    if contact.shape == "cable" and contact.cable is not None:
        cable = contact.cable
        parts.append(f"axis {cable.angle_deg:6.1f}°, {cable.width_mm:.1f} mm wide")
    elif contact.shape == "corner" and contact.corner is not None:
        corner = contact.corner
        vertex = "vertex {:.2f} {:.2f} mm".format(*corner.vertex_mm)
        parts.append(f"{vertex}, opens {corner.opening_deg:.0f}°")
    elif contact.line is not None:
        parts.append(f"line {contact.line.angle_deg:6.1f}°, rms {contact.line.rms_mm:.2f} mm")
    return "  ".join(parts)
