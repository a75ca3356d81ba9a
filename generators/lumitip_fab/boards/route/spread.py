"""Tracks led apart where that costs little, so that more of them may be wide."""

import dataclasses

import numpy as np

from lumitip_fab.boards.route import stamps
from lumitip_fab.boards.route.obstacles import Wanted
from lumitip_fab.boards.route.trees import State

WIDE_MM = 0.25  # width that narrow tracks get where there is room
DEARER = 0.5  # length, in part of it, beside which only a narrow track has room


class Spread:
    """Where the copper of each net would be too near to wide tracks of the others."""

    def __init__(self, state: State, nets: list[Wanted]) -> None:
        self.state = state
        wide = tuple(
            dataclasses.replace(c, track_mm=max(c.track_mm, WIDE_MM)) for c in state.rules.classes
        )
        rules = dataclasses.replace(state.rules, classes=wide)
        pitch_mm = state.grid.pitch_mm
        self.tracks, self.vias = (rules.radii(pitch_mm, via=via) for via in (False, True))
        self.taken = np.zeros_like(state.taken)
        for net in nets:
            self.count(net, 1)

    def count(self, net: Wanted, add: int) -> None:
        """Put a net's copper on the map, or take it off."""
        state = self.state
        state.turn += 1
        stamps.stamp(
            state.paths(net),
            self.taken,
            state.marked,
            state.turn,
            add,
            net.neck,
            net.wide,
            state.rules.narrow,
            self.tracks,
            self.vias,
        )

    def weigh(self, net: Wanted) -> None:
        """Make places beside other nets dearer for a net that is off the map."""
        self.state.history[:] = DEARER * (self.taken[net.wide, :2] > 0)
