"""The published sensor with its deviations, and the bench that its fingers are tried on."""

from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.tolerance.bench import Bench
from lumitip_fab.tolerance.options import Options
from lumitip_fab.tolerance.study import cases_of


@pytest.fixture(scope="session")
def design(design_dir: Path) -> Resolved:
    return resolve(load(design_dir / "fingertip.toml"))


@pytest.fixture(scope="session")
def tried(design: Resolved) -> Bench:
    return Bench(cases_of(design.config, design.design.layout, Options(poses=12))[0])
