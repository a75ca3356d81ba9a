"""The bill of materials of the whole sensor, counted in the files that were built."""
