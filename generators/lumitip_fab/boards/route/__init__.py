"""Routing of two-layer boards by negotiated congestion."""

from lumitip_fab.boards.route.router import route

__all__ = ["route"]
