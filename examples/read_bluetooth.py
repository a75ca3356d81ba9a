"""Read a Bluetooth fingertip in a control loop: the newest frame at each step, and link events.

python examples/read_bluetooth.py ble://Lumitip outputs/layout.json
"""

import sys
import time

from lumitip import Fingertip, LinkEvent, LumitipError
from lumitip.errors import StaleFrame

if len(sys.argv) <= 2:
    sys.exit(__doc__)


def print_event(event: LinkEvent) -> None:
    """Called on the link's thread: connected, lost, connected again, …"""
    print(f"{event.kind}: {event.detail}")


try:
    with Fingertip.open(sys.argv[1], layout=sys.argv[2], on_event=print_event) as tip:
        for _ in range(50):
            try:
                frame = tip.latest(max_age_s=0.5)
                print(f"{frame.seq:6}  {(frame.values < 128).sum():2} cells covered")
            except StaleFrame:  # none yet, or the link has stalled
                pass
            time.sleep(0.02)
except LumitipError as error:  # each says what to do: not found, several of that name, MTU, …
    sys.exit(str(error))
