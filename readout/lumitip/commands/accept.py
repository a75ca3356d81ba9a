"""`lumitip accept`: a builder's protocol for a finished pair of fingers, and its report."""

import argparse
from datetime import datetime
from pathlib import Path

import numpy as np

from lumitip.acceptance.gauge import Gauge, Placement
from lumitip.acceptance.report import Circumstances, mean_deviations, write
from lumitip.acceptance.steps import Frames
from lumitip.acceptance.verdict import Judge, Verdict
from lumitip.calibration import Calibration
from lumitip.commands.common import open_fingertip
from lumitip.errors import LumitipError
from lumitip.fingertip import Fingertip
from lumitip.frame import Values, complement
from lumitip.recording.metadata import versions

NOT_ACCEPTED = 1
STEADY = 100
"""Frames of a steady step: a noise of 1.5 of 255 averages to 0.15."""
_EMPTY = (
    "close the fingers on the gauge; then take it out, and leave the fingers as far apart, with "
    "nothing between them"
)
_SHEET = "hold sheet metal over all cells, at the receiver"
_MOVING = "move the edge of the sheet over all cells, in all directions, for {seconds:g} s"


def run(options: argparse.Namespace) -> int:
    """Lead through the steps, print the verdict, and write the report; exit code 1 if the fingers
    are not accepted.

    Raises:
        LumitipError: if the gauge is not that of the fingertip, there is no keyboard, or the
            report cannot be written.
    """
    gauge = Gauge.load(options.gauge)
    reference = mean_deviations(options.reference) if options.reference else None
    began = datetime.now().astimezone().isoformat(timespec="seconds")
    with open_fingertip(options, calibrated=False) as tip:
        judge = Judge(tip.layout, gauge)
        frames = _protocol(tip, gauge, options)
        layout, device_id = tip.layout, tip.device_id
        judged = judge(frames, reference)
        made = Circumstances(device_id, began, Path(options.gauge).read_bytes(), versions())
        if judged.accepted:
            _calibrate(tip, frames)
    try:
        written = write(options.out, frames, judged, layout, made)
    except OSError as error:
        raise LumitipError(f"{options.out}: the report cannot be written: {error}") from error
    _print(judged)
    print(f"report: {written[0]}")
    return 0 if judged.accepted else NOT_ACCEPTED


def _protocol(tip: Fingertip, gauge: Gauge, options: argparse.Namespace) -> Frames:
    steps = 3 + len(gauge.placements)
    print(f"{tip.device_id}: {steps} steps; the gripper stays where step 1 leaves it")

    def steady(number: int, text: str) -> Values:
        _ask(f"{number} of {steps}: {text}")
        return _frames(tip, STEADY, options.timeout)

    empty, sheet = steady(1, _EMPTY), steady(2, _SHEET)
    _ask(f"3 of {steps}: " + _MOVING.format(seconds=options.seconds))
    first = tip.wait_latest(options.timeout)
    moving = [first]
    while moving[-1].t < first.t + options.seconds:
        moving.append(tip.wait_latest(options.timeout))
    parts = [steady(4 + n, _put(of)) for n, of in enumerate(gauge.placements)]
    light = np.stack([complement(frame.raw, frame.bits) for frame in moving])
    return Frames(empty, sheet, light, tuple(parts))


def _put(placement: Placement) -> str:
    end = {"edge": "E", "strip": "S"}[placement.piece.kind]
    return (
        f"put end {end} of the gauge between the fingers, its rails round the {placement.on}, its "
        "stop against the tip, and close the fingers on it"
    )


def _ask(text: str) -> None:
    try:
        input(f"{text}; then press Enter: ")
    except EOFError:
        raise LumitipError("no Enter came: run it in a terminal") from None


def _frames(tip: Fingertip, count: int, timeout_s: float) -> Values:
    tip.wait_latest(timeout_s)  # may be older than the step
    frames = [tip.wait_latest(timeout_s) for _ in range(count)]
    return np.stack([complement(frame.raw, frame.bits) for frame in frames])


def _calibrate(tip: Fingertip, frames: Frames) -> None:
    """Save both references, as `lumitip tare` does."""
    blank = Calibration(tip.device_id, tip.layout.design_hash)
    blank.measured("dark", frames.sheet).measured("empty", frames.empty).save()


def _print(judged: Verdict) -> None:
    for finding in judged.findings:
        print(f"  {finding.text}")
    if judged.unseen:
        print(f"  {judged.unseen}")
    if judged.deviations:
        print(f"  differences from the twin: {judged.misfit:.1f} of 255 rms")
    print("ACCEPTED" if judged.accepted else "NOT accepted")
    if judged.accepted:
        print("both references of its cells are saved, as `lumitip tare` saves them")
