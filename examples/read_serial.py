"""Read a USB fingertip: a block of frames as arrays, and statistics of the link.

python examples/read_serial.py serial:///dev/ttyACM0 outputs/layout.json
"""

import sys

from lumitip import Fingertip, LumitipError

if len(sys.argv) <= 2:
    sys.exit(__doc__)

try:
    with Fingertip.open(sys.argv[1], layout=sys.argv[2]) as tip:
        block = tip.get_data(num_samples=55)
        print(f"{len(block)} frames of {block.values.shape[1]} cells, {block.dropped} lost between")
        print(
            f"{(len(block) - 1) / (block.t[-1] - block.t[0]):.0f} frames/s; cells see "
            f"{block.values.mean(axis=0).round().astype(int).tolist()}"
        )
        print(tip.stats)
except LumitipError as error:  # each says what to do: no such port, another design, …
    sys.exit(str(error))
