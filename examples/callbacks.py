"""A function that is called with every frame, on a thread of its own.

python examples/callbacks.py twin://corner
"""

import sys
import time

from lumitip import Fingertip, Frame

if len(sys.argv) == 1:
    sys.exit(__doc__)


def frame_came(frame: Frame) -> None:
    """Slow work is fine here: frames wait, and what had to make room is counted."""
    print(f"{frame.seq:6}  {(frame.values < 128).sum():2} cells covered")


url, *layout = sys.argv[1:]
with Fingertip.open(url, *layout) as tip:
    stop = tip.subscribe(frame_came)
    time.sleep(0.5)
    stop()
