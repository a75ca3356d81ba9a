"""How the ground pour keeps away from things, shared by the pour and by the files that say so."""

THERMAL_GAP_MM = 0.25
"""Pour to a pad of its own net."""
THERMAL_SPOKE_MM = 0.3
"""Width of the bridges that join such a pad to the pour."""
MIN_WIDTH_MM = 0.2
"""The narrowest piece of pour."""
CLEARANCE_MM = 0.2
"""Pour to copper of other nets; more where a net class asks for more."""
LEAST_SPOKES = 1
"""Bridges that such a pad has at least: 0.3 mm of copper carry far more than any pad here needs."""
