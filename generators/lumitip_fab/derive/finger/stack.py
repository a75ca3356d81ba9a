"""Layers of a finger, rigid or compliant: thicknesses, printer limits, densities."""

import math

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.catalogue.materials import Laminate
from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Densities, Outline, Printing, Slicing, Stack

AUXILIARY_MM = 1.6  # of the boards outside compliant fingers


def is_flex(p: Parameters) -> bool:
    """Whether the plate bends."""
    return p.backing.variant == "flex"


def held_by(config: Input) -> Gripper:
    """The gripper with the offsets of this finger: a compliant finger leans farther in, and the
    pad of its interface moves it away from the bolts."""
    p = config.parameters
    gripper = config.parts.coupling.gripper
    if not is_flex(p):
        return gripper
    back, nose = p.flex.standoff_mm, gripper.nose
    moved = {
        "tilt_deg": gripper.tilt_deg + p.flex.lean_deg,
        "bolt_w_mm": gripper.bolt_w_mm + back,
        "block_back_w_mm": gripper.block_back_w_mm + back,
        "nose": nose and nose.model_copy(update={"front_w_mm": nose.front_w_mm + back}),
    }
    return gripper.model_copy(update=moved)


def behind_mm(p: Parameters) -> float:
    """From the board's front to the coupling's block."""
    return p.stack.pcb_mm + p.stack.floor_mm + (p.flex.pad_mm if is_flex(p) else 0.0)


def least_standoff_mm(config: Input) -> float:
    """Least `flex.standoff_mm`: board, plate and pad end before the nose of the gripper."""
    nose = config.parts.coupling.gripper.nose
    return behind_mm(config.parameters) - nose.front_w_mm if nose else 0.0


def roof_mm(config: Input) -> float:
    """How far the end of the pocket leans, so that it rises at 45° on the tilted print bed."""
    p = config.parameters
    slope = math.tan(math.radians(45 + held_by(config).tilt_deg))
    return 0.0 if is_flex(p) else slope * p.stack.pcb_mm


def stiff_mm(p: Parameters) -> float:
    """Thickness of the boards outside the fingers."""
    return AUXILIARY_MM if is_flex(p) else p.stack.pcb_mm


def foot_half_mm(config: Input, notch_half_mm: float) -> float:
    """Half the width of the part on the plate's back: the groove of an interface, whose legs run
    beside the notch, or the coupling's block."""
    p = config.parameters
    if is_flex(p):
        return notch_half_mm + p.printer.min_wall_mm + p.flex.groove_mm
    return config.parts.coupling.gripper.block_width_mm / 2


LEAST_SILICONE_MM = 0.3
STIFF_MM = (0.4, 3.2)  # boards that keep their shape
FLEXIBLE_MM = (0.11, 0.2)  # boards of polyimide with two copper layers
MOULD_ROOM_MM = 2.0  # gaps and draft of a mould beyond its walls
TROUGH_ROOM_MM = 5.0  # its trough at the gripper end


def mask_mm(config: Input) -> tuple[float, str]:
    """Thickness of the mask by its route, and what has it."""
    mask = config.parameters.mask
    if mask.route != "tpu":
        return config.parts.mask.film.thickness_mm, repr(mask.film)
    layer_mm = config.parts.printer.profile.layer_mm
    thick_mm = round(mask.layers * layer_mm, 6)
    return thick_mm, f"a sheet of mask.layers = {mask.layers} of {layer_mm:g} mm"


