"""The drawings of the manual's steps, from the parts as they were written."""

import io
import math

import numpy as np
import trimesh

from lumitip_fab.design import Box, Design, Finger, Flange, Insert, Mould, Point, frames
from lumitip_fab.parts.export import mesh
from lumitip_fab.parts.gauge import gauge_solid
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.scenes.bench_views import WiredBoard, drop_view, facing_view
from lumitip_fab.scenes.card_view import card_view
from lumitip_fab.scenes.casting_page import Cast
from lumitip_fab.scenes.casting_parts import nuts_of, screws_of, wires_of
from lumitip_fab.scenes.casting_views import filled_view, lifted_view, lowered_view
from lumitip_fab.scenes.clamped_view import clamped_view
from lumitip_fab.scenes.contacts_view import contacts_view
from lumitip_fab.scenes.coupling_view import THREAD, coupling_view
from lumitip_fab.scenes.finger_views import board_view, cable_view, folded_view
from lumitip_fab.scenes.flange_view import flange_view
from lumitip_fab.scenes.gauge_view import gauge_view
from lumitip_fab.scenes.glb import Group
from lumitip_fab.scenes.holder_view import holder_view
from lumitip_fab.scenes.lengths_view import lengths_view
from lumitip_fab.scenes.marks_view import marks_view
from lumitip_fab.scenes.mould_view import mould_view
from lumitip_fab.scenes.plate_view import plate_view
from lumitip_fab.scenes.skin_view import skin_view
from lumitip_fab.scenes.system import finger_group, stl_mesh

OFF_MM = 3.5  # from keys and stops to where a drop of silicone is tried


def work_views(design: Design, files: Files) -> tuple[Artefact, ...]:
    """A drawing of each step of the work that a picture explains. Where both fingers are made alike
    the emitter is drawn; the receiver for the wires, of which it has more."""
    scene = trimesh.load(io.BytesIO(files.read("assembly/assembly.glb")), file_type="glb")
    groups = {f.name: finger_group(scene, f, np.eye(4)) for f in design.fingers}
    layers = {name: _layers(group) for name, group in groups.items()}
    finger, wired = design.emitter, design.receiver
    cast = _cast(design, finger, layers[finger.name], files)
    clamp = design.clamps[0] if design.clamps else None
    boards = {f.name: _wired(design, f, layers[f.name], groups[f.name]) for f in design.fingers}
    drawings = {
        "measured": _measured(design),
        "lengths": lengths_view(design.cabling),
        "card": card_view(wired, layers[wired.name], design.mask.holes_mm),
        "skin": skin_view(finger, design.board, design.keys, layers[finger.name]),
        "facing": facing_view(boards[finger.name], boards[wired.name]),
        "plate": plate_view(stl_mesh(files, "fit/fit_plate.stl"), design.fit_plate),
        "board": board_view(finger, layers[finger.name], boards[finger.name].parts),
        "mould": mould_view(cast.mould, design.outline, design.board, design.mould, design.clamps),
        "drop": drop_view(layers[finger.name], bare_spot(design), design.stack),
        "cable": cable_view(
            wired, layers[wired.name], _colours(design, wired), design.mount, design.stack
        ),
        "filled": filled_view(cast),
        "lowered": lowered_view(cast),
        "clamped": clamped_view(cast, clamp, _clamp(design, files), nuts_of(design.clamps)),
        "lifted": lifted_view(cast),
    }
    if design.packages.unmarked:
        drawings["marks"] = marks_view(design.packages)
    for card in design.gauge_cards:
        printed = stl_mesh(files, f"gauge/{card.name}.stl")
        drawings["gauge"] = gauge_view(card, design.outline, printed, layers[wired.name])
    for holder in design.holders:
        printed = stl_mesh(files, f"holder/{holder.name}.stl")
        drawings["holder"] = holder_view(holder, printed)
    for flange in design.flanges:
        drawings |= {flange.name: _flange(design, flange, files), "contacts": contacts_view(flange)}
    for name, seen in layers.items():
        flaps = files.facts(f"mask/{name}_mask.svg")["flaps"]
        drawings[f"{name}_folded"] = folded_view(seen, flaps, _lip_y(design))
    return tuple(
        Artefact(f"manual/{name}.svg", drawing.encode(), frame="")
        for name, drawing in drawings.items()
    )


def _measured(design: Design) -> str:
    """The foot of a finger, with the figures of the gripper's entry that are not sure."""
    asked = design.mount.to_measure
    shown = {figure.name for figure in asked} | {name for f in asked for name, _ in f.others}
    return coupling_view(design.mount, mesh(gauge_solid(design)), {THREAD, *shown})


