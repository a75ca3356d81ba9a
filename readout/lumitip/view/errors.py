"""What goes wrong in the live view."""

from lumitip.errors import LumitipError


class ViewError(LumitipError):
    """Something that the live view cannot do."""
