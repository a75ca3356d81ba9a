"""The catalogue entries that the parameters name, under the same sections and fields."""

from dataclasses import dataclass, fields
from typing import Any, get_args, get_type_hints

from lumitip_fab.catalogue import (
    Catalogue,
    clamps,
    controllers,
    current_sources,
    electronics,
    rectifiers,
)
from lumitip_fab.catalogue.grippers import Gripper, ToolCoupling
from lumitip_fab.catalogue.materials import (
    Adhesive,
    Fastener,
    Filament,
    Film,
    Primer,
    Printer,
    Silicone,
    Tape,
)
from lumitip_fab.config.parameters import Parameters


@dataclass(frozen=True)
class EmitterParts:
    """Parts of the emitter's board."""

    led: electronics.Led
    source: current_sources.CurrentSource
    resistor: electronics.Resistor
    switch: controllers.Transistor | None


@dataclass(frozen=True)
class ReceiverParts:
    """Parts of the receiver's board."""

    photodetector: electronics.Photodetector
    array: electronics.ResistorArray
    resistor: electronics.Resistor
    capacitor: electronics.Capacitor
    bulk_capacitor: electronics.Capacitor | None
    multiplexer: electronics.Multiplexer


@dataclass(frozen=True)
class BackingParts:
    """Materials of the backing."""

    material: Filament
    glue: Adhesive


@dataclass(frozen=True)
class ControllerParts:
    """The microcontroller board."""

    board: controllers.Controller


@dataclass(frozen=True)
class ProtectionParts:
    """Parts between the controller's pins and the wires."""

    diode: clamps.EsdDiode | None
    resistor: electronics.Resistor
    capacitor: electronics.Capacitor | None


@dataclass(frozen=True)
class BreakoutParts:
    """Parts of the breakout board."""

    socket: controllers.Strip
    indicator: electronics.Indicator | None
    feed_diode: rectifiers.SchottkyDiode | None


@dataclass(frozen=True)
class FlangeParts:
    """Parts of the flange and its board."""

    coupling: ToolCoupling
    contacts: controllers.Strip
    header: controllers.Strip
    regulator: controllers.Regulator
    inductor: electronics.Inductor
    input_capacitor: electronics.Capacitor
    output_capacitor: electronics.Capacitor
    boot_capacitor: electronics.Capacitor
    fuse: electronics.Fuse
    transistor: controllers.Transistor
    resistor: electronics.Resistor
    tvs: clamps.TvsDiode
    inrush_resistor: electronics.PulseResistor
    indicator: electronics.Indicator | None


@dataclass(frozen=True)
class ModuleParts:
    """Parts beside a controller that is soldered to the flange's board."""

    regulator: controllers.LinearRegulator
    supply_capacitor: electronics.Capacitor
    capacitor: electronics.Capacitor
    crystal: electronics.Crystal
    crystal_capacitor: electronics.Capacitor


@dataclass(frozen=True)
class CouplingParts:
    """The gripper."""

    gripper: Gripper


@dataclass(frozen=True)
class HolderParts:
    """Screws of the holder."""

    screw: Fastener


@dataclass(frozen=True)
class MouldParts:
    """Material that is cast, and what is needed for it."""

    silicone: Silicone
    primer: Primer | None
    tape: Tape
    insert: Film | None


@dataclass(frozen=True)
class MaskParts:
    """Materials of the mask."""

    film: Film
    filament: Filament


@dataclass(frozen=True)
class PrinterParts:
    """The printer."""

    profile: Printer


@dataclass(frozen=True)
class Parts:
    """Every named entry."""

    emitter: EmitterParts
    receiver: ReceiverParts
    backing: BackingParts
    controller: ControllerParts
    protection: ProtectionParts
    breakout: BreakoutParts
    flange: FlangeParts
    module: ModuleParts
    coupling: CouplingParts
    holder: HolderParts
    mould: MouldParts
    mask: MaskParts
    printer: PrinterParts


_SECTIONS: dict[str, Any] = get_type_hints(Parts)
_KINDS = {
    get_args(hint)[1]: kind for kind, hint in get_type_hints(Catalogue).items() if get_args(hint)
}
_HINTS = {
    f"{section}.{field}": get_args(hint) or (hint,)
    for section, parts in _SECTIONS.items()
    for field, hint in get_type_hints(parts).items()
}
NAMED: dict[str, str] = {field: _KINDS[records[0]] for field, records in _HINTS.items()}
"""Fields that name an entry, and the catalogue file that it is in."""
NONE = "none"
OPTIONAL = frozenset(field for field, records in _HINTS.items() if type(None) in records)
"""Those of them that may be `"none"`."""


def names_for(field: str, catalogue: Catalogue) -> tuple[str, ...]:
    """Values that a field in `NAMED` may have."""
    return (*getattr(catalogue, NAMED[field]), *((NONE,) if field in OPTIONAL else ()))


def named_parts(parameters: Parameters, catalogue: Catalogue) -> Parts:
    """Look up every entry that the parameters name."""

    def entry(field: str, name: str) -> Any:
        if name == NONE and field in OPTIONAL:
            return None
        return getattr(catalogue, NAMED[field])[name]

    def section(name: str) -> Any:
        values = getattr(parameters, name)
        return _SECTIONS[name](
            **{
                field.name: entry(f"{name}.{field.name}", getattr(values, field.name))
                for field in fields(_SECTIONS[name])
            }
        )

    return Parts(**{name: section(name) for name in _SECTIONS})
