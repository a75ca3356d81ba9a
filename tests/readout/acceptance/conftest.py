"""A gauge of the published layout, its judge, and what makes frames of fingers."""

import json

import pytest

from acceptance_frames import Bench, record
from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.verdict import Judge
from lumitip.links.twin import published_layout


@pytest.fixture(scope="session")
def gauge() -> Gauge:
    return Gauge.from_json(json.dumps(record()))


@pytest.fixture(scope="session")
def bench(gauge: Gauge) -> Bench:
    return Bench(published_layout(), gauge)


@pytest.fixture(scope="session")
def judge(gauge: Gauge) -> Judge:
    return Judge(published_layout(), gauge)
