"""Print the next frames of a fingertip, in order, and the number of lost ones.

python examples/read_frames.py twin://cable
python examples/read_frames.py ble://Lumitip outputs/layout.json
"""

import sys
from itertools import islice

from lumitip import Fingertip

if len(sys.argv) == 1:
    sys.exit(__doc__)

url, *layout = sys.argv[1:]
with Fingertip.open(url, *layout) as tip:
    for frame in islice(tip.frames(timeout=5.0), 20):
        darkest = int(frame.values.argmin())
        print(
            f"{frame.seq:6} at {frame.t:.4f} s, cell {darkest} is darkest with "
            f"{frame.values[darkest]:.0f} of 255"
        )
    print(tip.device_id, tip.stats)
