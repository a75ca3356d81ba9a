"""Links: the sources of frames. `open_link` chooses one by the scheme of an address."""

from importlib import import_module

from lumitip.errors import LayoutError, UrlError
from lumitip.known_layouts import recall
from lumitip.layout import Layout
from lumitip.links.base import Identity, Link
from lumitip.links.url import Url

SCHEMES = {
    "ble": "lumitip.links.ble",
    "serial": "lumitip.links.serial",
    "replay": "lumitip.links.replay",
    "twin": "lumitip.links.twin",
    "tcp": "lumitip.links.tcp",
}


DEVICES = ("ble", "serial")
"""Links of controllers, which send no layout but name their design."""


def open_link(
    url: str,
    layout: Layout | None = None,
    any_design: bool = False,
    timeout_s: float | None = None,
) -> Link:
    """The link of an address, not yet started.

    Args:
        url: `ble://NAME-OR-ADDRESS`, `serial://PORT`, `replay://FILE`, `twin://SHAPE` or
            `tcp://HOST:PORT`; the module of each link describes its options.
        layout: the cells of the device; optional for a replay, a twin or a shared device, and for
            a device whose layout was used on this computer before.
        any_design: accept a device of another design.
        timeout_s: longest wait for a device to name its design (s), if there is no layout.

    Raises:
        UrlError: if the link or an option does not exist.
        LayoutError: if the layout is missing, and is not known from before.
        MissingExtra: if a library is missing.
        LinkError: if the link rejects the address.
    """
    address = Url.parse(url)
    if address.scheme not in SCHEMES:
        allowed = ", ".join(f"{name}://…" for name in SCHEMES)
        raise UrlError(f"the address is {address.text!r}; allowed are {allowed}")
    module = import_module(SCHEMES[address.scheme])
    if layout is None and address.scheme in DEVICES:
        layout, address = _known(module.identify(address, timeout_s))
    link: Link = module.make(address, layout, any_design)
    return link


def _known(device: Identity) -> tuple[Layout, Url]:
    layout = recall(device.device_id, device.design, device.cells)
    if layout is None:
        raise LayoutError(
            f"{device.device_id} has {device.cells} cells of design {device.design}. It was not "
            "used on this computer before, and no other device was, or several with different "
            "optics. Add the layout.json that its firmware was built from, this once: "
            "layout='outputs/layout.json', or --layout outputs/layout.json"
        )
    return layout, device.url
