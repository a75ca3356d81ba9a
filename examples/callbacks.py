"""Call a function with every frame, in a separate thread.

python examples/callbacks.py twin://corner
"""

import sys
import time

from lumitip import Fingertip, Frame

if len(sys.argv) == 1:
    sys.exit(__doc__)


def frame_came(frame: Frame) -> None:
    """Slow work is allowed here: frames wait in a queue, and dropped ones are counted."""
    print(f"{frame.seq:6}  {(frame.values < 128).sum():2} cells covered")


url, *layout = sys.argv[1:]
with Fingertip.open(url, *layout) as tip:
    stop = tip.subscribe(frame_came)
    time.sleep(0.5)
    stop()
