"""Settings for the slicer."""
