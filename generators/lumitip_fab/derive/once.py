"""Concrete parameters to `Design`: each quantity is derived once, here, and nowhere else."""

import hashlib
from dataclasses import dataclass, replace

import numpy as np

from lumitip.layout import Layout, Optics
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import boards
from lumitip_fab.derive.boards.breakout import derive_breakout
from lumitip_fab.derive.boards.feed import derive_feed
from lumitip_fab.derive.boards.flange import derive_flange
from lumitip_fab.derive.boards.packages import derive_fabs, derive_packages, derive_rules
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger import outline
from lumitip_fab.derive.finger.cells import Cells, derive_cells
from lumitip_fab.derive.finger.interface import derive_interfaces
from lumitip_fab.derive.finger.keys import derive_keys
from lumitip_fab.derive.finger.stack import (
    derive_densities,
    derive_printing,
    derive_stack,
)
from lumitip_fab.derive.finger.strength import Body, derive_strength
from lumitip_fab.derive.finger.tip import derive_tip
from lumitip_fab.derive.finger.tip_slots import refuse_lip
from lumitip_fab.derive.making import mask, mould
from lumitip_fab.derive.making.clamp import derive_clamps
from lumitip_fab.derive.making.consumables import derive_consumables
from lumitip_fab.derive.making.fit_plate import derive_fit_plate
from lumitip_fab.derive.making.gauge_card import derive_gauge_cards
from lumitip_fab.derive.making.heat import derive_heat
from lumitip_fab.derive.making.panels import derive_panels
from lumitip_fab.derive.making.printing import derive_slicing
from lumitip_fab.derive.making.purchase import derive_purchase
from lumitip_fab.derive.making.supplies import Assembled, derive_supplies
from lumitip_fab.derive.making.tolerances import known_mask_shift
from lumitip_fab.derive.mount import mount
from lumitip_fab.derive.mount.fasteners import derive_fasteners
from lumitip_fab.derive.mount.flange_body import derive_flange_body, derive_system
from lumitip_fab.derive.mount.holder import derive_holder
from lumitip_fab.derive.wiring import wiring
from lumitip_fab.derive.wiring.cabling import Boards, derive_cabling
from lumitip_fab.derive.wiring.electrical import derive_electrical
from lumitip_fab.derive.wiring.ratings import refuse_receiver_capacitor
from lumitip_fab.derive.wiring.strings import Strings, derive_strings
from lumitip_fab.design import Controller, Design, Grid, Mould, Stack, Title
from lumitip_fab.design.encoding import canonical, round_trip


@dataclass(frozen=True)
class FirstLayout:
    """Grid, parts and nets, and both boards of the fingers: all that the rest is built round."""

    cells: Cells
    strings: Strings
    muxing: wiring.Muxing
    plan: boards.Plan


def lay_out(config: Input, faults: Diagnostics) -> FirstLayout:
    """Place the boards' parts.

    Raises:
        InputError: with all that was collected, if there is no grid, or nothing to place on it.
    """
    cells = derive_cells(config.parameters, faults)
    if not len(cells):
        faults.stop()  # without a grid nothing else can be judged
    strings = derive_strings(config, cells, faults)
    muxing = wiring.derive_muxing(config, cells, faults)
    if not strings.cells or len(muxing.adc_pins) < muxing.muxes:
        faults.stop()  # without parts and nets there are no boards to place
    plan = boards.derive_plan(config, cells, strings, muxing, faults)
    return FirstLayout(cells, strings, muxing, plan)


def derive_body(
    config: Input, stack: Stack, plan: boards.Plan, faults: Diagnostics
) -> tuple[Body, Mould]:
    """What is built round the boards of the fingers and bears their load, and the mould."""
    silhouette = outline.derive_outline(config, plan.board, plan.receiver.notch, faults)
    interfaces = derive_interfaces(config, silhouette, plan.receiver, plan.board.box, faults)
    coupling = mount.derive_mount(config, silhouette, plan, faults)
    tip = derive_tip(config, silhouette, plan.board, stack, faults)
    casting = mould.derive_mould(config, silhouette, plan, stack, tip, faults)
    slicing = derive_slicing(config, casting, faults)
    meeting = mount.derive_closing(silhouette, stack, coupling, casting, faults)
    board, finger = plan.board, plan.receiver
    body = Body(stack, silhouette, tip, board, finger, coupling, interfaces, slicing, meeting)
    return body, casting


