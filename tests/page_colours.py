"""Colours of the page of the live view."""

import numpy as np


def ramp(value: float) -> np.ndarray:
    """Colour of a value: a straight way through Oklab, worked out here by itself."""
    dark, light = np.array([0.25, -0.015, -0.09]), np.array([0.93, -0.035, 0.13])
    to_lms = np.array(
        [
            [1, 0.3963377774, 0.2158037573],
            [1, -0.1055613458, -0.0638541728],
            [1, -0.0894841775, -1.2914855480],
        ]
    )
    to_rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    lab = dark + (light - dark) * round(value) / 255
    linear = np.clip(to_rgb @ (to_lms @ lab) ** 3, 0, 1)
    coded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(255 * coded)
