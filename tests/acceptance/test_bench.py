"""The benchmark of acceptance fails on each goal that is missed, and keeps what failed."""

from pathlib import Path

import pytest

from acceptance.confirm import Verdict
from acceptance.generator import Design
from acceptance.trial import Refusal, Trial
from bench_acceptance import choose, judged, keep

ACCEPTED, REFUSED = Trial("a"), Trial("r", refusals=(Refusal("grid.columns", "4"),))
CONFIRMED, DENIED = Verdict(True, "confirmed"), Verdict(False, "NOT CONFIRMED")


@pytest.mark.parametrize(
    ("accepted", "verdict", "built", "code", "missed"),
    [
        (97, CONFIRMED, ACCEPTED, 0, None),
        (96, CONFIRMED, ACCEPTED, 1, "designs accepted"),
        (98, DENIED, ACCEPTED, 1, "refusals not confirmed"),
        (98, CONFIRMED, Trial("c", crash="Traceback"), 1, "crashes"),
        (98, CONFIRMED, Trial("f", failed=("mask.position",)), 1, "built designs with a failed"),
    ],
)
def test_each_goal_is_held(
    accepted: int,
    verdict: Verdict,
    built: Trial,
    code: int,
    missed: str | None,
    capsys: pytest.CaptureFixture[str],
) -> None:
    derived = [ACCEPTED] * accepted + [REFUSED] * (100 - accepted)
    assert judged(derived, [verdict], [built]) == code
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("MISSED")]
    assert [line.removeprefix("MISSED").strip().startswith(missed or "") for line in lines] == (
        [True] if missed else []
    )


def _drawn(name: str, *kinds: str) -> Design:
    return Design(name, "published", kinds, {"revision": "B"})


def test_those_built_are_of_all_kinds_of_edit() -> None:
    drawn = [_drawn(f"{i}", "grid") for i in range(50)] + [
        _drawn("s", "supply"),
        _drawn("t", "tip"),
    ]
    results = [(d, ACCEPTED) for d in drawn] + [(_drawn("r", "flex"), REFUSED)]
    chosen = choose(results, 4, seed=1)
    assert {kind for d in chosen for kind in d.kinds} == {"grid", "supply", "tip"}
    assert len({d.name for d in chosen}) == 4


def test_files_of_designs_that_fail_are_kept(tmp_path: Path) -> None:
    derived = [(_drawn("1", "names"), ACCEPTED), (_drawn("2", "names"), REFUSED)]
    built = [(_drawn("1", "names"), Trial("1", failed=("mask.position",)))]
    keep(tmp_path / "kept", derived, built)
    assert {file.name for file in (tmp_path / "kept").iterdir()} == {"1.toml", "2.toml"}
    assert 'revision = "B"' in (tmp_path / "kept" / "2.toml").read_text(encoding="utf-8")
