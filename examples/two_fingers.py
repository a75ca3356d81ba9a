"""Read two fingertips together, with their frames aligned in time.

python examples/two_fingers.py twin://disc "twin://edge?rate=60"
python examples/two_fingers.py ble://C0:FF:EE:00:00:01 ble://C0:FF:EE:00:00:02 outputs/layout.json
"""

import sys
from itertools import islice

from lumitip import FingertipGroup

if len(sys.argv) <= 2:
    sys.exit(__doc__)

left, right, *layout = sys.argv[1:]
with FingertipGroup.open({"left": left, "right": right}, *layout) as group:
    for moment in islice(group.moments(timeout=5.0), 20):
        covered = [int((moment[name].values < 128).sum()) for name in ("left", "right")]
        print(f"{moment.t:.3f} s, {moment.spread_s * 1e3:4.1f} ms apart: {covered} cells covered")
