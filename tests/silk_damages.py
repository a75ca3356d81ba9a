"""Ways to hurt what is printed on a board, and the marks that machines look for."""

import re
from collections.abc import Callable

from board_damages import in_part, moved_part, once


def without(pattern: str, count: int = 1) -> Callable[[str], str]:
    """A damage that takes out the first lines that match."""

    def damage(text: str) -> str:
        hurt, found = re.subn(rf"\n[^\n]*{pattern}[^\n]*", "", text, count=count)
        assert found == count, f"{found} lines match {pattern}"
        return hurt

    return damage


def title_lost(text: str) -> str:
    return text.replace('(gr_text "Small"', '(gr_text "Other"')


def arrow_bent(text: str) -> str:
    """The shaft, which is the only upright line of 2.4 mm, ends elsewhere."""
    for m in re.finditer(r"\(gr_line \(start (\S+) (\S+)\) \(end (\S+) (\S+)\)", text):
        x, y, u, v = map(float, m.groups())
        if x == u and abs(abs(y - v) - 2.4) < 1e-6:
            return text.replace(m[0], f"(gr_line (start {x + 0.3} {y}) (end {u} {v})", 1)
    raise AssertionError("no arrow")


def cell_lost(text: str) -> str:
    return without(r'\(gr_line [^\n]*"F.SilkS"', 6)(text)


def mark_lost(text: str) -> str:
    for _ in range(3):
        text = in_part(text, "D7", r'\n[^\n]*\(fp_line [^\n]*"F.SilkS"[^\n]*', "")
    return text


def cell_misnamed(text: str) -> str:
    """The reference of an LED stands in the next cell."""
    return in_part(
        text, "D7", r'(\(fp_text reference "D7"\s+\(at )(\S+) (-?[\d.]+)', r"\g<1>\g<2> 9.0"
    )


def cell_names_lost(text: str) -> str:
    """The references of all LEDs are on another layer, which is not printed."""
    hurt, found = re.subn(
        r'(\(fp_text reference "D\d+"\s+\(at [^)]*\)\s+\(layer )"F.SilkS"', r'\g<1>"F.Fab"', text
    )
    assert found > 1
    return hurt


def cell_name_hidden(text: str) -> str:
    return in_part(text, "D7", r'(reference "D7"\s+\(at [^)]*\)\s+\(layer "F.SilkS"\))', r"\1 hide")


def label_lost(text: str) -> str:
    return without(r'\(gr_text "12V"')(text)


def labels_swapped(text: str) -> str:
    text = once(text, r'\(gr_text "GND"', '(gr_text "?"')
    return once(
        once(text, r'\(gr_text "12V"', '(gr_text "GND"'), r'\(gr_text "\?"', '(gr_text "12V"'
    )


def first_pad_unmarked(text: str) -> str:
    return without(r'\(gr_text "1" ')(text)


def letters_small(text: str) -> str:
    return once(text, r'(\(gr_text "GND"[^\n]*)\(size 0\.8 0\.8\)', r"\g<1>(size 0.7 0.7)")


def silk_line_thin(text: str) -> str:
    return once(text, r'(\(gr_line [^\n]*"F.SilkS"\) \(width )0\.15', r"\g<1>0.1")


def silk_on_a_pad(text: str) -> str:
    at = re.search(r'"lumitip:LEDC[^\n]*\n[^\n]*\n[^\n]*\n\s*\(at (\S+) (\S+)', text)
    assert at
    x, y = float(at[1]), float(at[2])
    line = f'  (gr_line (start {x} {y}) (end {x + 0.4} {y}) (layer "F.SilkS") (width 0.15))\n'
    return text.replace("  (gr_line", line + "  (gr_line", 1)


def fiducial_lost(text: str) -> str:
    return in_part(text, "FID3", "FID3", "X3")


def fiducials_near(text: str) -> str:
    return moved_part(text, "FID3", 0.0, -16.0)


def probe_lost(text: str) -> str:
    return in_part(text, "TP1", 'reference "TP1"', 'reference "X1"')
