"""The exceptions of the robot side, all under one root."""


class LumitipError(Exception):
    """Root of every error that `lumitip` raises on purpose."""


class LayoutError(LumitipError, ValueError):
    """A `layout.json` that cannot be used: the message names the field, what was given and
    what is allowed."""
