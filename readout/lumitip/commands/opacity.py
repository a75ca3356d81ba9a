"""`lumitip doctor --opacity`: light through a coupon of the mask's material."""

import argparse

import numpy as np

from lumitip.commands.common import open_fingertip
from lumitip.errors import LumitipError
from lumitip.fingertip import Fingertip
from lumitip.frame import Values, complement
from lumitip.health.opacity import Opacity, opacity

FRAMES = 200  # of each state: a noise of 1.5 of 255 averages to 0.1
_STATES = (
    "take everything out from between the fingers",
    "hold sheet metal over all cells, at the receiver",
    "hold the coupon (outputs/mask/coupon.*) over all cells, at the receiver",
)


def measure_opacity(options: argparse.Namespace) -> bool:
    """Ask for three states, measure each, and print the verdict; whether the material is opaque.

    Raises:
        LumitipError: if there is no keyboard, or no cell sees enough light.
    """
    with open_fingertip(options, calibrated=False) as tip:
        print(f"{tip.device_id}: the same opening of the gripper for all three steps")
        clear, metal, coupon = (_measured(tip, text, options.timeout) for text in _STATES)
        result = opacity(clear, metal, coupon, tip.layout)
    if not result.judged:
        raise LumitipError(
            "no cell loses 50 of 255 behind the metal: open the fingers less, and hold the metal "
            "over the cells"
        )
    _print(result)
    return result.opaque


def _measured(tip: Fingertip, text: str, timeout_s: float) -> Values:
    """Frames of one state, after the user has made it, shape `(FRAMES, cells)`."""
    try:
        input(f"{text}; then press Enter: ")
    except EOFError:
        raise LumitipError("no Enter came: run it in a terminal") from None
    tip.wait_latest(timeout_s)  # may be older than the state
    frames = [tip.wait_latest(timeout_s) for _ in range(FRAMES)]
    return np.stack([complement(frame.raw, frame.bits) for frame in frames])


def _print(result: Opacity) -> None:
    worst, silent = result.worst, int(np.isnan(result.transmission).sum())
    if silent:
        print(f"{silent} cells lose less than 50 of 255 behind the metal and are not judged")
    print(
        f"light through the coupon: {np.nanmedian(result.transmission):.2%} in the median, "
        f"{result.transmission[worst]:.2%} ± {result.error[worst]:.2%} at cell {worst}; "
        f"at most {result.most:.2%} is allowed"
    )
    print("opaque" if result.opaque else "NOT opaque: take another ink, film or filament")
