"""The attributes of a zip's layers: a fab that reads them believes them."""

import re
from collections.abc import Iterator, Mapping

from lumitip_fab.checks.result import Measurement, Subject

_SIDES = {"front": ("Top", "L1,Top"), "back": ("Bot", "L2,Bot")}
_KINDS = {"mask": "Soldermask", "paste": "Paste", "silk": "Legend"}
_FUNCTIONS = {
    "outline": "Profile,NP",
    "plated": "Plated,1,2,PTH",
    "unplated": "NonPlated,1,2,NPTH",
    **{f"{side} copper": f"Copper,{where}" for side, (_, where) in _SIDES.items()},
    **{
        f"{side} {kind}": f"{function},{where}"
        for side, (where, _) in _SIDES.items()
        for kind, function in _KINDS.items()
    },
}
"""The standard attribute of each layer; of others there is none."""
_DRILLS = ("plated", "unplated")
_ATTRIBUTE = re.compile(r"^(?:%|; #@! )TF\.(\w+),([^*%\n]+)", re.MULTILINE)


def measure_roles(path: str, layers: Mapping[str, bytes]) -> Measurement:
    """Layers with attributes of another one, or that do not lie on the others."""
    return Subject("orders", path).count("roles", list(_wrong(layers)), "attributes of layers")


def _wrong(layers: Mapping[str, bytes]) -> Iterator[str]:
    found = {key: _ATTRIBUTE.findall(data.decode()) for key, data in layers.items()}
    places = {key: [v for n, v in pairs if n == "SameCoordinates"] for key, pairs in found.items()}
    wanted = next((place for key, place in places.items() if key not in _DRILLS), [])
    for key, function in _FUNCTIONS.items():
        if key not in found:
            continue
        functions = [value for name, value in found[key] if name == "FileFunction"]
        if functions != [function]:
            yield f"{key} is {', '.join(functions) or 'nothing'}"
        if key in _DRILLS:
            continue
        if not wanted or places[key] != wanted:
            yield f"{key} lies elsewhere"
        polarity = [value for name, value in found[key] if name == "FilePolarity"]
        own = [] if key == "outline" else ["Negative" if key.endswith("mask") else "Positive"]
        if polarity != own:
            yield f"{key} is {', '.join(polarity) or 'of no polarity'}"
