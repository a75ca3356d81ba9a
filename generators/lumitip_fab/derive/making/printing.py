"""Filaments and layers of the printed parts."""

from dataclasses import replace

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.design import Mould, Slicing
from lumitip_fab.design.making import Filament


def derive_slicing(config: Input, mould: Mould, faults: Diagnostics) -> Slicing:
    """Settings of the backing's filament, with the density of the spool at hand, of the one that
    everything else is printed from, of that one in the mould's layers, and of the mask's sheet."""
    p, known = config.parameters, config.catalogue.filaments
    name = p.backing.material
    other = known[name].rigid_parts or name
    good = other in known and known[other].rigid_parts is None
    faults.unless(good, "rigid_parts", name=name, other=other)
    bends = known[name].rigid_parts is not None
    faults.unless(
        bends == is_flex(p),
        "material_bends",
        name=name,
        kind="bends" if bends else "does not bend",
        needed="does not" if bends else "does",
    )
    rigid = other if good else name
    density = p.backing.density_g_ml
    printer = config.parts.printer.profile
    rest = _filament(config, rigid, density if rigid == name else known[rigid].density_g_ml)
    return Slicing(
        printer.nozzle_mm,
        _filament(config, name, density),
        rest,
        rest
        if mould.layer_mm == printer.layer_mm
        else replace(rest, layer_mm=mould.layer_mm, part="mould"),
        replace(
            _filament(config, p.mask.filament, config.parts.mask.filament.density_g_ml), part="mask"
        ),
    )


def _filament(config: Input, name: str, density_g_ml: float) -> Filament:
    entry = config.catalogue.filaments[name]
    return Filament(
        name,
        entry.kind,
        density_g_ml,
        entry.nozzle_c,
        entry.bed_c,
        entry.fan_percent,
        entry.speed_mm_s,
        entry.max_flow_mm3_s,
        entry.retract_mm,
        entry.layer_mpa,
        entry.layer_mpa if entry.plane_mpa is None else entry.plane_mpa,
        entry.bearing_mpa,
        config.parts.printer.profile.layer_mm,
    )
