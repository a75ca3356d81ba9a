"""A tape or a glue by which the silicone does not cure, and a missing primer, are refused."""

from dataclasses import replace
from typing import Any

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.errors import InputError


def with_part(config: Input, field: str, **changes: Any) -> Input:
    """The same parameters with another entry of the catalogue in place of a named one."""
    section, key = field.split(".")
    parts = getattr(config.parts, section)
    entry = getattr(parts, key).model_copy(update=changes)
    name = getattr(getattr(config.parameters, section), key)
    kind = {"mould.tape": "tapes", "mould.silicone": "silicones", "backing.glue": "adhesives"}[
        field
    ]
    entries = {**getattr(config.catalogue, kind), name: entry}
    return replace(config, catalogue=config.catalogue.model_copy(update={kind: entries}))


def refused(config: Input) -> list[str]:
    with pytest.raises(InputError) as caught:
        derive(config)
    return [f"{problem.field}: {problem.text}" for problem in caught.value.problems]


def test_tape_and_glue_of_every_preset_let_the_silicone_cure(inputs: dict[str, Input]) -> None:
    for config in inputs.values():
        parts, tape = config.parts, config.parts.mould.tape
        assert parts.mould.primer is not None
        assert not {*tape.gives_off} & {*parts.mould.silicone.inhibited_by}
        glue = parts.backing.glue
        harmless = not {*glue.gives_off} & {*parts.mould.silicone.inhibited_by}
        assert harmless or glue.hard_h or config.parameters.backing.variant == "flex"


def test_every_silicone_of_the_catalogue_lists_what_stops_its_cure(
    inputs: dict[str, Input],
) -> None:
    for silicone in inputs["published"].catalogue.silicones.values():
        named = {"sulphur", "latex", "amine", "uncured polyurethane", "PVC"}
        assert named <= {*silicone.inhibited_by}
        assert silicone.needs_primer


def test_masking_tape_is_refused(inputs: dict[str, Input]) -> None:
    config = with_part(inputs["published"], "mould.tape", gives_off=("masking tape adhesive",))
    (problem,) = refused(config)
    assert "Solaris does not cure beside it" in problem and problem.startswith("mould.tape")


def test_a_silicone_that_masking_tape_does_not_inhibit_takes_it(inputs: dict[str, Input]) -> None:
    config = with_part(inputs["published"], "mould.tape", gives_off=("masking tape adhesive",))
    assert derive(with_part(config, "mould.silicone", inhibited_by=("sulphur",)))


def test_a_glue_that_never_gets_harmless_is_refused_in_a_pocket(
    inputs: dict[str, Input], vary: Any
) -> None:
    (problem,) = refused(vary(inputs["published"], {"backing.glue": "polyurethane"}))
    assert problem.startswith("backing.glue") and "gives off uncured polyurethane" in problem
    assert inputs["flex"].parameters.backing.glue == "polyurethane"
    assert derive(vary(inputs["flex"], {"backing.glue": "polyurethane"})), "behind the plate"


def test_a_silicone_without_its_primer_is_refused(inputs: dict[str, Input], vary: Any) -> None:
    (problem,) = refused(vary(inputs["published"], {"mould.primer": "none"}))
    assert problem.startswith("mould.primer") and "do not hold" in problem
