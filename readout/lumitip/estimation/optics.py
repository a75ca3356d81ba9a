"""Optics that are not quite the expected ones: `drifted` and `at_drift`."""

from collections.abc import Sequence

import numpy as np

from lumitip.grid import Floats
from lumitip.twin import Model

_LEAST_GAP_MM = 0.5


def drifted(model: Model, gap_sd_mm: float, alpha_sd: float) -> list[Model]:
    """The model with one uncertain parameter changed at a time, by its standard deviation."""
    models = []
    if gap_sd_mm:
        models.append(model.changed(gap_mm=model.gap_mm + gap_sd_mm))
    if alpha_sd:
        step = alpha_sd if model.alpha + alpha_sd <= 1.0 else -alpha_sd
        models.append(model.changed(alpha=model.alpha + step))
    return models


def at_drift(model: Model, others: Sequence[Model], drift: Floats) -> Model:
    """The model between.

    Args:
        model: the expected one.
        others: the result of `drifted`.
        drift: steps towards each of them, shape `(len(others),)`.
    """
    steps = [(other.gap_mm - model.gap_mm, other.alpha - model.alpha) for other in others]
    gap_mm, alpha = np.array([model.gap_mm, model.alpha]) + drift @ np.reshape(steps, (-1, 2))
    return model.changed(
        gap_mm=max(float(gap_mm), _LEAST_GAP_MM), alpha=min(max(float(alpha), 0.0), 1.0)
    )
