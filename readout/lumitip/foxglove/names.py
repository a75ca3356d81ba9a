"""Names that the file and the layout of its panels share."""

ROOT = "lumitip"
"""Frame in which the fingertips stand beside each other."""
