"""A tracer's commands on a robot arm, within limits. **Untried on an arm**: see `docs/robots.md`.

with URArm("192.168.0.10", Mount(x=(1, 0, 0), y=(0, 0, 1)), ArmLimits(speed_mm_s=40.0)) as arm:
    for frame in tip.frames(timeout=0.5):
        arm.move(tracer(estimator(frame.values), dt_s), frame.t)
"""

from lumitip.robots.guard import ArmLimits, ArmState, ArmStopped, Guard
from lumitip.robots.mount import ArmError, Mount
from lumitip.robots.ur import URArm

__all__ = ["ArmError", "ArmLimits", "ArmState", "ArmStopped", "Guard", "Mount", "URArm"]
