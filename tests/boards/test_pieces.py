"""Parts of a net while it is routed: what is connected, what may stay, what is nearest."""

import numpy as np
import pytest

import small_boards as small
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Terminal, Wanted
from lumitip_fab.boards.route.pieces import nearest, pieces, supported, with_nodes


def nodes(*some: int) -> Ints:
    return np.array(some, dtype=np.int32)


@pytest.fixture
def net() -> Wanted:
    """Four pads, each of two nodes: 0 and 1, 10 and 11, 20 and 21, 30 and 31."""
    some: list[PlacedPad] = [p for c in small.crossing().components for p in placed_pads(c)][:4]
    ends = tuple(Terminal(pad, nodes(10 * i, 10 * i + 1)) for i, pad in enumerate(some))
    return Wanted("A", 1, 0, ends, np.zeros((1, 1), dtype=np.uint8))


def test_pads_and_paths_that_meet_are_one_part(net: Wanted) -> None:
    joining = [nodes(1, 5, 6, 10), nodes(6, 7, 31)]
    largest, other = pieces(net, joining)
    assert sorted(largest.terminals) == [0, 1, 3]
    assert set(np.concatenate(largest.nodes).tolist()) == {0, 1, 5, 6, 7, 10, 11, 30, 31}
    assert other.terminals == [2]


def test_without_paths_each_pad_is_a_part(net: Wanted) -> None:
    assert [piece.terminals for piece in pieces(net, [])] == [[0], [1], [2], [3]]


def test_a_path_stays_as_long_as_both_its_ends_are_held(net: Wanted) -> None:
    held, beside = nodes(1, 5, 6, 10), nodes(6, 7, 31)
    assert supported(net, [held, beside]) == [held, beside]
    assert supported(net, [beside]) == []


def test_what_leans_on_a_path_that_goes_goes_too(net: Wanted) -> None:
    held, first, second = nodes(0, 2, 10), nodes(20, 22, 99), nodes(22, 40, 30)
    assert supported(net, [held, first, second]) == [held]


def test_the_nearest_pads_of_two_parts_are_found(net: Wanted) -> None:
    one, *others = pieces(net, [])
    for other in others:
        apart_mm, a, b = nearest(net, [0, 1, 2, 3], other)
        assert (apart_mm, a, b) == (0.0, other.terminals[0], other.terminals[0])
        pads = [net.terminals[i].pad for i in (one.terminals[0], other.terminals[0])]
        away = np.hypot(pads[0].x_mm - pads[1].x_mm, pads[0].y_mm - pads[1].y_mm)
        assert nearest(net, one.terminals, other)[0] == pytest.approx(away, abs=1e-6)


def test_nodes_are_added_once_and_in_order() -> None:
    more = with_nodes(nodes(3, 5, 9), [nodes(9, 4), nodes(1, 12, 4, 5)])
    assert more.tolist() == [1, 3, 4, 5, 9, 12]
    assert more.dtype == np.int32
