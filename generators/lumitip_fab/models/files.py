"""STEP files of all packages, to which the boards' files refer, and the same as VRML."""

from collections.abc import Iterable, Iterator

from build123d import Compound

from lumitip_fab.design import Design, Footprint, footprints
from lumitip_fab.design.pcb import MODELS
from lumitip_fab.errors import BuildError
from lumitip_fab.models import connectors, shapes
from lumitip_fab.models.shapes import Named
from lumitip_fab.models.vrml import vrml
from lumitip_fab.parts import export
from lumitip_fab.pipeline.artefact import Artefact

_Held = tuple[str, Footprint]
"""Kind of a part, and its footprint."""


def model_files(design: Design) -> tuple[Artefact, ...]:
    """A STEP and a VRML file for each package, in its footprint's frame: z up from the board.

    Raises:
        BuildError: if two packages of one name have bodies of different sizes.
    """
    return tuple(
        Artefact(f"{MODELS}/{name}", data, frame="")
        for kind, shape in _different(footprints.of_design(design))
        for name, data in _written(kind, shape)
    )


def _different(held: Iterable[_Held]) -> Iterator[_Held]:
    """Each package once, by the name of its file."""
    known: dict[str, _Held] = {}
    for kind, shape in held:
        if not shape.model:
            continue
        _, first = known.setdefault(shape.model, (kind, shape))
        if (first.body, first.height_mm) != (shape.body, shape.height_mm):
            raise BuildError(
                f"two packages are called {shape.name}, with bodies of {_size(first)} and "
                f"{_size(shape)} mm; give both the same body_mm in parts/*.toml, or sizes that "
                "differ by 0.1 mm or more"
            )
    yield from (known[name] for name in sorted(known))


def _size(shape: Footprint) -> str:
    body = shape.body
    return f"{body.width_mm:g} x {body.length_mm:g} x {shape.height_mm:g}"


def _written(kind: str, shape: Footprint) -> Iterator[tuple[str, bytes]]:
    """Name and bytes of both files of a package."""
    makers = {
        "chip": lambda: shapes.chip(kind, shape),
        "array": lambda: shapes.array(shape),
        "module": lambda: shapes.module(shape),
        "leaded": lambda: shapes.leaded(shape),
        "socket": lambda: connectors.socket(shape),
        "header": lambda: connectors.header(shape),
        "springs": lambda: connectors.springs(shape),
        "box header": lambda: connectors.box_header(shape),
    }
    bodies: tuple[Named, ...] = makers[shape.form]()
    name = shape.model.removesuffix(".step")
    whole = Compound(children=[body.shape() for body in bodies])
    yield shape.model, export.step(whole, name)
    yield f"{name}.wrl", vrml(bodies)
