"""Scripts from elsewhere that the page has inside: three.js, as the installed trimesh brings it,
with its licence; and the colours of the live view."""

import zipfile
from importlib.resources import files

from lumitip_fab.errors import OutputError
from lumitip_fab.text import data_file

_BEGIN, _END = "/**\n * @license\n", 'Object.defineProperty(t,"__esModule",{value:!0})}));'
"""Begin and end of the library in the viewer of trimesh."""
_RESOURCE = "resources/templates/viewer.zip"


def three_js() -> str:
    """The library as a script that defines `THREE`.

    Raises:
        OutputError: if the installed trimesh does not have it.
    """
    try:
        with files("trimesh").joinpath(_RESOURCE).open("rb") as file, zipfile.ZipFile(file) as kept:
            viewer = kept.read("viewer.html.template").decode()
        begin = viewer.index(_BEGIN)
        script = viewer[begin : viewer.index(_END, begin) + len(_END)]
    except (OSError, KeyError, ValueError, zipfile.BadZipFile) as error:
        raise OutputError(
            f"trimesh: its viewer has no three.js ({error!s:.100}); a version as in "
            "constraints.txt is needed. Install trimesh with it."
        ) from error
    return f"/*\n{data_file('site/three_licence.txt')}*/\n{script}".replace("</", "<\\/")


def colour_ramp() -> str:
    """The colours of values in the live view, as a script that defines `RAMP`."""
    script = files("lumitip").joinpath("view/static/ramp.js").read_text(encoding="utf-8")
    return script.replace("export const ", "const ")
