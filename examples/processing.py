"""Contact frame by frame, without flicker between shapes.

python examples/processing.py twin://demo 200
"""

import sys
from itertools import islice

from lumitip import Fingertip
from lumitip.processing import Tracker

if len(sys.argv) <= 2:
    sys.exit(__doc__)

url, count = sys.argv[1], int(sys.argv[2])
with Fingertip.open(url, layout=sys.argv[3] if len(sys.argv) > 3 else None) as tip:
    track = Tracker(tip.layout)
    for frame in islice(tip.frames(timeout=2.0), count):
        contact = track(frame.values)
        text = contact.shape
        if contact.centre_mm is not None:
            text += " at {:.1f}, {:.1f} mm".format(*contact.centre_mm)
        if contact.shape == "edge" and contact.line is not None:
            text += f", {contact.line.angle_deg:.0f}°"
        elif contact.shape == "corner" and contact.corner is not None:
            text += f", opens {contact.corner.opening_deg:.0f}°"
        elif contact.shape == "cable" and contact.cable is not None:
            text += f", {contact.cable.angle_deg:.0f}°, {contact.cable.width_mm:.1f} mm wide"
        print(f"{frame.seq:6} {text}")
