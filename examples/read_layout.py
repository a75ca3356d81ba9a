"""Print places and wiring of the cells of a built fingertip. Needs numpy alone.

python examples/read_layout.py outputs/layout.json
"""

import sys

from lumitip import Layout

if len(sys.argv) == 1:
    sys.exit(__doc__)

layout = Layout.load(sys.argv[1])
print(f"{len(layout)} cells {layout.pitch_mm} mm apart, design {layout.design_hash[:16]}")
for cell in layout.cells:
    print(
        f"{cell.index:4} x {cell.x_mm:8.3f} y {cell.y_mm:8.3f}  U{cell.mux + 1} input "
        f"{cell.channel:2} on {cell.adc_pin}"
    )
sizes = " to ".join(f"{size:g}" for size in sorted({layout.hole_mm.min(), layout.hole_mm.max()}))
print(f"{len(layout.neighbours)} pairs of neighbours, apertures of {sizes} mm")
