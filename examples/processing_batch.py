"""Compute thresholds, dark centres and markers of a whole recording at once.

python examples/processing_batch.py run.mcap
"""

import sys

import numpy as np

from lumitip.processing import Processor
from lumitip.recording import Reader

if len(sys.argv) == 1:
    sys.exit(__doc__)

recording = Reader(sys.argv[1])
values = np.array([recording.metadata.values(frame) for frame in recording])
batch = Processor(recording.layout).batch(values)
touched = ~np.isnan(batch.thresholds)
print(f"{len(values)} frames, {touched.sum()} with contact, {batch.counts.max()} markers at most")
if touched.any():
    left, bottom = batch.centres_mm[touched].min(axis=0)
    right, top = batch.centres_mm[touched].max(axis=0)
    print(f"dark centre x {left:.1f} to {right:.1f} mm, y {bottom:.1f} to {top:.1f} mm")
