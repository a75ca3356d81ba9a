"""The proof: each module opens files in the output folder and holds them against the design.

A check module has `READS`, the patterns of the files that it opens, and `measure(outputs,
design)`, which yields a `Measurement` for each figure. It imports no generator.
"""
