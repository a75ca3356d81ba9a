"""`lumitip accept`: a builder's protocol for a finished pair of fingers, and its report."""

import argparse
import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import numpy as np

from lumitip.acceptance.gauge import Gauge, Placement
from lumitip.acceptance.report import Circumstances, mean_deviations, prepare, write
from lumitip.acceptance.stage import Trace, Traverse
from lumitip.acceptance.steps import Frames
from lumitip.acceptance.verdict import Judge, Verdict
from lumitip.calibration import Calibration
from lumitip.commands.common import open_fingertip
from lumitip.commands.stage import Stage, opened
from lumitip.errors import LumitipError
from lumitip.fingertip import Fingertip
from lumitip.frame import Frame, Values, complement
from lumitip.interrupt import InterruptsHeld
from lumitip.recording.metadata import versions

NOT_ACCEPTED = 1
STEADY = 100
"""Frames of a steady step: a noise of 1.5 of 255 averages to 0.15."""
_LEAST_MOVING = 50
_TRIES = 3
"""Of the step with the sheet that moves."""
_MOST_THICKER_MM = 2.0
_EMPTY = (
    "close the fingers on the gauge; then take it out, and leave the fingers as far apart, with "
    "nothing between them"
)
_SHEET = "hold sheet metal over all cells, at the receiver"
_MOVING = "move the edge of the sheet over all cells, in all directions, for {seconds:g} s"


def run(options: argparse.Namespace) -> int:
    """Lead through the steps, write the report, and print the verdict; exit code 1 if the fingers
    are not accepted.

    Raises:
        LumitipError: if the gauge is not that of the fingertip, a thickness is out of range, there
            is no keyboard, or the report cannot be written.
    """
    gauge, thicker_mm = Gauge.load(options.gauge), _thicker_mm(options.thicker_mm)
    began = datetime.now().astimezone().isoformat(timespec="seconds")
    with opened(options.stage) as stage, open_fingertip(options, calibrated=False) as tip:
        layout, device_id = tip.layout, tip.device_id
        judge = Judge(layout, gauge)
        reference = None
        if options.reference:
            reference = mean_deviations(options.reference, layout.design_hash)
        with _writing(options.out):
            prepare(options.out)
        try:
            frames = _protocol(tip, gauge, judge, options, stage)
            judged = judge(frames, reference, thicker_mm)
            named = versions() | ({"printer": stage.printer.firmware} if stage else {})
            circumstances = Circumstances(
                device_id, began, gauge.sha256, named, reference, thicker_mm
            )
        except KeyboardInterrupt:
            print("\nended before the verdict: no report and no reference is saved", flush=True)
            raise
        with InterruptsHeld():  # from here on all of it is kept
            with _writing(options.out):
                written = write(options.out, frames, judged, layout, circumstances)
            _print(judged)
            if thicker_mm is None:
                print("  thickness of the silicone was not judged: measure it, use --thicker-mm")
            print(f"report: {written[0]}")
            if judged.accepted:
                blank = Calibration(device_id, layout.design_hash)
                blank.measured("dark", frames.sheet).measured("empty", frames.empty).save()
                print("both references of its cells are saved, as `lumitip tare` saves them")
            sys.stdout.flush()
    return 0 if judged.accepted else NOT_ACCEPTED


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise LumitipError(
            f"{folder}: the report cannot be written: {error}. Choose another folder with --out"
        ) from error


def _protocol(
    tip: Fingertip,
    gauge: Gauge,
    judge: Judge,
    options: argparse.Namespace,
    stage: Stage | None,
) -> Frames:
    steps = 3 + len(gauge.placements)
    print(f"{tip.device_id}: {steps} steps; the gripper stays where step 1 leaves it")

    def steady(number: int, text: str) -> Values:
        _ask(f"{number} of {steps}: {text}")
        return _frames(tip, options.timeout, STEADY)

    def moved() -> tuple[Values, tuple[Traverse, ...]]:
        def ask(text: str) -> None:
            _ask(f"3 of {steps}: {text}")

        if stage is None:
            ask(_MOVING.format(seconds=options.seconds))
            return _frames(tip, options.timeout, _LEAST_MOVING, options.seconds), ()
        parts = tuple(stage.traverses(tip, options.timeout, ask))
        return np.concatenate([part.light.reshape(-1, len(tip.layout)) for part in parts]), parts

    empty, sheet = steady(1, _EMPTY), steady(2, _SHEET)
    for left in reversed(range(_TRIES)):
        moving, parts = moved()
        unseen = judge.unseen(empty, sheet, moving)
        if unseen is None:
            break
        # Fingers with many faults never show it: they get their verdict without.
        print(f"  {'once more' if left else 'going on without'}: {unseen}")
    on_gauge = [steady(4 + n, _put(of)) for n, of in enumerate(gauge.placements)]
    return Frames(empty, sheet, moving, tuple(on_gauge), parts)


def _thicker_mm(values: list[float] | None) -> tuple[float, float] | None:
    if values is None:
        return None
    receiver, emitter = values
    for value in values:
        if not abs(value) <= _MOST_THICKER_MM:
            raise LumitipError(
                f"--thicker-mm has {value:g}; -{_MOST_THICKER_MM:g} to {_MOST_THICKER_MM:g} is "
                "allowed. It is the measured thickness less the drawn one"
            )
    return receiver, emitter


def _put(placement: Placement) -> str:
    end = {"edge": "with the edge (E)", "strip": "with the strip (S)"}[placement.piece.kind]
    return (
        f"put the end {end} of the gauge between the fingers, its rails round the {placement.on}, "
        "its stop against the tip, and close the fingers on it"
    )


def _ask(text: str) -> None:
    try:
        input(f"{text}; then press Enter: ")
    except EOFError:
        raise LumitipError("no Enter came: run it in a terminal") from None


def _frames(tip: Fingertip, timeout_s: float, least: int, seconds: float = 0.0) -> Values:
    """Light of some frames, over some time (s) at least, shape `(frames, cells)`."""
    last = tip.wait_latest(timeout_s)  # may be older than the step
    frames = list[Frame]()
    while len(frames) < least or frames[-1].t < last.t + seconds:
        frames.append(tip.wait_latest(timeout_s))
    return np.stack([complement(frame.raw, frame.bits) for frame in frames])


def _print(judged: Verdict) -> None:
    for finding in judged.findings:
        print(f"  {finding.text}")
    if judged.unseen:
        print(f"  {judged.unseen}")
    if judged.deviations:
        print(f"  differences from the twin: {judged.misfit:.1f} of 255 rms")
    for of in judged.traces:
        print(f"  the edge along {of.direction}: {_exactness(of)}")
    print("ACCEPTED" if judged.accepted else "NOT accepted")


def _exactness(of: Trace) -> str:
    if math.isnan(of.error_mm):
        return "not found at enough places over the cells"
    missed = f", {of.missed} not found" if of.missed else ""
    return (
        f"error {of.error_mm:.2f} mm rms, worst {of.worst_mm:.2f} mm, at {of.places} places{missed}"
    )
