"""Entries for further grippers: what to measure, the answers, and what a STEP file shows."""
