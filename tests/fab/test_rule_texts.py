"""Every rule that derivation refuses with has its sentence, and gives it every value it names."""

import ast
import string
from pathlib import Path

import lumitip_fab
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.text import table_of

RULES = table_of("derive/rules.toml")
DERIVE = Path(lumitip_fab.__file__).parent / "derive"


def _refusals() -> list[tuple[str, str, set[str]]]:
    """File, rule and names of the values of each call of `Diagnostics.unless` and `add`. A call
    whose rule is a variable stands for every rule that its file names elsewhere."""
    found = []
    for file in sorted(DERIVE.rglob("*.py")):
        nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
        constants = {node.value for node in nodes if isinstance(node, ast.Constant)}
        calls = [_called(node) for node in nodes if isinstance(node, ast.Call)]
        named = {rule.value for rule, _ in calls if isinstance(rule, ast.Constant)}
        for rule, names in calls:
            if isinstance(rule, ast.Constant):
                found += [(file.name, rule.value, names)] if rule.value in RULES else []
            elif isinstance(rule, ast.Attribute) and rule.attr == "rule":
                found += [
                    (file.name, each, names) for each in sorted(RULES.keys() & constants - named)
                ]
    return found


def _called(node: ast.Call) -> tuple[ast.expr | None, set[str]]:
    """What may be the rule of a call, and the names of its values."""
    place = {"unless": 1, "add": 0}.get(getattr(node.func, "attr", ""), len(node.args))
    rule = node.args[place] if place < len(node.args) else None
    return rule, {str(k.arg) for k in node.keywords}


def _braces(text: str) -> list[list[str]]:
    """Value and attributes of each pair of braces."""
    fields = (field for _, field, _, _ in string.Formatter().parse(text) if field)
    return [field.partition("[")[0].split(".") for field in fields]


def _wanted(text: str) -> set[str]:
    return {field[0] for field in _braces(text)}


def test_every_value_of_a_sentence_has_its_argument() -> None:
    refusals = _refusals()
    assert len(refusals) > 100
    for file, rule, names in refusals:
        missing = _wanted(RULES[rule]["text"]) - names - {"p"}
        assert not missing or "None" in names, f"{file}: {rule} lacks {missing}"


def test_every_sentence_belongs_to_a_rule() -> None:
    assert {rule for _, rule, _ in _refusals()} == set(RULES)


def test_every_parameter_of_a_sentence_exists() -> None:
    named = [
        names[1:] for rule in RULES.values() for names in _braces(rule["text"]) if names[0] == "p"
    ]
    assert len(named) > 50
    for section, *key in named:
        table = Parameters.model_fields[section]
        assert not key or key[0] in table.annotation.model_fields, f"{section}.{key}"
