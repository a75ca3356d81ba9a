"""The manual's step of measuring the gripper and its coupling before parts are printed for them."""

from collections.abc import Iterator

from lumitip_fab.design import Design, Flange, Unsure
from lumitip_fab.docs.gripper_cable import gripper_cable
from lumitip_fab.text import as_written, passage, table_of

_GRIPPERS, _OTHERS = "grippers/texts.toml", "docs/measuring.toml"
_BODY = "holder.body_mm"
_GRIPPER_FILE, _COUPLING_FILE = "grippers.toml", "couplings.toml"


def measuring(design: Design) -> str:
    """The step: each figure that is not sure, with what the design uses, and how to measure it."""
    mount = design.mount
    places = [f"`{_GRIPPER_FILE}` below `[{mount.gripper}]`"] * bool(mount.to_measure)
    for flange in design.flanges:
        place = f'`{_COUPLING_FILE}` below `["{flange.coupling}"]`'
        places += [place] * bool(_of_coupling(flange))
    return _text(
        "measured_first",
        rows="\n".join(_rows(design)),
        title=as_written(mount.title),
        written=_text("measured_in", places=" or ".join(places)) + " " if places else "",
        gripper_cable="".join(gripper_cable(design) for _ in design.flanges),
    )


def _rows(design: Design) -> Iterator[str]:
    """The finger bolts, then the figures of gripper, body and coupling."""
    mount, texts = design.mount, table_of(_OTHERS)
    bolt = f"{mount.bolt} x {mount.bolt_length_mm:g}, {mount.into_gripper_mm:.1f} mm into it"
    yield _row("depth of the gripper's thread", bolt, texts["depth"], "no file")
    how = table_of(_GRIPPERS)["figures"]
    for figure in mount.to_measure:
        yield _figure(figure, how[figure.name] + _others(figure), f"`{_GRIPPER_FILE}`")
    for figure in _body(design):
        yield _figure(figure, texts["body"], "the parameter file")
    for flange in design.flanges:
        for figure in _of_coupling(flange):
            yield _figure(figure, texts["coupling"][figure.name], f"`{_COUPLING_FILE}`")


def _others(figure: Unsure) -> str:
    """Values of the figures that it is measured from."""
    return "".join(f" Here `{name}` is {value}." for name, value in figure.others)


def _of_coupling(flange: Flange) -> list[Unsure]:
    """Figures that parts are printed by."""
    return [figure for figure in flange.unsure if figure.measured]


def _body(design: Design) -> list[Unsure]:
    """The gripper's diameter where a holder clips on it by the gripper's entry; else nothing."""
    system = design.system
    return [
        Unsure(_BODY, f"{holder.body_mm:g} mm", system.confidence)
        for holder in design.holders
        if holder.body_from != _BODY and not system.body_is_known
    ]


def _figure(figure: Unsure, how: str, file: str) -> str:
    return _row(f"`{figure.name}`", f"{figure.value}, {figure.confidence}", how, file)


def _row(figure: str, value: str, how: str, file: str) -> str:
    return f"| {figure} | {value} | {how} | {file} |"


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
