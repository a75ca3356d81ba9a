"""Links: the ways that packets come. `open_link` chooses by the scheme of an address."""

from importlib import import_module

from lumitip.errors import LayoutError, UrlError
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Fault, Link, LinkEvent, Recorded
from lumitip.links.url import Url

__all__ = ["Arrival", "Fault", "Link", "LinkEvent", "Recorded", "open_link"]

SCHEMES = {
    "ble": "lumitip.links.ble",
    "serial": "lumitip.links.serial",
    "replay": "lumitip.links.replay",
    "twin": "lumitip.links.twin",
}


def open_link(url: str, layout: Layout | None = None, any_design: bool = False) -> Link:
    """The link of an address, not yet started.

    Args:
        url: `ble://NAME-OR-ADDRESS`, `serial://PORT`, `replay://FILE` or `twin://SHAPE`, options
            after a question mark: the module of each link says which.
        layout: the cells of the device; a replay and a twin bring their own.
        any_design: whether a device of another design is read all the same.

    Raises:
        UrlError: if there is no such link or option.
        LayoutError: if the link needs a layout and none was given.
        MissingExtra: if a library is missing.
        LinkError: what the link itself cannot accept.
    """
    told = Url.parse(url)
    if told.scheme not in SCHEMES:
        raise UrlError(f"{url!r} given, allowed are {', '.join(f'{name}://…' for name in SCHEMES)}")
    if layout is None and told.scheme in ("ble", "serial"):
        raise LayoutError(
            f"{url} says nothing of its cells: give the layout.json that its firmware was built "
            "from: layout='outputs/layout.json', or --layout outputs/layout.json"
        )
    link: Link = import_module(SCHEMES[told.scheme]).make(told, layout, any_design)
    return link
