"""Links: the sources of frames. `open_link` chooses one by the scheme of an address."""

from importlib import import_module

from lumitip.errors import LayoutError, UrlError
from lumitip.layout import Layout
from lumitip.links.base import Link
from lumitip.links.url import Url

SCHEMES = {
    "ble": "lumitip.links.ble",
    "serial": "lumitip.links.serial",
    "replay": "lumitip.links.replay",
    "twin": "lumitip.links.twin",
    "tcp": "lumitip.links.tcp",
}


def open_link(url: str, layout: Layout | None = None, any_design: bool = False) -> Link:
    """The link of an address, not yet started.

    Args:
        url: `ble://NAME-OR-ADDRESS`, `serial://PORT`, `replay://FILE`, `twin://SHAPE` or
            `tcp://HOST:PORT`; the module of each link describes its options.
        layout: the cells of the device; optional for a replay, a twin or a shared device.
        any_design: accept a device of another design.

    Raises:
        UrlError: if the link or an option does not exist.
        LayoutError: if the layout is missing.
        MissingExtra: if a library is missing.
        LinkError: if the link rejects the address.
    """
    address = Url.parse(url)
    if address.scheme not in SCHEMES:
        allowed = ", ".join(f"{name}://…" for name in SCHEMES)
        raise UrlError(f"the address is {url!r}; allowed are {allowed}")
    if layout is None and address.scheme in ("ble", "serial"):
        raise LayoutError(
            f"{url} needs the layout.json that its firmware was built from: add "
            "layout='outputs/layout.json', or --layout outputs/layout.json"
        )
    link: Link = import_module(SCHEMES[address.scheme]).make(address, layout, any_design)
    return link
