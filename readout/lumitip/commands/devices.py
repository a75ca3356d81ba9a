"""`lumitip scan`, `tare` and `doctor`: find a device, calibrate it and test its cells."""

import argparse
import sys
from collections import Counter
from typing import TYPE_CHECKING

from lumitip.commands.common import open_fingertip
from lumitip.errors import EndOfRecording, LumitipError

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip
    from lumitip.frame import Frame

NONE_FOUND = FAULTS_FOUND = 1
_LEAST_FRAMES = 20  # fewer make healthy cells look stuck or noisy


def scan(options: argparse.Namespace) -> int:
    """Print the devices found; exit code 1 if there is none."""
    from lumitip.links.scan import scan as search

    result = search(options.seconds, options.only)
    names = Counter(found.name for found in result.found if found.sure)
    for found in result.found:
        note = "" if found.sure else ", may be a fingertip"
        if found.sure and names[found.name] > 1:
            note = ", open it by this address: other devices have the same name"
        print(f"{found.url}  {found.name}  {found.detail}{note}")
    for why in result.unsearched:
        print(f"not searched: {why}", file=sys.stderr)
    if not result.found:
        print("no fingertip found; twin://demo is a simulated one", file=sys.stderr)
    return 0 if result.found else NONE_FOUND


def tare(options: argparse.Namespace) -> int:
    """Measure a reference, or delete the saved ones."""
    from lumitip.session.drift import WARM_UP_S

    with open_fingertip(options, calibrated=not options.forget) as tip:
        if options.forget:
            tip.forget()
            print(f"{tip.device_id}: saved references deleted")
            return 0
        state = "with all light shut off" if options.dark else "with nothing between the fingers"
        print(f"{tip.device_id}: hold still {state}, waiting for 50 frames", flush=True)
        calibration = tip.tare("dark" if options.dark else "empty")
        reference = calibration.dark if options.dark else calibration.empty
        assert reference is not None
        print(
            f"{tip.device_id}: cells read {reference.min():.1f} to {reference.max():.1f} of 255 "
            f"{'in the dark' if options.dark else 'with an empty grasp'}; saved"
        )
        last = tip.latest()
        if last and (last.t_device or WARM_UP_S) < WARM_UP_S:
            print("the device is warming up: tare again five minutes after switching on")
    return 0


def doctor(options: argparse.Namespace) -> int:
    """Test the cells, or the mask's material; exit code 1 if a fault is found."""
    if options.opacity:
        from lumitip.commands.opacity import measure_opacity

        return 0 if measure_opacity(options) else FAULTS_FOUND
    import numpy as np

    from lumitip.frame import complement
    from lumitip.health.doctor import examine
    from lumitip.session.drift import WARM_UP_S

    with open_fingertip(options, calibrated=False) as tip:
        print(
            f"{tip.device_id}: testing {len(tip.layout)} cells for {options.seconds:g} s; move an "
            "object over all of them"
        )
        frames = _frames(tip, options.seconds, options.timeout)
        stats = tip.stats
    if len(frames) < _LEAST_FRAMES:
        raise LumitipError(
            f"{len(frames)} frames came; {_LEAST_FRAMES} are needed. Increase --seconds"
        )
    report = examine(np.stack([complement(f.raw, f.bits) for f in frames]), tip.layout)
    causes = [
        f"{number} lost ({cause})" for cause, number in (stats.dropped or {}).items() if number
    ]
    lost = "none lost" if stats.dropped is not None else "number of lost frames unknown"
    print(
        f"{len(frames)} frames, {stats.rate_hz or 0:.0f} Hz, {', '.join(causes) or lost}; "
        f"noise {np.median(report.noise):.2f} of 255"
    )
    if frames[0].t_device is not None and frames[0].t_device < WARM_UP_S:
        print(f"switched on {frames[0].t_device:.0f} s ago: cells drift for the first five minutes")
    if report.unseen:
        print(report.unseen)
    for finding in report.findings:
        kind = finding.kind if finding.sure else f"perhaps {finding.kind}"
        cells = " and ".join(map(str, finding.cells))
        print(f"{f'cell {cells}' if cells else 'all cells'} {kind}: {finding.detail}")
    if not report.findings:
        print("no fault found")
    return FAULTS_FOUND if report.findings else 0


def _frames(tip: "Fingertip", seconds: float, timeout_s: float) -> "list[Frame]":
    """The frames of some seconds, or of a whole recording that is shorter."""
    frames = [tip.read(timeout_s)]
    try:
        while frames[-1].t < frames[0].t + seconds:
            frames.append(tip.read(timeout_s))
    except EndOfRecording:
        pass
    return frames
