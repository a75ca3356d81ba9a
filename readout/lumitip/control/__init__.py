"""From what a frame says to how the finger should move; without a device, a clock or a thread.

trace = Tracer(LineLaw(speed_mm_s=120.0))
command = trace(estimate, dt_s)     # forward and lateral velocity (mm/s), rotation (rad/s)
"""

from lumitip.control.command import Command, ControlError, Limits
from lumitip.control.laws import CentreLaw, Law, LineLaw
from lumitip.control.sight import Sight, sight_of
from lumitip.control.tracer import Tracer

__all__ = [
    "CentreLaw",
    "Command",
    "ControlError",
    "Law",
    "Limits",
    "LineLaw",
    "Sight",
    "Tracer",
    "sight_of",
]
