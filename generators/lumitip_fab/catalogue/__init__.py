"""The catalogue of parts in `design/parts/*.toml`: what a parameter file names by name.

Every entry says where its figures come from (`source`) and how far to trust them
(`confidence`). Adding a part needs no Python.
"""

from collections.abc import Mapping

from lumitip_fab.catalogue import clamps, electronics, rectifiers
from lumitip_fab.catalogue import controllers as control
from lumitip_fab.catalogue import current_sources as sources
from lumitip_fab.catalogue.grippers import Gripper, ToolCoupling
from lumitip_fab.catalogue.materials import (
    Adhesive,
    Fastener,
    Filament,
    Film,
    Laminates,
    Primer,
    Printer,
    Silicone,
    Tape,
)
from lumitip_fab.catalogue.ordering import Fab, Pack, Prices
from lumitip_fab.catalogue.record import Name, Strict
from lumitip_fab.catalogue.tolerances import MaskShifts, Tolerances


class Catalogue(Strict):
    """All parts by kind and name."""

    leds: Mapping[Name, electronics.Led]
    photodetectors: Mapping[Name, electronics.Photodetector]
    resistors: Mapping[Name, electronics.Resistor]
    pulse_resistors: Mapping[Name, electronics.PulseResistor]
    resistor_arrays: Mapping[Name, electronics.ResistorArray]
    capacitors: Mapping[Name, electronics.Capacitor]
    multiplexers: Mapping[Name, electronics.Multiplexer]
    controllers: Mapping[Name, control.Controller]
    strips: Mapping[Name, control.Strip]
    regulators: Mapping[Name, control.Regulator]
    linear_regulators: Mapping[Name, control.LinearRegulator]
    current_sources: Mapping[Name, sources.CurrentSource]
    crystals: Mapping[Name, electronics.Crystal]
    inductors: Mapping[Name, electronics.Inductor]
    fuses: Mapping[Name, electronics.Fuse]
    transistors: Mapping[Name, control.Transistor]
    tvs_diodes: Mapping[Name, clamps.TvsDiode]
    esd_diodes: Mapping[Name, clamps.EsdDiode]
    schottky_diodes: Mapping[Name, rectifiers.SchottkyDiode]
    indicators: Mapping[Name, electronics.Indicator]
    couplings: Mapping[Name, ToolCoupling]
    grippers: Mapping[Name, Gripper]
    fasteners: Mapping[Name, Fastener]
    adhesives: Mapping[Name, Adhesive]
    silicones: Mapping[Name, Silicone]
    primers: Mapping[Name, Primer]
    tapes: Mapping[Name, Tape]
    films: Mapping[Name, Film]
    printers: Mapping[Name, Printer]
    filaments: Mapping[Name, Filament]
    fabs: Mapping[Name, Fab]
    packs: Mapping[Name, Pack]
    laminates: Laminates
    prices: Prices
    tolerances: Tolerances
    mask_shifts: MaskShifts