def derive_stack(config: Input, faults: Diagnostics) -> Stack:
    """The layers, refused where a part would stick out of the silicone or a floor is too thin."""
    p, parts = config.parameters, config.catalogue
    thick_mm, what = mask_mm(config)
    faults.unless(
        math.isclose(p.stack.film_mm, thick_mm), "film_differs", what=what, thick_mm=thick_mm
    )
    faults.unless(p.stack.floor_mm >= p.printer.min_wall_mm, "floor_thin")
    least, most = FLEXIBLE_MM if is_flex(p) else STIFF_MM
    faults.unless(least <= p.stack.pcb_mm <= most, "board_thickness", least=least, most=most)
    heights = {
        "emitter.led": parts.leds[p.emitter.led].body_mm[2],
        "receiver.photodetector": parts.photodetectors[p.receiver.photodetector].body_mm[2],
        "receiver.multiplexer": parts.multiplexers[p.receiver.multiplexer].body_mm[2],
    }
    if p.receiver.load == "each":
        heights["receiver.array"] = parts.resistor_arrays[p.receiver.array].body_mm[2]
    if config.parts.receiver.bulk_capacitor:
        heights["receiver.bulk_capacitor"] = config.parts.receiver.bulk_capacitor.body_mm[2]
    if p.emitter.resistor_side == "front":
        heights["emitter.resistor"] = parts.resistors[p.emitter.resistor].body_mm[2]
    if p.emitter.drive == "source":
        heights["emitter.source"] = config.parts.emitter.source.body_mm[2]
    for field, height in heights.items():
        left = p.stack.silicone_mm - height
        faults.unless(
            left >= LEAST_SILICONE_MM - 1e-9,
            "silicone_thin",
            left=left,
            height=height,
            least=height + LEAST_SILICONE_MM,
            beside=field,
        )
    return Stack(
        p.stack.floor_mm,
        p.stack.pcb_mm,
        p.stack.silicone_mm,
        p.stack.film_mm,
        sunk=not is_flex(p),
        auxiliary_mm=stiff_mm(p),
    )


def derive_printing(config: Input, outline: Outline, faults: Diagnostics) -> Printing:
    """Material and limits, refused where a part is larger than the bed."""
    p = config.parameters
    printer = config.parts.printer.profile
    faults.unless(p.tip.edge_mm >= printer.line_mm - 1e-9, "tip_edge_line", printer=printer)
    faults.unless(p.printer.min_wall_mm >= printer.line_mm, "wall_line", printer=printer)
    width = float(abs(outline.polygon()[:, 0]).max()) * 2 + 2 * p.mould.wall_mm + MOULD_ROOM_MM
    length = outline.length_mm + 3 * p.mould.wall_mm + MOULD_ROOM_MM + TROUGH_ROOM_MM
    bed = printer.bed_mm
    faults.unless(
        width <= bed[0] and length <= min(bed[1], bed[2]),
        "part_beyond_bed",
        width=width,
        length=length,
        bed_x=bed[0],
        bed_y=bed[1],
        bed_z=bed[2],
    )
    return Printing(
        p.backing.material,
        p.backing.density_g_ml,
        p.printer.min_wall_mm,
        p.printer.fit_mm,
        printer.line_mm,
        printer.layer_mm,
        printer.bed_mm,
        printer.bridge_mm,
    )


COPPER_G_ML = 8.96  # the element's, at 20 °C
POURED = 0.7
"""Share of both sides that copper covers: of the published receiver's board file, where the ground
pour alone covers 69 %."""


def derive_densities(config: Input, slicing: Slicing) -> Densities:
    """Densities of backing, interface, boards, the parts on them, silicone and mask."""
    p, parts = config.parameters, config.catalogue
    rigid, flexible = parts.laminates.rigid, parts.laminates.flexible
    return Densities(
        backing_g_ml=p.backing.density_g_ml,
        interface_g_ml=slicing.rigid.density_g_ml,
        board_g_ml=_clad_g_ml(flexible if is_flex(p) else rigid, p.stack.pcb_mm),
        auxiliary_g_ml=_clad_g_ml(rigid, stiff_mm(p)),
        part_g_ml=rigid.density_g_ml,
        silicone_g_ml=parts.silicones[p.mould.silicone].density_g_ml,
        film_g_ml=slicing.sheet.density_g_ml
        if p.mask.route == "tpu"
        else config.parts.mask.film.density_g_ml,
    )


def _clad_g_ml(laminate: Laminate, thick_mm: float) -> float:
    """Density of a board with copper on both sides, by its total thickness."""
    share = POURED * 2 * laminate.copper_mm / thick_mm
    return (1 - share) * laminate.density_g_ml + share * COPPER_G_ML
