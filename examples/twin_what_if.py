"""Sharpness of an edge at other gaps and holes, before a mask is printed.

python examples/twin_what_if.py outputs/layout.json
"""

import sys

import numpy as np

from lumitip import Layout
from lumitip.twin import Model, Twin

if len(sys.argv) == 1:
    sys.exit(__doc__)

layout = Layout.load(sys.argv[1])
way = np.linspace(-25.0, 25.0, 1001)
for gap_mm in (2.0, 3.0, 6.0):
    for hole_mm in (1.5, 2.5, 3.5):
        twin = Twin(layout, Model.from_layout(layout, gap_mm, hole_mm=hole_mm))
        share = twin.edges(-way, 0.0) / 255.0
        widths = [np.diff(np.interp([0.1, 0.9], cell, way))[0] for cell in share.T]
        print(f"gap {gap_mm} mm, hole {hole_mm} mm: 10 to 90 % in {np.mean(widths):.1f} mm")
