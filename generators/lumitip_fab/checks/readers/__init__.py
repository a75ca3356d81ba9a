"""Readers of the files in an output folder, one for each format."""

MALFORMED = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    ArithmeticError,
    StopIteration,
    RuntimeError,
)
"""What readers raise on damaged files, beside their own exceptions."""
