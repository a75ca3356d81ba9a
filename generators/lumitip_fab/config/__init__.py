"""The parameter file: its fields, how it is read, and how its faults are reported."""
