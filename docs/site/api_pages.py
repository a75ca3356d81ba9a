"""The reference of the public names of both packages, from their docstrings.

Public is what the `__all__` of a package lists. mkdocstrings reads the source files; nothing is
imported.
"""

import ast
from collections.abc import Iterator

from markdown_text import table
from repository_pages import ROOT

FOLDER = "reference/api"
PACKAGES = [ROOT / "generators/lumitip_fab", *sorted((ROOT / "readout/lumitip").glob("**"))]
_INTRO = "# Python packages\n\nWhat `__all__` lists is public; all else may change.\n\n"


def api_pages() -> Iterator[tuple[str, str]]:
    """Path and Markdown of the page of each package, and of their list."""
    rows = []
    for name, (text, names) in packages().items():
        first, _, example = text.partition("\n")
        shown = f"```python\n{example.strip()}\n```\n\n" if " = " in example else ""
        listed = "".join(f"::: {name}.{each}\n\n" for each in names)
        yield f"{FOLDER}/{name}.md", f"# {name}\n\n{first}\n\n{shown}{listed}"
        rows.append([f"[{name}]({name}.md)", first])
    yield f"{FOLDER}/index.md", _INTRO + table(("package", "about"), rows)


def packages() -> dict[str, tuple[str, list[str]]]:
    """Docstring and public names of each package that has some."""
    found = {}
    for folder in PACKAGES:
        file = folder / "__init__.py"
        if not file.is_file():
            continue
        tree = ast.parse(file.read_text("utf-8"))
        names = _public(tree)
        if names:
            root = folder.relative_to(ROOT).parts[1:]
            found[".".join(root)] = (ast.get_docstring(tree) or "", names)
    return found


def _public(tree: ast.Module) -> list[str]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return list(ast.literal_eval(node.value))
    return []
