"""Few vias: the search for them makes no board worse, and ends by a bound on its work."""

import math
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

import small_boards as small
from lumitip_fab.boards.model import BoardModel, Placement, Routing
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import fewer_vias, route, router
from lumitip_fab.boards.route.fewer_vias import Copper, lower_via_count
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Wanted
from lumitip_fab.boards.route.trees import State, Unreachable, connect
from lumitip_fab.boards.verify import summary, verify

pytestmark = pytest.mark.slow

Search = Callable[[State, list[Wanted], str], None]


def signal_vias(placement: Placement, routing: Routing) -> int:
    """Vias of all nets but ground."""
    return Counter(via.net != placement.ground for via in routing.vias)[True]


def caught(
    placement: Placement, monkeypatch: pytest.MonkeyPatch, search: Search = lower_via_count
) -> tuple[State, list[Wanted]]:
    """A board as the search leaves it, before it is polished."""
    found: list[tuple[State, list[Wanted]]] = []

    def keep(state: State, nets: list[Wanted], ground: str) -> None:
        search(state, nets, ground)
        found.append((state, nets))

    with monkeypatch.context() as patch:
        patch.setattr(router, "lower_via_count", keep)
        patch.setattr(router, "polish", lambda *_: None)
        route(placement)
    return found[0]


def nothing(state: State, nets: list[Wanted], ground: str) -> None:
    """No search."""


def cost(state: State, nets: list[Wanted], ground: str) -> tuple[int, float]:
    """Signal vias, and the cost of the board (mm)."""
    copper = {net.name: Copper.of(state, net) for net in nets}
    price = {ground: fewer_vias.GROUND_VIA_MM}
    return (
        sum(c.vias for name, c in copper.items() if name != ground),
        sum(c.cost_mm(price.get(name, fewer_vias.VIA_MM)) for name, c in copper.items()),
    )


def test_the_published_receiver_has_few_vias_and_short_tracks(design_dir: Path) -> None:
    placement = small.preset(design_dir, "published", "receiver")
    found = route(placement)
    routing, fills, _ = pour(placement, found)
    faults = verify(BoardModel(placement, routing, fills))
    assert not faults, summary(faults)
    assert signal_vias(placement, routing) <= 30
    signals = [track for track in routing.tracks if track.net != placement.ground]
    assert sum(math.dist(t.start, t.end) for t in signals) < 1.15 * 893
    assert route(placement) == found


@pytest.mark.parametrize("preset", ["crossing", "published", "mux16"])
def test_the_search_makes_no_board_worse(
    design_dir: Path, monkeypatch: pytest.MonkeyPatch, preset: str
) -> None:
    placement = (
        small.crossing() if preset == "crossing" else small.preset(design_dir, preset, "receiver")
    )
    state, nets = caught(placement, monkeypatch, nothing)
    vias, cost_mm = cost(state, nets, placement.ground)
    lower_via_count(state, nets, placement.ground)
    fewer, less_mm = cost(state, nets, placement.ground)
    assert not [net.name for net in nets if state.contested(net).size]
    assert fewer <= vias
    assert less_mm <= cost_mm
    if preset != "crossing":
        assert fewer < vias


def test_a_search_that_fails_leaves_every_net_and_map_as_it_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    placement = small.crossing()
    state, nets = caught(placement, monkeypatch, nothing)
    before, taken = dict(state.routed), state.taken.copy()
    monkeypatch.setattr(fewer_vias, "LEAST_GAIN_MM", 1e6)
    lower_via_count(state, nets, placement.ground)
    assert (state.taken == taken).all()
    assert all(state.routed[name] is paths for name, paths in before.items())


def test_a_net_that_finds_no_way_is_put_back(monkeypatch: pytest.MonkeyPatch) -> None:
    placement = small.crossing()
    state, nets = caught(placement, monkeypatch, nothing)
    before, taken = dict(state.routed), state.taken.copy()

    def walled_in(_: State, net: Wanted, *__: object) -> None:
        raise Unreachable(net.name, (net.terminals[0], net.terminals[1]))

    monkeypatch.setattr(fewer_vias, "connect", walled_in)
    lower_via_count(state, nets, placement.ground)
    assert (state.taken == taken).all()
    assert state.routed == before


def test_a_net_without_a_way_leaves_no_marks(monkeypatch: pytest.MonkeyPatch) -> None:
    placement = small.crossing()
    state, nets = caught(placement, monkeypatch, nothing)
    net = next(n for n in nets if n.name == "A")
    state.count(net, -1)
    state.owner[:] = -1
    with pytest.raises(Unreachable):
        connect(state, net, [], fewer_vias.COSMETIC)
    assert not state.tree.any()
    assert not state.target.any()
    assert not state.near_via.any()


def test_the_search_ends_by_a_bound_on_its_work(
    design_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    placement = small.preset(design_dir, "published", "receiver")
    state, nets = caught(placement, monkeypatch, nothing)
    begun = int(state.work[0])
    attempts: list[str] = []

    class Counted(fewer_vias.Attempt):
        def succeeds(self, net: Wanted, kept: list[Ints]) -> bool:
            attempts.append(net.name)
            return super().succeeds(net, kept)

    monkeypatch.setattr(fewer_vias, "Attempt", Counted)
    monkeypatch.setattr(fewer_vias, "LEAST_WORK", 1)
    monkeypatch.setattr(fewer_vias, "WORK_SHARE", 0.0)
    lower_via_count(state, nets, placement.ground)
    assert len(attempts) == 1
    assert int(state.work[0]) > begun


def test_polish_adds_no_signal_via(design_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    placement = small.preset(design_dir, "published", "receiver")
    state, nets = caught(placement, monkeypatch)
    before = {net.name: Copper.of(state, net).vias for net in nets}
    fewer_vias.polish(state, nets, placement.ground)
    after = {net.name: Copper.of(state, net).vias for net in nets}
    assert all(after[n] <= before[n] for n in before if n != placement.ground)
