"""Follow a simulated cable in real time, with a live view.

python examples/trace_cable.py 80 8642     speed in mm/s; port of the live view (optional)
"""

import sys

from lumitip.control import LineLaw, Tracer
from lumitip.estimation import PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.tasks import Settings, Task
from lumitip.tasks.live import LiveTask

if len(sys.argv) == 1:
    sys.exit(__doc__)

speed, port = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else None
layout = published_layout()
world = LiveTask(
    Task(layout, Settings("cable", latency=0)), "twin://trace-cable", 1, patience_s=0.5
)
estimator = PoseEstimator(layout, tracking=True).prepare("cable")
trace = Tracer(LineLaw(speed, gain_per_s=8.0, turn_per_s=10.0))
with world.open() as tip, world.shown(tip, port):
    before_s = tip.wait_latest(2.0).t
    for frame in tip.frames(timeout=2.0):
        if frame is not tip.latest():
            continue  # a newer one is here already
        dt_s, before_s = frame.t - before_s, frame.t
        world.command(trace(estimator(frame.values, "cable"), dt_s))
m = world.metrics()
print(f"{m.reason} after {m.travelled_mm:.0f} mm in {m.seconds:.1f} s")
print(f"lateral {m.lateral_rms_mm:.2f} mm rms, angle {m.angle_rms_deg:.1f}° rms (simulated)")
