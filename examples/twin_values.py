"""Values that a fingertip would read from a cable, an edge and a corner, before it is built.

python examples/twin_values.py outputs/layout.json
"""

import sys

from lumitip import Layout
from lumitip.processing import Processor
from lumitip.twin import Cable, Corner, HalfPlane, Twin

if len(sys.argv) == 1:
    sys.exit(__doc__)

layout = Layout.load(sys.argv[1])
twin, process = Twin(layout), Processor(layout)
for scene in (Cable(1.0, 20.0, diameter_mm=4.0), HalfPlane(2.0, 195.0), Corner(0.0, 3.0, -60.0)):
    values = twin.values(scene)
    print(f"{type(scene).__name__:<10} read as {process(values).shape:<7} {values.round()}")
