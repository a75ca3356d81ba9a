"""Files of goals for the published design, as tests write them."""

from pathlib import Path

PUBLISHED = Path(__file__).parents[1] / "design" / "presets" / "published.toml"


def write_goals(folder: Path, text: str, **values: object) -> Path:
    """A file of goals in a folder.

    Args:
        folder: where it is written.
        text: its tables, with `{name}` for each value and doubled braces for others.
        values: by name.
    """
    file = folder / "goals.toml"
    file.write_text(f'base = "{PUBLISHED.as_posix()}"\n{text.format(**values)}')
    return file
