"""TOML with its lines: every way of writing a value is found again, and nothing escapes."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumitip_fab.config.source import DEEPEST, flat, read_toml
from lumitip_fab.errors import InputError
from lumitip_fab.paths import LARGEST_INPUT_BYTES

TEXT = '''\
# a comment with key = 1
top = 1
"quoted" = 2
a.b.c = 3

[ table ]   # with a comment
key = """
[not_a_table]
other = 4
"""
list = [
  1,  # first = 1
  2,
]
inline = { x = 1, y = [1, 2] }

[table."inner one"]
key = 'text = [1'

[[many]]
n = 1
[[many]]
n = 2
'''


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A file with every way of writing."""
    path = tmp_path / "x.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("dotted", "line"),
    [
        ("top", 2),
        ("quoted", 3),
        ("a.b.c", 4),
        ("a.b", 4),
        ("a.b.other", 4),
        ("table", 6),
        ("table.key", 7),
        ("table.list", 11),
        ("table.list.1", 11),
        ("table.inline.x", 15),
        ("table.inner one.key", 18),
        ("table.missing", 6),
        ("many.n", 21),
        ("unknown", 1),
        ("not_a_table", 1),
        ("table.other", 6),
    ],
)
def test_a_field_is_found_on_its_line_or_on_that_of_the_table_around_it(
    file: Path, dotted: str, line: int
) -> None:
    assert read_toml(file, "x.toml").line(dotted) == line


def test_whether_a_file_sets_a_field_does_not_depend_on_how_it_is_written(file: Path) -> None:
    source = read_toml(file, "x.toml")
    for field in ("top", "a.b.c", "table", "table.inline.x", "table.inline.y.1", "many.0.n"):
        assert source.sets(field), field
    for field in ("a.b.d", "table.inline.z", "table.inline.y.2", "not_a_table", "top.x", "many.n"):
        assert not source.sets(field), field


def test_leaves_are_named_by_their_place() -> None:
    assert flat({"a": {"b": [1, [2]]}, "c": "x"}) == [("a.b.0", 1), ("a.b.1.0", 2), ("c", "x")]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_windows_files_are_read_like_others(tmp_path: Path, end: str, mark: bytes) -> None:
    path = tmp_path / "x.toml"
    path.write_bytes(mark + TEXT.replace("\n", end).encode())
    source = read_toml(path, "x.toml")
    assert source.line("table.list") == 11
    assert source.table["top"] == 1


def _refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_toml(path, "x.toml")
    return str(caught.value)


def test_files_that_cannot_be_read_are_refused_with_the_reason(tmp_path: Path) -> None:
    assert _refused(tmp_path / "none.toml") == "x.toml: cannot be read: No such file or directory"
    assert "cannot be read: it is a folder, and a file is needed" in _refused(tmp_path)
    assert "is not a valid file name" in _refused(Path("a\0b.toml"))


def test_a_file_too_large_is_not_parsed(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text("#" + "x" * LARGEST_INPUT_BYTES, encoding="utf-8")
    assert _refused(path) == (
        f"x.toml: cannot be read: it has {LARGEST_INPUT_BYTES + 1} bytes, and at most "
        f"{LARGEST_INPUT_BYTES} are allowed"
    )
    path.write_text("#" + "x" * (LARGEST_INPUT_BYTES - 1), encoding="utf-8")
    assert read_toml(path, "x.toml").table == {}


def test_tables_and_lists_are_read_to_a_depth_and_refused_beyond_it(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(f"a = {'[' * (DEEPEST - 1)}{']' * (DEEPEST - 1)}", encoding="utf-8")
    read_toml(path, "x.toml")
    for deep in (DEEPEST, 100, 3000):
        for text in (f"a = {'[' * deep}{']' * deep}", f"[{'.'.join(['a'] * deep)}]\nx = 1"):
            path.write_text(text, encoding="utf-8")
            assert "nested deeper than" in _refused(path)


def test_random_bytes_are_read_or_refused_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    toml = st.lists(
        st.sampled_from(
            [
                "[",
                "]",
                "[[",
                "]]",
                "=",
                ".",
                ",",
                "{",
                "}",
                "\n",
                '"',
                "'",
                '"""',
                "#",
                " ",
                "a",
                "grid",
                "1",
                "-",
                "_",
                "e9",
                "nan",
                "true",
                "0x",
                "\\",
                "\r\n",
                "é",
                "2020-01-01",
            ]
        ),
        max_size=40,
    ).map(lambda parts: "".join(parts).encode())

    @settings(
        max_examples=250,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.one_of(st.binary(max_size=60), toml))
    def attempt(data: bytes) -> None:
        path.write_bytes(data)
        try:
            source = read_toml(path, "x.toml")
        except InputError as error:
            assert all(p.file == "x.toml" for p in error.problems)
            assert "\n" not in str(error)
        else:
            for name, _ in flat(source.table):
                assert 1 <= source.line(name) <= data.count(b"\n") + 1

    attempt()
