"""Follow a simulated cable in real time with a real UR arm. Untried on an arm: read docs/robots.md
first, keep a hand on the emergency stop, and keep the surroundings of the arm free.

python examples/trace_cable_ur.py 192.168.0.10 40     address of the arm; speed in mm/s
"""

import sys

from lumitip import LumitipError
from lumitip.control import LineLaw, Tracer
from lumitip.estimation import PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.robots import ArmLimits, ArmStopped, Mount, URArm
from lumitip.tasks import Settings, Task
from lumitip.tasks.live import LiveTask

if len(sys.argv) <= 2:
    sys.exit(__doc__)

host, speed = sys.argv[1], float(sys.argv[2])
layout = published_layout()
world = LiveTask(Task(layout, Settings("cable", latency=0, lag_s=0.0)), "twin://trace-cable", 1)
estimator = PoseEstimator(layout, tracking=True).prepare("cable")
trace = Tracer(LineLaw(speed, gain_per_s=4.0, turn_per_s=4.0))
mount = Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0, 0, 20))  # the sensor in the tool frame
limits = ArmLimits(speed_mm_s=1.5 * speed, travel_mm=600.0, stale_s=0.3, watchdog_hz=5.0)
# Or Fingertip.open("ble://Lumitip"). The arm comes last, and so is the first to stop.
try:
    with world.open() as tip, URArm(host, mount, limits) as arm:
        before_s = tip.wait_latest(2.0).t
        try:
            for frame in tip.frames(timeout=2.0):
                if frame is not tip.latest():
                    continue  # a newer one is here already
                dt_s, before_s = frame.t - before_s, frame.t
                arm.move(trace(estimator(frame.values, "cable"), dt_s), min(frame.t, frame.t_host))
                world.command(arm.measured())  # the cable slides through as the arm moves
        except ArmStopped as stopped:  # also by the tracer, where it has lost the line
            print(stopped)
except LumitipError as error:  # each says what to do: no arm there, no frame in time, …
    sys.exit(str(error))
m = world.metrics()
why = m.reason or arm.stopped
print(f"{why} after {m.travelled_mm:.0f} mm in {m.seconds:.1f} s, arm: {arm.stopped}")
print(f"lateral {m.lateral_rms_mm:.2f} mm rms, angle {m.angle_rms_deg:.1f}° rms (simulated)")