def derive_once(config: Input, faults: Diagnostics) -> Design:
    """Derive the whole sensor from values as they are.

    Args:
        config: the parameters, none of them automatic.
        faults: collects every impossible combination of values.

    Raises:
        InputError: with all that was collected.
    """
    p = config.parameters
    stack, fasteners = derive_stack(config, faults), derive_fasteners(config, faults)
    first = lay_out(config, faults)
    cells, strings, muxing, plan = first.cells, first.strings, first.muxing, first.plan
    body, casting = derive_body(config, stack, plan, faults)
    silhouette, coupling, slicing = body.outline, body.mount, body.slicing
    printing = derive_printing(config, silhouette, faults)
    plate = derive_fit_plate(config, plan, stack, coupling, faults)
    sheet = mask.derive_mask(config, silhouette, plan, faults)
    rules = derive_rules(config, faults)
    refuse_receiver_capacitor(config, faults)
    optics = optics_of(config)
    breakout = derive_breakout(config, strings, muxing, faults)
    holders = derive_holder(config, breakout, faults)
    flange = derive_flange(config, strings, muxing, faults)
    flanges = derive_flange_body(config, flange, faults)
    panels = derive_panels(config, plan.board.box, (*breakout, *flange), faults)
    circuit = wiring.build_wiring(config, strings, muxing)
    figures = derive_electrical(config, strings, muxing, circuit.pull_ups, faults)
    feed = derive_feed(config, faults)
    joints = Boards(plan.emitter, plan.receiver, (*breakout, *flange))
    cabling = derive_cabling(config, joints, silhouette, coupling, circuit, figures, faults)
    faults.stop()
    refuse_lip(config, silhouette, plan.board, stack, body.tip, faults)
    heat = derive_heat(config, slicing, casting, silhouette, figures, faults)
    strength = derive_strength(config, body, optics, faults)
    faults.stop()
    fingers = plan.emitter, plan.receiver
    keys = derive_keys(config, body, casting)
    clamps = derive_clamps(config, body, fingers, keys, casting, printing, cabling)
    cards = derive_gauge_cards(config, body, fingers, cells, casting, printing)
    assembled = Assembled(
        fingers,
        plan.board,
        stack,
        silhouette,
        body.interfaces,
        holders,
        joints.auxiliary_boards,
        cabling,
        coupling,
        clamps,
        casting.inserts,
        keys,
    )
    supplies = (*derive_supplies(config, assembled), *derive_consumables(config, assembled))
    mux, channel = wiring.assign(config, cells, plan.muxes)
    layout = Layout(
        x_mm=cells.x_mm,
        y_mm=cells.y_mm,
        column=cells.column,
        row=cells.row,
        neighbours=cells.neighbours,
        mux=mux,
        channel=channel,
        adc_pin=wiring.pins_of(mux, muxing.adc_pins),
        pitch_mm=p.grid.pitch_mm,
        optics=optics,
        hole_share=np.array(p.mask.holes_mm(len(cells))) / optics.hole_mm,
    )
    return round_trip(
        Design(
            title=Title(p.name, p.revision, p.date),
            grid=Grid(p.grid.columns, p.grid.pitch_mm),
            layout=layout,
            stack=stack,
            outline=silhouette,
            tip=body.tip,
            keys=keys,
            board=plan.board,
            emitter=plan.emitter,
            receiver=plan.receiver,
            interfaces=body.interfaces,
            mount=coupling,
            closing=body.closing,
            strength=strength,
            wiring=circuit,
            cabling=cabling,
            packages=derive_packages(config),
            rules=rules,
            electrical=figures,
            feed=feed,
            mask=replace(sheet, shift=known_mask_shift(config, layout)),
            mould=casting,
            clamps=clamps,
            gauge_cards=cards,
            printing=printing,
            heat=heat,
            slicing=slicing,
            fit_plate=plate,
            densities=derive_densities(config, slicing),
            controller=Controller(
                config.title("controller.board"),
                p.controller.name,
                config.parts.controller.board.adc_bits,
            ),
            fabs=derive_fabs(config),
            fasteners=fasteners,
            auxiliary_boards=(*breakout, *flange),
            panels=panels,
            holders=holders,
            flanges=flanges,
            system=derive_system(config, flanges, holders),
            purchase=derive_purchase(config, coupling, clamps, holders, flanges, supplies),
            parameters_hash=_parameters_hash(config),
            choices=(),
        )
    )


def optics_of(config: Input) -> Optics:
    """Apertures, dies and silicone of the cells."""
    p, parts = config.parameters, config.catalogue
    led = parts.leds[p.emitter.led]
    detector = parts.photodetectors[p.receiver.photodetector]
    return Optics(
        hole_mm=round(float(np.mean(p.mask.cell_holes_mm or p.mask.hole_mm)), 6),
        hole_shape="circle" if p.mask.route == "cut" else p.mask.hole_shape,
        emitter_depth_mm=p.stack.silicone_mm - led.die_height_mm,
        detector_depth_mm=p.stack.silicone_mm - detector.die_height_mm,
        emitter_exponent=led.exponent,
        detector_exponent=detector.exponent,
        silicone_index=parts.silicones[p.mould.silicone].refractive_index,
        film_mm=p.stack.film_mm,
        pull_up_ohm=p.receiver.pull_up_ohm,
        supply_v=parts.controllers[p.controller.board].supply_v,
    )


def _parameters_hash(config: Input) -> str:
    """SHA-256 of every value in force: the parameters and the parts that they name."""
    values = [
        config.parameters.model_dump(),
        {f: e.model_dump() for f, e in config.parts_by_field().items()},
    ]
    return hashlib.sha256(canonical(values).encode()).hexdigest()
