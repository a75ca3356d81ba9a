"""STEP text does not depend on what the process did before."""

from lumitip_fab.parts.export import canonical

HEAD = "#1 = PRODUCT('a','a','',(#2));\n"
USE = "#5 = NEXT_ASSEMBLY_USAGE_OCCURRENCE({},$);\n"
END = "ENDSEC;\nEND-ISO-10303-21;\n"
COLOURED = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"


def blocks(first: int, colours: list[tuple[float, int]]) -> str:
    text, n = "", first
    for red, shape in colours:
        text += f"#{n} = {COLOURED}('',(\n    #{n + 1},#{n + 3}),#7);\n"
        text += f"#{n + 1} = STYLED_ITEM('color',(#{n + 2}),#{shape});\n"
        text += f"#{n + 2} = COLOUR_RGB('',{red},0.,0.);\n"
        text += f"#{n + 3} = OVER_RIDING_STYLED_ITEM('',(#{n + 2}),#{shape},\n  #{n + 1});\n"
        n += 4
    return text


def test_the_order_of_colours_does_not_matter() -> None:
    a = canonical(HEAD + blocks(10, [(0.5, 3), (0.25, 4)]) + END)
    b = canonical(HEAD + blocks(10, [(0.25, 4), (0.5, 3)]) + END)
    assert a == b
    assert a.startswith(HEAD)
    assert a.endswith(END)
    assert a.count("COLOUR_RGB") == 2


def test_the_order_of_items_does_not_matter() -> None:
    text = HEAD + blocks(10, [(0.5, 3)]) + END
    assert canonical(text.replace("#11,#13", "#13,#11")) == canonical(text)


def test_equal_colours_are_written_once() -> None:
    told = canonical(HEAD + blocks(10, [(0.5, 3), (0.5, 4)]) + END)
    assert told.count("COLOUR_RGB") == 1
    assert told.count("STYLED_ITEM('color'") == 2


def test_uses_are_numbered_from_one_wherever_their_lines_broke() -> None:
    long = USE.format("'1203','x','',#31,#74\n  ,#75")
    short = USE.format("'9','x','',#31,#74,\n  #75")
    assert canonical(long + END) == canonical(short + END)
    assert "('1','x','',#31,#74,#75,$)" in canonical(long + END)
