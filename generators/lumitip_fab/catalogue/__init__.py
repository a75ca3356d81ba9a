"""The catalogue of parts in `design/parts/*.toml`: what a parameter file names by name.

Every entry says where its figures come from (`source`) and how far to trust them
(`confidence`). Adding a part needs no Python.
"""

from collections.abc import Mapping

from lumitip_fab.catalogue.controllers import (
    Controller,
    LinearRegulator,
    Regulator,
    Strip,
    Transistor,
)
from lumitip_fab.catalogue.current_sources import CurrentSource
from lumitip_fab.catalogue.electronics import (
    Capacitor,
    Crystal,
    Fuse,
    Indicator,
    Inductor,
    Led,
    Multiplexer,
    Photodetector,
    PulseResistor,
    Resistor,
    ResistorArray,
    TvsDiode,
)
from lumitip_fab.catalogue.grippers import Gripper, ToolCoupling
from lumitip_fab.catalogue.materials import Fastener, Filament, Film, Laminates, Printer, Silicone
from lumitip_fab.catalogue.ordering import Fab, Prices
from lumitip_fab.catalogue.record import Name, Strict


class Catalogue(Strict):
    """All parts by kind and name."""

    leds: Mapping[Name, Led]
    photodetectors: Mapping[Name, Photodetector]
    resistors: Mapping[Name, Resistor]
    pulse_resistors: Mapping[Name, PulseResistor]
    resistor_arrays: Mapping[Name, ResistorArray]
    capacitors: Mapping[Name, Capacitor]
    multiplexers: Mapping[Name, Multiplexer]
    controllers: Mapping[Name, Controller]
    strips: Mapping[Name, Strip]
    regulators: Mapping[Name, Regulator]
    linear_regulators: Mapping[Name, LinearRegulator]
    current_sources: Mapping[Name, CurrentSource]
    crystals: Mapping[Name, Crystal]
    inductors: Mapping[Name, Inductor]
    fuses: Mapping[Name, Fuse]
    transistors: Mapping[Name, Transistor]
    tvs_diodes: Mapping[Name, TvsDiode]
    indicators: Mapping[Name, Indicator]
    couplings: Mapping[Name, ToolCoupling]
    grippers: Mapping[Name, Gripper]
    fasteners: Mapping[Name, Fastener]
    silicones: Mapping[Name, Silicone]
    films: Mapping[Name, Film]
    printers: Mapping[Name, Printer]
    filaments: Mapping[Name, Filament]
    fabs: Mapping[Name, Fab]
    laminates: Laminates
    prices: Prices
