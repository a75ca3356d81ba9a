"""How bolts through printed parts are tightened."""

import math

from lumitip_fab.design import Design
from lumitip_fab.design.seat import torque_nm
from lumitip_fab.text import passage

ARM_MM = 25.0
"""Of a key's short end, where a finger pushes: about that of the key for M5, by ISO 2936."""


def tightened(design: Design, bolt: str, hole_mm: float, file: str, again: bool = False) -> str:
    """The torque of a bolt, and the push on the key's short end that it is.

    Args:
        design: for the thread and the filament.
        bolt: name of its thread, such as `"M5"`.
        hole_mm: through the printed part.
        file: of that part, below the output folder.
        again: whether the manual has said before how the key is held.
    """
    filament = design.slicing.of(file)
    torque = torque_nm(design.threads[bolt], hole_mm, filament.bearing_mpa)
    torque = math.floor(10 * torque) / 10
    push_n = round(1000 * torque / ARM_MM)
    return passage("docs/chapters.md", "tightened_too" if again else "tightened").format(
        torque_nm=torque, push_n=push_n, arm_mm=ARM_MM, filament=filament.name
    )
