"""From the contact in a frame to the motion of the finger; without a device, a clock or a thread.

trace = Tracer(LineLaw(speed_mm_s=120.0))
command = trace(estimate, dt_s)     # forward and lateral velocity (mm/s), rotation (rad/s)
"""

from lumitip.control.laws import CentreLaw, Command, ControlError, Law, Limits, LineLaw, Sight
from lumitip.control.tracer import Tracer, sight_of

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
