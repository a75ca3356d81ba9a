"""`lumitip info`: what a recording holds."""

import argparse
from datetime import UTC, datetime
from pathlib import Path

from lumitip.commands.common import Subparsers


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Tell what a recording holds; exit code 1 if it is damaged."
    parser = subparsers.add_parser("info", help=told, description=told)
    parser.add_argument("file", type=Path, metavar="FILE", help="the recording")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.recording import summarise

    found = summarise(options.file)
    about = found.metadata
    kept = about.calibration
    references = [n for n in ("empty", "dark") if kept and getattr(kept, n) is not None]
    begun = datetime.fromtimestamp(about.start_wall, UTC).isoformat(" ", "seconds")
    lines = {
        "device": about.device_id,
        "design": f"{about.layout.design_hash[:16]}, {len(about.layout)} cells",
        "begun": begun,
        "frames": f"{found.frames} in {found.seconds:.3f} s, {found.rate_hz:.1f} a second",
        "lost": str(found.lost),
        "calibration": " and ".join(references) or "none",
        "made with": ", ".join(f"{k} {v}" for k, v in sorted(about.versions.items())),
        "damage": "; ".join(found.damage[:5]) or "none",
    }
    for name, told in lines.items():
        print(f"{name:<12} {told}")
    if found.damage:
        print(f"`lumitip recover {options.file}` saves what is left")
    return 1 if found.damage else 0