def _flange(design: Design, flange: Flange, files: Files) -> str:
    """The flange's parts as they were written."""
    printed = {
        part: stl_mesh(files, f"flange/{flange.name}_{part}.stl")
        for part in frames.flange_beds(flange)
    }
    (auxiliary,) = (b for b in design.auxiliary_boards if b.name == flange.auxiliary)
    plugged = {
        wire.end.connector: cable.name
        for cable in design.cabling.cables
        for wire in cable.wires
        if wire.end.board == flange.auxiliary
    }
    return flange_view(flange, printed, auxiliary, design.stack, design.system, plugged)


def _lip_y(design: Design) -> float | None:
    """Where the silicone ends on the back of the tip, if it is wrapped round it."""
    if not design.props:
        return None
    return design.outline.tip_y_mm - design.mould.lip_length_mm(design.outline, design.tip)


def _layers(group: Group) -> dict[str, Mesh]:
    """Bodies of a finger by the last part of their names."""
    return {body.name.rpartition(".")[2]: body.mesh for body in group.bodies}


def _front(group: Group, finger: Finger) -> list[Mesh]:
    """Parts on the board's front."""
    front = {finger.body_name(part) for part in finger.parts if part.side == "front"}
    return [body.mesh for body in group.bodies if body.name in front]


def _wired(design: Design, finger: Finger, layers: dict[str, Mesh], group: Group) -> WiredBoard:
    pads, colours = finger.connector.pads, _colours(design, finger)
    return WiredBoard(layers["board"], _front(group, finger), pads, colours)


def _cast(design: Design, finger: Finger, layers: dict[str, Mesh], files: Files) -> Cast:
    to_bed, mould = _to_bed(design), stl_mesh(files, f"mould/{finger.name}_mould.stl")
    colours = _colours(design, finger)
    return Cast(
        mould,
        {
            name: layers[name].moved(to_bed)
            for name in ("interface", "backing", "board", "silicone")
            if name in layers
        },
        design.mould.stops_mm(design.stack.cover_mm),
        -design.outline.tip_y_mm,
        tuple(_laid(design.mould, insert) for insert in design.mould.inserts),
        _prop(design, files),
        design.mould.level_slope,
        screws_of(design.clamps),
        wires_of(finger, colours, to_bed, mould, design),
    )


def _prop(design: Design, files: Files) -> Mesh | None:
    """The prop as it stands under a mould, in the frame of the mould's bed."""
    for prop in design.props:
        edge = frames.translation(0.0, -prop.plate.y_max_mm, 0.0)
        lower = frames.translation(0.0, 0.0, -prop.height_mm)
        turn = edge @ frames.rotation_x(-prop.tilt_deg) @ np.linalg.inv(edge)
        return stl_mesh(files, prop.file).moved(turn @ lower)
    return None


def _laid(mould: Mould, insert: Insert) -> Box:
    """A film on the floor, along the mould and up from its bed; the mould's y is -y."""
    box = insert.box
    return Box(-box.y_max_mm, -box.y_min_mm, mould.floor_mm - insert.thickness_mm, mould.floor_mm)


def bare_spot(design: Design) -> Point:
    """Place of the trial drop: across the glue round a board in its pocket, else beside it; off
    keys and the mould's stops, as far out as there is room."""
    box, outline = design.board.box, design.outline
    taken = [key.at for key in design.keys] + list(design.mould.pads)
    found = []
    for y in np.linspace(box.y_min_mm, box.y_max_mm, 81).tolist():
        x = (box.x_max_mm + outline.half_width_at(y)) / 2
        at = (box.x_max_mm, y) if design.stack.sunk else (x, y)
        off = min(math.dist(at, other) for other in taken)
        found.append((min(off, OFF_MM), x, *at))
    return max(found)[2:]


def _to_bed(design: Design) -> frames.Matrix:
    """From the sensor frame to the bed of the mould."""
    bed = frames.mould_bed_to_sensor(design.stack, design.mould)
    return np.asarray(np.linalg.inv(bed), np.float64)


def _clamp(design: Design, files: Files) -> Mesh | None:
    """The printed clamp where it lies on the finger in the mould."""
    for clamp in design.clamps:
        lies = _to_bed(design) @ frames.clamp_bed_to_sensor(design.stack, clamp)
        return stl_mesh(files, clamp.file).moved(lies)
    return None


def _colours(design: Design, finger: Finger) -> list[str]:
    """Colours of a finger's wires, in the order of its pads."""
    ends = {
        end.order: wire.colour
        for cable in design.cabling.cables
        for wire in cable.wires
        for end in (wire.start, wire.end)
        if end.board == finger.name
    }
    return [ends[order] for order in sorted(ends)]
