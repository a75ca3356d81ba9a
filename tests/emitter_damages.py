"""Damages of the emitter's board file, each with the checks that must fail."""

from collections.abc import Callable

from board_damages import (
    TIE_DAMAGES,
    in_part,
    moved_part,
    once,
    resistor_smaller,
    swapped_pads,
    unrated,
)
from silk_damages import (
    arrow_bent,
    cell_lost,
    cell_misnamed,
    cell_name_hidden,
    cell_names_lost,
    fiducial_lost,
    fiducials_near,
    first_pad_unmarked,
    label_lost,
    labels_swapped,
    letters_small,
    mark_lost,
    probe_lost,
    silk_line_thin,
    silk_on_a_pad,
    title_lost,
)

Damage = Callable[[str], str]
EMITTER = "boards/emitter/emitter.kicad_pcb"


def led_moved(text: str) -> str:
    return moved_part(text, "D7", 0.05, 0.0)


def led_on_the_back(text: str) -> str:
    return in_part(text, "D7", r'\(layer "F.Cu"\)', '(layer "B.Cu")')


def led_added(text: str) -> str:
    extra = '(fp_text reference "D99" (at 0 0) (layer "F.SilkS"))'
    return text.rstrip()[:-1] + f'(footprint "X" (layer "F.Cu") (at 150 100) {extra}))\n'


def led_reversed(text: str) -> str:
    return swapped_pads(text, "D7", "1", "2")


def led_bridged(text: str) -> str:
    return in_part(text, "D7", r'(\(pad "1".*\(size )\S+ \S+\)', r"\g<1>2.0 1)")


def led_taller(text: str) -> str:
    return in_part(text, "D7", "LEDC1608X60N", "LEDC1608X160N")


def resistor_taller(text: str) -> str:
    return in_part(text, "R1", r"(RESC\d+X)\d+N", r"\g<1>90N")


def reference_twice(text: str) -> str:
    return in_part(text, "FID3", "FID3", "FID2")


def revision_in_the_title_block(text: str) -> str:
    return once(text, r'(\(rev "[^"]*)"', r'\g<1>0"')


def date_in_the_title_block(text: str) -> str:
    return once(text, r'\(date "[^"]*"\)', '(date "2019-01-01")')


def design_in_the_title_block(text: str) -> str:
    return once(text, r"Design [0-9a-f]{8}", "Design 00000000")


def board_in_the_title_block(text: str) -> str:
    return once(text, "emitter board, seen", "receiver board, seen")


def title_block_lost(text: str) -> str:
    return once(text, r"\(title_block", "(title_blocks")


EMITTER_DAMAGES: dict[Damage, set[str]] = {
    led_moved: {"cells", "clearance"},  # the pour is as near as it may be
    led_on_the_back: {"cells", "room_behind", "silk_marks"},
    led_added: {"cell_count", "silk_marks"},
    led_reversed: {"lands", "polarity", "silk_marks"},
    led_bridged: {"lands", "short", "strings", "current", "silk_gap", "resistor_load"},
    led_taller: {"lands", "height_front"},
    resistor_smaller: {"current", "resistor_load"},
    unrated: {"lands", "resistor_load"},
    resistor_taller: {"lands", "room_behind"},
    **TIE_DAMAGES,
    title_lost: {"silk_title"},
    arrow_bent: {"silk_arrow"},
    cell_lost: {"silk_cells"},
    cell_misnamed: {"silk_cell_names"},
    cell_names_lost: {"silk_cell_names"},
    cell_name_hidden: {"silk_cell_names"},
    mark_lost: {"silk_marks"},
    label_lost: {"silk_labels"},
    labels_swapped: {"silk_labels"},
    first_pad_unmarked: {"silk_marks"},
    letters_small: {"silk_letters"},
    silk_line_thin: {"silk_lines"},
    silk_on_a_pad: {"silk_gap"},
    fiducial_lost: {"fiducials"},
    fiducials_near: {"fiducial_spread"},
    probe_lost: {"test_points", "silk_labels"},
    reference_twice: {"references"},
    revision_in_the_title_block: {"title_block"},
    date_in_the_title_block: {"title_block"},
    design_in_the_title_block: {"title_block"},
    board_in_the_title_block: {"title_block"},
    title_block_lost: {"title_block"},
}
