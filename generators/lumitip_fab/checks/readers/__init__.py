"""Readers of the files in an output folder, one for each format."""
