"""Drawings of the casting: the mould cut along its middle, filled, with the finger going into it,
and with the finger coming out."""

import shapely
from shapely import affinity

from lumitip_fab.scenes.casting_page import Cast, Page
from lumitip_fab.scenes.cut import cut

BULGE_MM = 1.2  # of the silicone over the rim, as it is drawn
BELOW_WEIR_MM = 0.3  # of the silicone in a tilted mould, as it is drawn
LOWERED_DEG, LIFTED_DEG = 9.0, 4.0  # of the finger to the mould, as they are drawn
_ARC_DEG = 7.0


def filled_view(cast: Cast) -> str:
    """The mould, filled until the silicone bulges over the rim; or tilted on its prop, the
    silicone level, as the table is."""
    page = Page(cast)
    left, low, right, _ = page.cavity.bounds
    page.behind(cast.mould)
    words = "a little over the weir"
    if cast.prop is None:
        page.fill(shapely.union(page.cavity, _bulge(left, right, cast.rim_mm)), "silicone")
    else:
        words = "level, higher at the tip"
        page.fill(_poured(cast, page), "silicone")
        page.label(("Prop", "its stop at the mould's end"), page.mould.bounds[2] - 1.0, -0.5)
    page.fill_mould()
    page.stand()
    page.label(("Silicone", words), (left + right) / 2, cast.rim_mm - 0.5)
    page.label(("Weir", "as high as the stops"), right + 1.0, cast.rim_mm)
    page.label(("Trough", "for the surplus"), page.mould.bounds[2] - 5.0, low)
    return page.svg()


def lowered_view(cast: Cast) -> str:
    """The finger, its tip on the stop, being lowered about it."""
    page = Page(cast)
    layers = cast.turned(("interface", "backing", "board"), LOWERED_DEG)
    areas = {name: cut(mesh) for name, mesh in layers.items()}
    page.behind(*cast.screws, cast.mould, *layers.values())
    page.fill(_poured(cast, page) - shapely.union_all(list(areas.values())), "silicone")
    page.fill_mould()
    page.fill_all(areas)
    page.wires(LOWERED_DEG)
    page.stand()
    page.turn(LOWERED_DEG + _ARC_DEG, LOWERED_DEG)
    page.label(("Tip", "first, on its stop"), cast.tip_y_mm + 0.5, cast.rim_mm + 1.0)
    page.label(("Weir", "wires and surplus go over it"), page.cavity.bounds[2] + 1.0, cast.rim_mm)
    return page.svg()


def lifted_view(cast: Cast) -> str:
    """The cast finger coming out, its gripper end first."""
    page = Page(cast)
    layers = cast.turned(("silicone", "interface", "backing", "board"), LIFTED_DEG)
    page.behind(cast.mould, *layers.values())
    page.fill_mould()
    page.fill_all({name: cut(mesh) for name, mesh in layers.items()})
    page.wires(LIFTED_DEG)
    page.stand()
    page.turn(LIFTED_DEG, LIFTED_DEG + _ARC_DEG)
    page.label(("Gripper end", "first, until air is under it"), page.cavity.bounds[2] - 2.0, 4.0)
    last = "its silicone is thin" if cast.prop is None else "the skin goes round it"
    page.label(("Tip edge", f"last: {last}"), cast.tip_y_mm + 0.5, cast.rim_mm)
    return page.svg()


def _bulge(left_mm: float, right_mm: float, rim_mm: float) -> shapely.Geometry:
    """The silicone over the rim: half an ellipse."""
    centre = shapely.Point((left_mm + right_mm) / 2, 0.0)
    ellipse = affinity.scale(centre.buffer(1.0, 32), (right_mm - left_mm) / 2, BULGE_MM)
    above = shapely.box(left_mm, 0.0, right_mm, BULGE_MM)
    return affinity.translate(shapely.intersection(ellipse, above), 0.0, rim_mm)


def _poured(cast: Cast, page: Page) -> shapely.Geometry:
    """The silicone in a tilted mould, before the finger raises it to the weir; in a level one, all
    of the cavity."""
    if cast.prop is None:
        return page.cavity
    mould, weir_mm = page.mould, page.cavity.bounds[2]
    wall_mm = mould.bounds[0]
    top_mm = cast.rim_mm - BELOW_WEIR_MM
    raised_mm = top_mm + cast.slope * (weir_mm - wall_mm)
    corners = [(wall_mm, 0.0), (weir_mm, 0.0), (weir_mm, top_mm), (wall_mm, raised_mm)]
    parts = shapely.get_parts(shapely.difference(shapely.Polygon(corners), mould))
    return max(parts, key=lambda part: float(part.area))
