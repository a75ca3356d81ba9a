"""The ground pour of both sides."""

from lumitip_fab.boards.pour.flood import pour

__all__ = ["pour"]
