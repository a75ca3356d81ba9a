"""Panels: copies of a finished board in a frame, held by tabs with mouse bites."""
