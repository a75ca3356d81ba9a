"""Sobol indices of functions whose indices are known."""

import numpy as np
import pytest

from lumitip.grid import Floats
from lumitip_fab.tolerance.sobol import Indices, indices, mixed

NAMES = ("one", "two", "three")


def found(function: object, count: int = 4096) -> Indices:
    a, b = (
        {name: np.random.default_rng((seed, n)).standard_normal((count, 4))
         for n, name in enumerate(NAMES)}
        for seed in (0, 1)
    )  # fmt: skip

    def of(draws: dict[str, Floats]) -> Floats:
        return np.array([function(*(draws[name] for name in NAMES))])  # type: ignore[operator]

    return indices(of(a), of(b), np.array([of(mixed(a, b, name)) for name in NAMES]))


def test_indices_of_a_linear_function_are_its_shares_of_the_variance() -> None:
    result = found(lambda x, y, z: 3.0 * x.sum(axis=1) + 2.0 * y.sum(axis=1) + z[:, 0])
    shares = np.array([36.0, 16.0, 1.0]) / 53.0
    assert result.first[0] == pytest.approx(shares, abs=0.08)
    assert result.total[0] == pytest.approx(shares, abs=0.08)
    assert result.first[0].sum() == pytest.approx(1.0, abs=0.12)
    assert np.all(np.abs(result.total[0] - shares) < 4.0 * result.total_sd[0])


def test_factors_that_act_together_have_a_total_but_no_first_index() -> None:
    result = found(lambda x, y, z: x[:, 0] * y[:, 0] + 0.0 * z[:, 0])
    assert result.first[0] == pytest.approx([0.0, 0.0, 0.0], abs=0.15)
    assert result.total[0] == pytest.approx([1.0, 1.0, 0.0], abs=0.2)


def test_more_draws_make_the_indices_surer() -> None:
    few, many = (found(lambda x, y, z: x[:, 0] + y[:, 0] + z[:, 0], count) for count in (64, 1024))
    assert np.all(many.first_sd[0, :2] < 0.5 * few.first_sd[0, :2])
