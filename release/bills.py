"""CycloneDX bills of materials: software from the lock file, hardware from a built design.

    python -m release.bills outputs dist

The same input makes the same bytes: the bills have neither time nor serial number, and say so by
CycloneDX's property `cdx:reproducible`. Properties of hardware are those of its namespace
`cdx:device`; ours begin with `lumitip:`.
"""

import csv
import hashlib
import io
import json
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

from cyclonedx.model import Property
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentScope, ComponentType
from cyclonedx.model.contact import OrganizationalEntity
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from packageurl import PackageURL
from packaging.requirements import Requirement

from release.changes import ReleaseError, newest_release
from release.lock import normalised, pins

ROOT = Path(__file__).resolve().parents[1]
LOCK = "requirements.lock"
BILL = "bom.csv"
_PROPERTIES = {
    "quantity": "cdx:device:quantity",
    "unit": "lumitip:unit",
    "for": "cdx:device:function",
    "part": "lumitip:part",
}
"""Properties of a line of the bill, by its columns."""
_COLUMNS = {"group", "item", "manufacturer", *_PROPERTIES}
_CONTRIBUTORS = OrganizationalEntity(name="Lumitip contributors")


def software_bill(root: Path) -> str:
    """The package and every Python package that it or one of its extras brings, with the SHA-256 of
    the files that the lock file allows; as JSON."""
    text = (root / LOCK).read_text(encoding="utf-8")
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    required = {normalised(Requirement(line).name) for line in project["dependencies"]}
    hashes = {
        normalised(entry.partition("==")[0]): re.findall(r"sha256:([0-9a-f]{64})", entry)
        for entry in re.split(r"\n(?=\S)", text)
    }
    components = [
        Component(
            name=name,
            version=version,
            type=ComponentType.LIBRARY,
            scope=ComponentScope.REQUIRED if name in required else ComponentScope.OPTIONAL,
            purl=PackageURL("pypi", None, name, version),
            bom_ref=f"pypi/{name}",
            properties=[Property(name="lumitip:sha256", value=value) for value in hashes[name]],
        )
        for name, version in pins(text).items()
    ]
    return _written(root, ComponentType.APPLICATION, components, text)


def hardware_bill(root: Path, folder: Path) -> str:
    """Everything that one pair of fingers of a built design needs: parts, boards, prints and
    supplies, with quantity and unit; as JSON.

    Raises:
        ReleaseError: if the folder has no bill of materials, or not one of this version.
    """
    file = folder / BILL
    if not file.is_file():
        raise ReleaseError(f"{file} does not exist. Build the design first: make outputs")
    try:
        text = file.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise ReleaseError(f"{file} is no UTF-8: {error}. Run: make outputs") from error
    return _written(root, ComponentType.DEVICE, list(_bought(text, file)), text)


def _bought(text: str, file: Path) -> Iterator[Component]:
    rows = csv.DictReader(io.StringIO(text, newline=""))
    if lacking := _COLUMNS - set(rows.fieldnames or ()):
        raise ReleaseError(f"{file} has no column {', '.join(sorted(lacking))}. Run: make outputs")
    for number, row in enumerate((row for row in rows if row["group"] != "total"), start=1):
        maker = row["manufacturer"]
        yield Component(
            name=row["item"],
            group=row["group"],
            type=ComponentType.DEVICE,
            manufacturer=OrganizationalEntity(name=maker) if maker else None,
            bom_ref=f"line/{number:03}",
            properties=[
                Property(name=name, value=row[column])
                for column, name in _PROPERTIES.items()
                if row[column]
            ],
        )


def _written(root: Path, kind: ComponentType, components: list[Component], source: str) -> str:
    """A bill of the project with some components, as JSON with a line break at its end."""
    version, _ = newest_release(root)
    digest = hashlib.sha256(source.encode()).hexdigest()
    project = Component(
        name="Lumitip",
        version=version,
        type=kind,
        bom_ref="lumitip",
        supplier=_CONTRIBUTORS,
        licenses=[LicenseExpression("Apache-2.0")],
        properties=[Property(name="lumitip:source_sha256", value=digest)],
    )
    bom = Bom(components=components)
    bom.metadata.component = project
    bom.metadata.properties.add(Property(name="cdx:reproducible", value="true"))
    bom.register_dependency(project, components)
    written = json.loads(JsonV1Dot6(bom).output_as_string())
    del written["serialNumber"], written["metadata"]["timestamp"]
    return json.dumps(written, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def main(outputs: Path, folder: Path) -> int:
    """Write both bills; returns 0, 1 if the design was not built."""
    try:
        version, _ = newest_release(ROOT)
        bills = {"software": software_bill(ROOT), "hardware": hardware_bill(ROOT, outputs)}
    except ReleaseError as error:
        print(error, file=sys.stderr)
        return 1
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in bills.items():
        file = folder / f"lumitip-{version}-{name}.cdx.json"
        file.write_text(text, encoding="utf-8")
        print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
