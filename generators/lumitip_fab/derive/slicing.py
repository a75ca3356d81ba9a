"""Which filament each part is printed from, and in which layers."""

from dataclasses import replace

from lumitip_fab.derive.faults import Faults
from lumitip_fab.design import Mould
from lumitip_fab.design.slicing import Filament, Slicing
from lumitip_fab.load import Input


def derive_slicing(given: Input, mould: Mould, faults: Faults) -> Slicing:
    """Settings of the backing's filament, with the density of the spool at hand, of the one that
    everything else is printed from, and of that one in the mould's layers."""
    p, known = given.parameters, given.catalogue.filaments
    name = p.backing.material
    other = known[name].rigid_parts or name
    good = other in known and known[other].rigid_parts is None
    faults.refuse_unless(
        good,
        "backing.material",
        f"{name!r} given, whose rigid_parts {other!r} is no filament of parts/filaments.toml "
        "that does without rigid_parts",
    )
    rigid = other if good else name
    density = p.backing.density_g_ml
    printer = given.catalogue.printers[p.printer.profile]
    rest = _filament(given, rigid, density if rigid == name else known[rigid].density_g_ml)
    return Slicing(
        printer.nozzle_mm,
        _filament(given, name, density),
        rest,
        rest
        if mould.layer_mm == printer.layer_mm
        else replace(rest, layer_mm=mould.layer_mm, part="mould"),
    )


def _filament(given: Input, name: str, density_g_ml: float) -> Filament:
    told = given.catalogue.filaments[name]
    return Filament(
        name, told.kind, density_g_ml, told.nozzle_c, told.bed_c, told.fan_percent,
        told.speed_mm_s, told.max_flow_mm3_s, told.retract_mm, told.layer_mpa, told.bearing_mpa,
        given.catalogue.printers[given.parameters.printer.profile].layer_mm,
    )  # fmt: skip
