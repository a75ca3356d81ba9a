"""`lumitip doctor`: find cells that cannot be trusted."""

import argparse
from typing import TYPE_CHECKING

from lumitip.commands.common import Subparsers, add_fingertip, open_fingertip, some_seconds
from lumitip.errors import EndOfRecording, LumitipError

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip
    from lumitip.frame import Frame

UNWELL = 1
_LEAST_FRAMES = 20  # with fewer, chance alone makes cells look stuck or noisy


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Find dead, saturated, noisy and swapped-looking cells."
    parser = subparsers.add_parser(
        "doctor",
        help=told,
        description=f"{told} Move an object over all cells meanwhile, "
        "in all directions: only then do swapped cells show. Exits 1 if something is found.",
    )
    add_fingertip(parser)
    parser.add_argument(
        "--seconds", type=some_seconds, default=15.0, metavar="S", help="how long to look (15)"
    )


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    import numpy as np

    from lumitip.frame import complement
    from lumitip.health.doctor import examine
    from lumitip.session.drift import WARM_UP_S

    with open_fingertip(options, calibrated=False) as tip:
        print(
            f"{tip.device_id}: {len(tip.layout)} cells, looking for {options.seconds:g} s; move "
            "an object over all of them"
        )
        frames = _frames(tip, options.seconds, options.timeout)
        first = frames[0]
        stats = tip.stats
    if len(frames) < _LEAST_FRAMES:
        raise LumitipError(
            f"{len(frames)} frames came, to judge cells at least {_LEAST_FRAMES} are needed: "
            "look longer with --seconds"
        )
    report = examine(np.stack([complement(f.raw, f.bits) for f in frames]), tip.layout)
    causes = [
        f"{number} lost by {cause}" for cause, number in (stats.dropped or {}).items() if number
    ]
    lost = "none lost" if stats.dropped is not None else "it cannot tell what is lost"
    print(
        f"{len(frames)} frames, {stats.rate_hz or 0:.0f} a second, {', '.join(causes) or lost}; "
        f"noise of {np.median(report.noise):.2f} of 255"
    )
    if first.t_device is not None and first.t_device < WARM_UP_S:
        print(f"switched on {first.t_device:.0f} s ago: cells drift for the first five minutes")
    if report.unseen:
        print(report.unseen)
    for finding in report.findings:
        kind = finding.kind if finding.sure else f"perhaps {finding.kind}"
        cells = " and ".join(map(str, finding.cells))
        print(f"{f'cell {cells}' if cells else 'all cells'} {kind}: {finding.detail}")
    if not report.findings:
        print("nothing wrong was found")
    return UNWELL if report.findings else 0


def _frames(tip: "Fingertip", seconds: float, timeout_s: float) -> "list[Frame]":
    """Those of so many seconds, or of all of a shorter recording."""
    frames = [tip.read(timeout_s)]
    try:
        while frames[-1].t < frames[0].t + seconds:
            frames.append(tip.read(timeout_s))
    except EndOfRecording:
        pass
    return frames
