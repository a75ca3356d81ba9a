"""The documentation site: it builds without a warning, opens from a folder, and leaves out no
page. A damage in a page fails the build."""

import shutil
from pathlib import Path
from typing import Any

import markdown
import pytest
from lxml import html
from markdown_it import MarkdownIt
from playwright.sync_api import sync_playwright

from documentation_site import CONFIG, build_site, nav_pages
from markdown_pages import PAGES, ROOT, links
from programs import program
from repository_pages import PROJECT, linked, page_of, rewritten
from site_page import axe

pytestmark = pytest.mark.slow

EXTENSIONS = [next(iter(e)) if isinstance(e, dict) else e for e in CONFIG["markdown_extensions"]]
INDEX = ROOT / "docs/index.md"
SHOWN = (
    *("index.html", "making.html", "reading.html", "tutorials/change_grid.html"),
    *("gallery.html", "reference/parameters.html", "reference/api/lumitip.twin.html"),
)
RUN_AXE = "axe.run({preload: false, rules: {'empty-table-header': {enabled: false}}})"
"""Without the rule that every column has a heading: Markdown has no table without headings."""
SIZES = {"phone": {"width": 390, "height": 844}, "desk": {"width": 1440, "height": 900}}


def test_the_site_builds_without_a_warning(doc_site: Path) -> None:
    for uri in nav_pages():
        built = uri.replace("README.md", "index.md").replace(".md", ".html")
        assert (doc_site / built).is_file(), uri


DAMAGES = {
    "](start.md)": ("](begin.md)", "'begin.md'"),
    "](../SECURITY.md)": ("](../SAFETY.md)", "'../SAFETY.md'"),
    "estimation.md#accuracy": ("estimation.md#exactness", "'#exactness'"),
}
"""Places of the map, what they are replaced by, and what the build says of it."""


def test_damaged_pages_fail_the_build(tmp_path: Path) -> None:
    """Links to nowhere, a missing anchor, and a page that the navigation lacks."""
    root = tmp_path / "repository"
    ignored = shutil.ignore_patterns("__pycache__")
    for folder in ("docs", "design", "examples", "generators", "readout"):
        shutil.copytree(ROOT / folder, root / folder, ignore=ignored)
    for name in ("mkdocs.yml", "CITATION.cff", "LICENSE", *PROJECT):
        (root / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, root / name)
    index = root / "docs/index.md"
    text = index.read_text("utf-8")
    for old, (new, _) in DAMAGES.items():
        assert old in text
        text = text.replace(old, new, 1)
    index.write_text(text, "utf-8")
    (root / "docs/forgotten.md").write_text("# A page that the navigation lacks\n", "utf-8")
    done = build_site(root, tmp_path / "out")
    assert done.returncode != 0
    said = done.stdout + done.stderr
    for _, warning in DAMAGES.values():
        assert warning in said
    assert "forgotten.md" in said
    assert "Aborted with 4 warnings" in said


def test_the_navigation_has_every_page_in_the_order_of_the_map() -> None:
    pages = [page for page in PAGES if page != INDEX]
    uris = {page: page_of(page) or page.relative_to(ROOT / "docs").as_posix() for page in pages}
    text = INDEX.read_text("utf-8")
    tables = text.partition("\n## ")[2]
    files = [(INDEX.parent / link.file).resolve() for link in links(tables) if link.file]
    in_order = [uris[file] for file in dict.fromkeys(files)]
    shown = [uri for uri in nav_pages() if uri in set(uris.values())]
    assert shown == in_order
    assert set(shown) == set(uris.values())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_site_shows_a_page_as_github_does(page: Path) -> None:
    """Lists, tables and text are the same by CommonMark and by the parser of the site."""
    text = page.read_text("utf-8")
    assert _structure(_of_site(text)) == _structure(_of_github(text))


def test_a_list_that_the_site_would_not_show_is_found() -> None:
    text = "Two things:\n- one\n- the other\n"
    assert _structure(_of_site(text)) != _structure(_of_github(text))


def _of_github(text: str) -> Any:
    return html.fromstring(f"<div>{MarkdownIt('commonmark').enable('table').render(text)}</div>")


def _of_site(text: str) -> Any:
    shown = markdown.markdown(text, extensions=EXTENSIONS)
    return html.fromstring(f"<div>{shown}</div>")


def _structure(tree: Any) -> tuple[str, list[tuple[str, int]]]:
    for permalink in tree.xpath("//a[@class='headerlink']"):
        permalink.drop_tree()
    tags = ("h1", "h2", "h3", "h4", "ol", "ul", "li", "table", "tr", "td", "th", "a", "img", "em")
    counted = [(tag, len(tree.findall(f".//{tag}"))) for tag in tags]
    return "".join(tree.text_content().split()), counted


def test_links_out_of_the_docs_lead_to_pages_of_the_site() -> None:
    page = ROOT / "docs/reading.md"
    text = "[a](view.md) [b](../examples) [c](../LICENSE#1) [d](none.md) `[e](../LICENSE)`\n"
    assert linked(text, page) == {page.with_name("view.md"), ROOT / "examples", ROOT / "LICENSE"}
    assert rewritten(text, page, "reading.md") == (
        "[a](view.md) [b](source/examples/index.md) [c](source/LICENSE.md#1) [d](none.md) "
        "`[e](../LICENSE)`\n"
    )
    readme = ROOT / "readout/ros2/README.md"
    moved = rewritten("[a](../../docs/view.md)", readme, "project/readout/ros2/README.md")
    assert moved == "[a](../../../view.md)"


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_opens_from_a_folder_without_a_network(doc_site: Path, size: str, scheme: str) -> None:
    said: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program("chromium"), args=["--no-sandbox"]
        )
        context = browser.new_context(
            offline=True, color_scheme=scheme, viewport=SIZES[size], reduced_motion="reduce"
        )
        tab = context.new_page()
        tab.on("console", lambda message: said.append(message.text))
        tab.on("pageerror", lambda error: said.append(str(error)))
        tab.on("request", lambda request: said.append(request.url))
        for name in SHOWN:
            tab.goto((doc_site / name).as_uri())
            assert tab.evaluate("document.documentElement.scrollWidth") <= SIZES[size]["width"]
            assert tab.locator("body").get_attribute("data-md-color-scheme") == {
                "light": "default",
                "dark": "slate",
            }.get(scheme)
            tab.evaluate(axe())
            violations = tab.evaluate(RUN_AXE)["violations"]
            assert [(v["id"], v["nodes"][0]["target"]) for v in violations] == []
        if size == "desk":
            tab.locator("input.md-search__input").press_sequentially("multiplexer")
            found = tab.locator(".md-search-result__item")
            found.nth(3).wait_for()
            assert "multiplexer" in found.first.inner_text().lower()
        browser.close()
    local = ("file:", "data:", "blob:", "about:")
    assert [text for text in said if not text.startswith(local)] == []
