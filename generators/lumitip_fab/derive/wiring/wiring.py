"""Multiplexers, channels and pins of the cells, and all wiring beyond the layout."""

import math
from dataclasses import dataclass

import lap
import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Integers
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import Cells
from lumitip_fab.derive.wiring.ratings import sold_ohm
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.design import Point, Wiring

PULL_DOWN_OHM = 100e3
"""At the gate of the LEDs' switch: they are off while the controller starts."""


@dataclass(frozen=True)
class Muxing:
    """Number of multiplexers, and their pins."""

    muxes: int
    adc_pins: tuple[str, ...]
    select_pins: tuple[str, ...]


def larger_multiplexers(config: Input) -> str:
    """Multiplexers of the catalogue with more inputs, for the middle of a sentence; empty where
    there are none."""
    channels = config.parts.receiver.multiplexer.channels
    names = [n for n, m in config.catalogue.multiplexers.items() if m.channels > channels]
    return f"{' or '.join(map(repr, names))} with more inputs, " if names else ""


def _unlimited(config: Input) -> str:
    """Controllers of the catalogue without a limit of analog pins, as in a parameter file."""
    entries = config.catalogue.controllers.items()
    names = [name for name, entry in entries if entry.unlimited_analog_pins]
    return " or ".join(f"controller.board = {name!r}" for name in names) or "another controller"


def derive_muxing(config: Input, cells: Cells, faults: Diagnostics) -> Muxing:
    """The fewest multiplexers for all detectors, each on its own analog pin."""
    p = config.parameters
    mux = config.parts.receiver.multiplexer
    controller = config.parts.controller.board
    muxes = math.ceil(len(cells) / mux.channels)
    pins = controller.inputs
    if controller.unlimited_analog_pins:
        pins = tuple(f"A{i}" for i in range(muxes))
    faults.unless(
        muxes <= len(pins),
        "analog_pins",
        cells_count=len(cells),
        muxes=muxes,
        mux=mux,
        pins_count=len(pins),
        cells=mux.channels * len(pins),
        larger=larger_multiplexers(config),
        unlimited=_unlimited(config),
    )
    faults.unless(
        len(mux.select) <= len(controller.select_pins),
        "select_lines",
        select_count=len(mux.select),
        select_pins_count=len(controller.select_pins),
    )
    sold = sold_ohm(p.receiver.pull_up_ohm)
    faults.unless(math.isclose(sold, p.receiver.pull_up_ohm), "pull_up_not_sold", sold=sold)
    return Muxing(muxes, pins[:muxes], controller.select_pins[: len(mux.select)])


def assign(config: Input, cells: Cells, places: tuple[Point, ...]) -> tuple[Integers, Integers]:
    """Multiplexer and channel of each cell, by nearness so that tracks are short.

    Args:
        config: the input.
        cells: the cells.
        places: centre of each multiplexer, U1 first.

    Returns:
        Multiplexer and channel, each of shape `(cells,)`.
    """
    mux, channel = (np.zeros(len(cells), dtype=np.int64) for _ in range(2))
    leads = _input_leads(config)
    left_to_right = sorted(range(len(places)), key=lambda i: (places[i][0], -places[i][1]))
    groups = np.array_split(np.arange(len(cells)), len(places))
    for which, group in zip(left_to_right, groups, strict=True):
        at = np.array(places[which]) + leads
        here = np.stack([cells.x_mm[group], cells.y_mm[group]], axis=1)
        cost = np.round(np.linalg.norm(here[:, None] - at[None], axis=2), 6)
        # Among equally short wirings, the one in which channels follow the cells' order.
        cost += 1e-6 * np.outer(np.arange(group.size)[::-1], np.arange(len(leads)))
        taken, inputs = lap.lapjvx(cost, extend_cost=True, return_cost=False)
        mux[group[taken]], channel[group[taken]] = which, inputs
    return mux, channel


def pins_of(mux: Integers, adc_pins: tuple[str, ...]) -> NDArray[np.str_]:
    """The analog pin that reads each cell, shape `(cells,)`."""
    return np.array(adc_pins)[mux]


def build_wiring(config: Input, strings: Strings, muxing: Muxing) -> Wiring:
    """All wiring beyond the layout."""
    p = config.parameters
    return Wiring(
        multiplexer=p.receiver.multiplexer,
        muxes=muxing.muxes,
        select_pins=muxing.select_pins,
        adc_pins=muxing.adc_pins,
        apart=p.wiring.order == "apart",
        pulled_up_ohm=tuple(
            (pin, ohm)
            for pin, ohm in config.parts.controller.board.pulled_up_ohm.items()
            if pin in muxing.adc_pins
        ),
        strings=strings.cells,
        resistor=p.emitter.resistor,
        resistor_ohm=strings.resistor_ohm,
        set_ohm=strings.set_ohm,
        current_ma=strings.current_ma,
        supply_v=p.supply.voltage_v,
        pull_up_ohm=p.receiver.pull_up_ohm,
        own_pull_ups=p.receiver.load == "each",
        pull_ups=sum(p.grid.columns) if p.receiver.load == "each" else muxing.muxes,
        emitter_pin=config.parts.controller.board.emitter_pin
        if config.parts.emitter.switch
        else None,
        pull_down_ohm=PULL_DOWN_OHM,
    )


def _input_leads(config: Input) -> NDArray[np.float64]:
    """Place of each input's lead about the multiplexer's centre, by channel, shape `(n, 2)`.

    The package lies with its rows of leads facing the cells and the connector:

        16 15 14 … 9      towards the cells
        |O           |
         1  2  3 … 8      towards the connector
    """
    mux = config.parts.receiver.multiplexer
    row = mux.leads // 2
    places = []
    for channel in range(mux.channels):
        lead = mux.inputs[str(channel)]
        along = (lead - 1 if lead <= row else mux.leads - lead) - (row - 1) / 2
        side = -1 if lead <= row else 1
        places.append((along * mux.lead_pitch_mm, side * mux.lead_span_mm / 2))
    return np.array(places)
