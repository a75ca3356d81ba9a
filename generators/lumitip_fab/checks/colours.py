"""Colours of bodies, by which a viewer shows layers apart and the parts behind clear ones."""

from collections import defaultdict
from collections.abc import Iterator, Mapping

from lumitip_fab.design import Design

Colour = tuple[float, ...]
"""Red, green, blue and opacity, 0 to 1."""
_CLEAR = ("silicone", "film")
"""Layers through which the parts are seen."""


def wrong_colours(found: Mapping[str, Colour | None], design: Design) -> Iterator[str]:
    """Bodies without a colour that can be seen; layers that are clear or opaque where they should
    not be, of another colour on the other finger, or of that of another layer."""
    by_layer: dict[str, set[Colour | None]] = defaultdict(set)
    for name, colour in found.items():
        layer = name.partition(".")[2]
        if colour is None or len(colour) != 4 or not all(0 <= part <= 1 for part in colour):
            yield f"{name} has no colour"
        elif (0 < colour[3] < 1) != (layer in _CLEAR) or not colour[3]:
            yield f"{name} has opacity {colour[3]:g}"
        if name.partition(".")[0] in {finger.name for finger in design.fingers}:
            by_layer[layer].add(colour)
    layers = {layer: by_layer[layer] for layer in design.layers}
    yield from (f"{layer} in several colours" for layer, all_ in layers.items() if len(all_) > 1)
    if len(set().union(*layers.values())) < len(layers):
        yield "layers of one colour"
