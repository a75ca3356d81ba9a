"""Record two seconds of a fingertip and read them back. ROS 2 tools can open the file too.

python examples/record_and_read.py twin://demo run.mcap
"""

import sys

from lumitip import Fingertip
from lumitip.recording import Reader, Writer

if len(sys.argv) <= 2:
    sys.exit(__doc__)

url, path = sys.argv[1:3]
with (
    Fingertip.open(url, layout=sys.argv[3] if len(sys.argv) > 3 else None) as tip,
    Writer(path, tip.layout, device_id=tip.device_id, calibration=tip.calibration) as writer,
):
    first = tip.read(timeout=5.0)
    writer.write(first)
    while (frame := tip.read(timeout=5.0)).t < first.t + 2.0:
        writer.write(frame)

recording = Reader(path)
frames = list(recording)
lost = sum(frame.dropped_before or 0 for frame in frames)
print(f"{len(frames)} frames of {recording.metadata.device_id}, {lost} lost on the way")
print("light of the first:", recording.metadata.values(frames[0]).round().astype(int))
