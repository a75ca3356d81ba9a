"""What can go wrong with a recording."""

from lumitip.errors import LumitipError


class RecordingError(LumitipError):
    """A file that cannot be written, or is no recording that this version reads."""


class DamagedError(RecordingError):
    """A recording that ends too early or has holes; `lumitip recover` saves the rest."""
