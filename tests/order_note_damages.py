"""Damages of the notes in a zip that is sent to a PCB fab, and `edit`, which makes them."""

import re
from collections.abc import Callable

from order_copper_damages import Files

Damage = Callable[[Files], None]


def edit(files: Files, ending: str, pattern: bytes, put: bytes) -> None:
    (name,) = (n for n in files if n.endswith(ending))
    files[name], count = re.subn(pattern, put, files[name], count=1)
    assert count == 1


def note_missing(files: Files) -> None:
    del files["receiver_assembly.txt"]


def note_of_the_mark(files: Files) -> None:
    edit(files, "assembly.txt", b"pad 1 is the emitter", b"pad 1 is the collector")


def note_too_sure(files: Files) -> None:
    edit(files, "assembly.txt", b"emitter is inferred", b"emitter is certain")


def note_of_a_place(files: Files) -> None:
    edit(files, "assembly.txt", rb"(Q5  emitter \S+ )\S+", rb"\g<1>1.000")


def note_without_a_figure(files: Files) -> None:
    edit(files, "assembly.txt", rb"(Q5  emitter \S+ )\S+", rb"\g<1>nan")


def note_without_a_part(files: Files) -> None:
    edit(files, "assembly.txt", rb"Q5  .*\n", b"")


def note_of_an_assumed_rotation(files: Files) -> None:
    edit(files, "assembly.txt", b"\n\n", b"\n\nROTATION ASSUMED: U1. Compare.\n\n")


def thickness_of_the_fabrication_note(files: Files) -> None:
    edit(files, "fabrication.txt", b"Thickness: 1.6 mm", b"Thickness: 1 mm")


def thickness_without_a_tolerance(files: Files) -> None:
    edit(files, "fabrication.txt", rb"1\.6 mm, \S+ mm", b"1.6 mm")


def wide_tolerance_of_the_thickness(files: Files) -> None:
    edit(files, "fabrication.txt", rb"\+/-\S+ mm", b"+/-0.3 mm")


def size_of_the_fabrication_note(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Size: \S+", b"Size: 40.00")


def track_of_the_fabrication_note(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Narrowest track: \S+", b"Narrowest track: 0.25")


def drill_of_the_fabrication_note(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Smallest drill: \S+", b"Smallest drill: 0.4")


def green_board(files: Files) -> None:
    edit(files, "fabrication.txt", b"matte black, on both", b"green, on both")


def thin_copper(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Copper: \S+", b"Copper: 18")


def bare_copper(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Surface: .*", b"Surface: none")


def black_letters(files: Files) -> None:
    edit(files, "fabrication.txt", b"Silkscreen: white", b"Silkscreen: black")


def another_material(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Material: .*", b"Material: CEM-1")


def open_vias(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Vias: .*", b"Vias: open")


def no_electrical_test(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Electrical test: .*", b"Electrical test: none")


def mask_on_the_back_only(files: Files) -> None:
    edit(files, "fabrication.txt", rb"black, on both sides", b"black, on the back only")


def letters_on_the_back_only(files: Files) -> None:
    edit(files, "fabrication.txt", rb"white, on both sides", b"white, on the back only")


def a_line_more_of_the_fabrication_note(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Vias: ", b"Edges: plated\nVias: ")


def a_figure_twice(files: Files) -> None:
    edit(files, "fabrication.txt", rb"Copper: ", b"Copper: 70 um on each side\nCopper: ")


def fabrication_note_of_another_design(files: Files) -> None:
    edit(files, "fabrication.txt", rb"design \w+", b"design 00000000")


def either_way_round(files: Files) -> None:
    edit(files, "assembly.txt", rb"(\n.*: either way)", rb"\nQ1 to Q13: either way round.\1")


def not_to_be_placed(files: Files) -> None:
    edit(files, "assembly.txt", rb": either way round\.", b": do not place.")


def check_left_out(files: Files) -> None:
    edit(files, "assembly.txt", rb"CHECK BEFORE PLACING: .*\n", b"")


def small_board_unsaid(files: Files) -> None:
    edit(files, "assembly.txt", rb"SMALL BOARD: .*\n", b"")


def another_least_size(files: Files) -> None:
    edit(files, "assembly.txt", rb"less than 50 x 50 mm", b"less than 40 x 40 mm")


def place_of_a_part_of_no_board(files: Files) -> None:
    edit(files, "assembly.txt", rb"(Q5  .*\n)", rb"\1Q99  emitter 1.000 1.000  collector 2.0 1.0\n")


def no_stop_line(files: Files) -> None:
    del files["STOP_READ_FIRST.txt"]


def stop_line_of_other_parts(files: Files) -> None:
    edit(files, "STOP_READ_FIRST.txt", rb"Q1 to Q\d+", b"Q1 to Q2")


def stop_line_names_others_below(files: Files) -> None:
    edit(files, "STOP_READ_FIRST.txt", rb"\nQ1 to Q\d+", b"\nQ1 to Q2")


NOTE_DAMAGES: dict[Damage, set[str]] = {
    note_missing: {"readable"},
    note_of_the_mark: {"note"},
    note_too_sure: {"note"},
    note_of_a_place: {"note"},
    note_without_a_figure: {"note"},
    note_without_a_part: {"note"},
    note_of_an_assumed_rotation: {"assumed", "note"},
    thickness_of_the_fabrication_note: {"fabrication"},
    thickness_without_a_tolerance: {"fabrication"},
    wide_tolerance_of_the_thickness: {"fabrication"},
    size_of_the_fabrication_note: {"fabrication"},
    track_of_the_fabrication_note: {"fabrication"},
    drill_of_the_fabrication_note: {"fabrication"},
    green_board: {"fabrication"},
    thin_copper: {"fabrication"},
    bare_copper: {"fabrication"},
    black_letters: {"fabrication"},
    another_material: {"fabrication"},
    open_vias: {"fabrication"},
    no_electrical_test: {"fabrication"},
    mask_on_the_back_only: {"fabrication"},
    letters_on_the_back_only: {"fabrication"},
    a_line_more_of_the_fabrication_note: {"fabrication"},
    a_figure_twice: {"fabrication"},
    fabrication_note_of_another_design: {"fabrication"},
    either_way_round: {"note"},
    not_to_be_placed: {"note"},
    check_left_out: {"note"},
    small_board_unsaid: {"note"},
    another_least_size: {"note"},
    place_of_a_part_of_no_board: {"note"},
    no_stop_line: {"stop"},
    stop_line_of_other_parts: {"stop"},
    stop_line_names_others_below: {"stop"},
}
"""With the checks that see them."""
