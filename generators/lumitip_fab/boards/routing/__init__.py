"""Routing of two-layer boards by negotiated congestion."""

from lumitip_fab.boards.routing.router import route

__all__ = ["route"]
