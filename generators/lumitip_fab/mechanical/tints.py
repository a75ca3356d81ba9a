"""Colours of bodies in what is looked at on a screen."""

Colour = tuple[float, float, float, float]
"""Red, green, blue as seen on a screen (sRGB) and opacity, each 0 to 1."""

COLOURS: dict[str, Colour] = {
    "robot": (0.45, 0.50, 0.56, 1.0),
    "coupling": (0.60, 0.62, 0.65, 1.0),
    "lower": (0.56, 0.66, 0.80, 1.0),
    "upper": (0.64, 0.73, 0.85, 1.0),
    "gripper": (0.30, 0.31, 0.33, 1.0),
    "holder": (0.86, 0.62, 0.35, 1.0),
    "interface": (0.62, 0.66, 0.72, 1.0),
    "backing": (0.82, 0.84, 0.86, 1.0),
    "board": (0.10, 0.38, 0.24, 1.0),
    "silicone": (0.75, 0.88, 0.95, 0.35),
    "film": (0.08, 0.08, 0.09, 0.55),
    "led": (0.95, 0.80, 0.35, 1.0),
    "photodetector": (0.22, 0.24, 0.30, 1.0),
    "multiplexer": (0.12, 0.12, 0.13, 1.0),
    "resistor": (0.25, 0.22, 0.20, 1.0),
}
