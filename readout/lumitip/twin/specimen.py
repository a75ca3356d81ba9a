"""`PUBLISHED_GAINS`: unevenness of the published sensor's cells, `Twin(layout, gains=…)`.

Level of trust: inferred. The publication does not state them. They are the gains that the twin
needs to come closest to its three frames (cloth edge, cloth corner, cable), with a prior of
1 ± 0.04 each, so true gains may lie further from 1. `benchmarks/bench_real_misfit.py` prints them;
learned from two of the frames they lower the misfit of the third, whichever it is. They belong to
that one specimen: another fingertip has others, which `lumitip.estimation.learn` finds.
"""

# fmt: off
PUBLISHED_GAINS = (
    1.02, 1.02, 1.02, 1.00, 1.04,
    1.00, 1.02, 1.01, 0.95,
    1.00, 1.00, 1.00, 1.02, 0.99,
    0.98, 1.02, 0.98, 0.99,
    1.00, 1.02, 1.00, 1.02, 0.93,
    0.98, 0.98, 1.01, 1.01,
    0.98, 1.01, 1.02, 0.99, 1.00,
)
"""Light of each cell relative to its calibrated empty grasp, one column of cells a line, row 0
nearest the tip."""
# fmt: on
