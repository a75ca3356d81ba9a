"""Colours of insulation by their codes of IEC 60757, and how they are drawn."""

INKS = {
    "BK": "#1a1a1a",
    "BN": "#8a5a2b",
    "RD": "#d11f2e",
    "OG": "#f07d13",
    "YE": "#e6c200",
    "GN": "#1f9d48",
    "BU": "#2463c4",
    "VT": "#8446b0",
    "GY": "#8d949b",
    "WH": "#ffffff",
    "PK": "#f09bb8",
    "TQ": "#2bb9b4",
}
NAMES = {
    "BK": "black",
    "BN": "brown",
    "RD": "red",
    "OG": "orange",
    "YE": "yellow",
    "GN": "green",
    "BU": "blue",
    "VT": "violet",
    "GY": "grey",
    "WH": "white",
    "PK": "pink",
    "TQ": "turquoise",
}


def codes_of(colour: str) -> tuple[str, ...]:
    """The codes in a colour such as `"GN"` or, striped, `"WHGN"`: ground first."""
    return tuple(colour[i : i + 2] for i in range(0, len(colour), 2))


def named(colour: str) -> str:
    """A colour in words, such as `"green"` or `"white with green"`."""
    return " with ".join(NAMES[code] for code in codes_of(colour))
