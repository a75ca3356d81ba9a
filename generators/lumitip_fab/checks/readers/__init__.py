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
"""Exceptions of the libraries when they read damaged files."""
