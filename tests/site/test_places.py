"""Lines of the page's tables lead to places: parts, nets, bodies, boards and prints."""

import pytest

from site_page import Opened

pytestmark = pytest.mark.slow


def test_every_name_that_a_line_shows_is_in_a_panel(opened: Opened) -> None:
    tab = opened()
    lost = """[...new Set([...data.checks.flatMap(row => row.show),
        ...all(".show").flatMap(button => button.dataset.show.split(" "))])].filter(name =>
        !parts.has(name) && !nets.has(name) && !shown.has(name) && !panelsOf(name).length)"""
    assert tab.evaluate(lost) == []
    assert tab.locator("#bill .show").count() > 20
    prints = tab.evaluate("all('option', byId('bed-part')).map(option => option.value)")
    names = tab.evaluate("data.checks.flatMap(row => row.show)")
    files = {name.removeprefix("print.").partition("@")[0] for name in names if "print." in name}
    assert files and files <= set(prints)


def test_a_net_lights_up_on_its_board(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("board.clearance receiver")
    tab.locator("#check-table tbody .show").first.click()
    lit = tab.evaluate("all('[data-net].lit').map(e => e.getAttribute('data-net'))")
    assert lit and all(name.startswith("receiver:") for name in lit)
