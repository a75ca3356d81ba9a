"""The tables of the page, and what everyone needs who reads it."""

import csv
import json
import os
import re
import subprocess
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest

from lumitip_fab.checks.manifest import measure
from lumitip_fab.cli import main
from lumitip_fab.design.encoding import read_design
from lumitip_fab.diff.folder import read_folder
from lumitip_fab.site.checks import check_rows
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.tables import prints, unmarked
from lumitip_fab.site.targets import Targets
from site_page import SIZES, Opened, axe

pytestmark = pytest.mark.slow

MOST_BYTES = 8_000_000


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_everyone_can_read_it(opened: Opened, size: str, scheme: str) -> None:
    tab = opened("#cell-17", viewport=SIZES[size], color_scheme=scheme)
    assert tab.evaluate("document.documentElement.scrollWidth") <= SIZES[size]["width"]
    tab.evaluate(axe())
    found = tab.evaluate("axe.run()")
    assert [(v["id"], v["nodes"][0]["target"]) for v in found["violations"]] == []
    assert len(found["passes"]) > 20


def test_a_long_name_does_not_widen_the_page(opened: Opened) -> None:
    tab = opened("", viewport=SIZES["phone"], is_mobile=True, has_touch=True)
    tab.evaluate("document.querySelector('h1').textContent = 'M'.repeat(32)")
    assert tab.evaluate("document.documentElement.scrollWidth") <= SIZES["phone"]["width"]


def test_it_is_one_small_file(site: Path) -> None:
    page = site / "index.html"
    assert 500_000 < page.stat().st_size < MOST_BYTES
    text = page.read_text(encoding="utf-8")
    elements = " ".join(re.findall(r"<\w+ [^>]*>|<style>.*?</style>", text, re.DOTALL))
    assert not re.findall(r"\b(?:src|srcset)=|@import|url\((?!#)|type=.?module", elements)


def test_every_link_leads_to_a_file(site: Path) -> None:
    text = (site / "index.html").read_text(encoding="utf-8")
    links = {unquote(unescape(link)) for link in re.findall(r'<a [^>]*href="([^"]+)"', text)}
    files = {link for link in links if not link.startswith("#")}
    assert len(files) > 200
    assert [link for link in files if not (site / link).is_file()] == []
    ids = set(re.findall(r'\bid="([^"]+)"', text))
    assert {link[1:] for link in links if link.startswith("#")} <= ids


def test_every_check_has_its_value_limit_and_margin(opened: Opened, site: Path) -> None:
    report = _report(site)["measurements"]
    tab = opened()
    tab.locator("#more").click()
    while tab.locator("#more").is_visible():
        tab.locator("#more").click()
    rows = tab.evaluate(
        """[...document.querySelectorAll("#check-table tbody tr")].map(
        r => [...r.cells].map(c => c.textContent))"""
    )
    assert len(rows) == len(report)
    assert {(row[0], row[1]) for row in rows} == {(e["check"], e["subject"]) for e in report}
    wall = next(r for r in rows if r[:2] == ["holder.grip", "holder/holder.stl"])
    entry = next(e for e in report if e["check"] == "holder.grip")
    assert wall[2] == f"{entry['measured']:.4g} mm"
    assert wall[3] == f"≥ {entry['low']:g}"
    assert wall[4] == f"{entry['margin']:.4g} mm"


def test_checks_are_filtered_and_sorted(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("HOLDER.grip stl")
    names = tab.locator("#check-table tbody td:first-child").all_text_contents()
    assert names == ["holder.grip"]
    tab.locator("#query").fill("mould.thickness")
    assert tab.locator("#check-table tbody tr").count() == 2
    tab.locator("#query").fill("")
    tab.locator("#kind").select_option("failed")
    assert tab.locator("#check-table tbody tr").count() == 0
    tab.locator("#kind").select_option("all")
    tab.locator("#check-table thead button").first.click()
    tab.locator("#check-table thead button").first.click()
    names = tab.locator("#check-table tbody td:first-child").all_text_contents()
    assert names == sorted(names, reverse=True)
    assert tab.locator("#check-table th").first.get_attribute("aria-sort") == "descending"


def test_a_range_in_words_has_no_order(opened: Opened) -> None:
    heads = opened().locator("#check-table th")
    named = dict(zip(heads.all_text_contents(), heads.all(), strict=True))
    buttons = {name for name, head in named.items() if head.locator("button").count()}
    assert set(named) - buttons == {"limit", "place"}
    assert named["limit"].get_attribute("aria-sort") is None


def _report(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "checks.json").read_text(encoding="utf-8")))


def _change(folder: Path, check: str, **values: object) -> None:
    """Change a measurement of the report."""
    report = _report(folder)
    next(e for e in report["measurements"] if e["check"] == check).update(values)
    (folder / "checks.json").write_text(json.dumps(report), encoding="utf-8")


def test_a_failed_check_is_first(edited: Path, opened: Opened) -> None:
    _change(edited, "holder.grip", measured=0.1, margin=-0.15, passed=False)
    assert main(["page", "--quiet", "--out", str(edited)]) == 0
    tab = opened("", edited)
    assert "1 of " in str(tab.locator(".answer.bad .big").text_content())
    first = tab.locator("#check-table tbody td").first.text_content()
    assert first == "holder.grip fails"


def test_a_check_that_passed_without_a_figure_passes(edited: Path) -> None:
    """A figure beyond all limits, such as a clearance to nothing, is null in the report."""
    _change(edited, "holder.grip", measured=None, margin=None)
    folder = Folder.of(edited)
    row = next(
        row for row in check_rows(folder, Targets(folder, ())) if row["check"] == "holder.grip"
    )
    assert row["passed"] and row["value"] == "none"


def _quality(folder: Path) -> str:
    """What the head of a page says of the checks."""
    assert main(["page", "--quiet", "--out", str(folder)]) == 0
    text = (folder / "index.html").read_text(encoding="utf-8")
    return re.sub("<[^>]+>", " ", text.partition("How good is it?")[2].partition("</div>")[0])


def test_only_a_report_of_these_files_counts(edited: Path) -> None:
    assert "checks pass" in _quality(edited)
    header = edited / "firmware/layout.h"
    text = header.read_text(encoding="utf-8")
    header.write_text(text + "\n", encoding="utf-8")
    quality = " ".join(_quality(edited).split())
    assert quality.startswith("Not checked since the files changed Run make outputs;")
    header.write_text(text, encoding="utf-8")
    assert "checks pass" in _quality(edited)
    (edited / "checks.json").unlink()
    assert " ".join(_quality(edited).split()).startswith("Not checked Run make outputs;")


def test_a_row_shows_its_parts_and_goes_back(opened: Opened) -> None:
    tab = opened()
    button = tab.get_by_role("button", name="Show circuit 74HC4051PW")
    button.click()
    lit = tab.evaluate("[...document.querySelectorAll('.part.lit')].map(e => e.dataset.part)")
    assert lit == ["receiver.U1", "receiver.U2", "receiver.U3", "receiver.U4"]
    assert tab.locator("#shown").is_visible()
    tab.keyboard.press("Escape")
    assert tab.locator(".lit").count() == 0
    assert tab.evaluate("document.activeElement.textContent") == "show"
    assert not tab.locator("#shown").is_visible()


def test_a_sorted_table_keeps_what_is_shown(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("holder.grip")
    tab.locator("#check-table tbody .show").click()
    tab.locator("#check-table thead button").first.click()
    pressed = tab.locator("#check-table .show[aria-pressed=true]")
    assert pressed.count() == 1
    tab.locator("#query").press("Escape")
    assert tab.locator("#shown").is_visible()
    tab.locator("#query").fill("mould.thickness")
    assert pressed.count() == 0
    tab.locator("#query").fill("holder.grip")
    pressed.focus()
    tab.keyboard.press("Escape")
    assert not tab.locator("#shown").is_visible()
    label = "document.activeElement.getAttribute('aria-label')"
    assert str(tab.evaluate(label)).startswith("Show holder.grip of ")
    tab.locator("#check-table tbody .show").click()
    tab.locator("#query").fill("mould.thickness")
    tab.locator("#shown-back").click()
    assert tab.evaluate("document.activeElement.id") == "query"


def test_the_head_has_the_whole_time_and_both_sums(opened: Opened, site: Path) -> None:
    answers = opened().locator(".answer").all_text_contents()
    minutes = sum(part.minutes * part.number for part in prints(Folder.of(site)))
    hours, rest = divmod(round(minutes), 60)
    assert hours and f"{hours} h {rest:02d} min of printing" in answers[1]
    with (site / "order.csv").open(encoding="utf-8", newline="") as file:
        packs = float(list(csv.DictReader(file))[-1]["price"])
    assert f"{packs:.0f} EUR if whole packs are bought." in answers[0]


def test_the_order_comes_after_what_nobody_has_measured(opened: Opened, site: Path) -> None:
    """The marked ends of the published LED and photodetector are inferred."""
    tab = opened()
    (first,) = (t for t in tab.locator(".answer").all_text_contents() if "What is first?" in t)
    assert "Measure, then order" in first and "an LED and a photodetector" in first
    stop = str(tab.locator("#boards .stop").text_content())
    assert stop.startswith("Stop: ") and "an LED and a photodetector" in stop
    folder = Folder.of(site)
    packages = folder.design.packages
    led, detector = (
        part.model_copy(update={"marked_confidence": "measured"})
        for part in (packages.led, packages.photodetector)
    )
    known = replace(packages, led=led, photodetector=detector)
    design = replace(folder.design, packages=replace(packages, led=led))
    assert unmarked(replace(folder, design=design)) == ["a photodetector"]
    assert unmarked(replace(folder, design=replace(design, packages=known))) == []


def test_every_line_of_the_bill_and_every_print_is_there(opened: Opened, site: Path) -> None:
    tab = opened()
    with (site / "bom.csv").open(encoding="utf-8", newline="") as file:
        bill = list(csv.DictReader(file))
    rows = tab.evaluate(
        "[...document.querySelectorAll('#bill tbody tr')].map(r => [...r.cells].map(c => "
        "c.textContent))"
    )
    assert [(r[0], r[1], r[5]) for r in rows] == [
        (line["group"], line["item"], line["price"]) for line in bill[:-1]
    ]
    assert bill[-1]["price"] in str(tab.locator("#bill strong").text_content())
    prints = tab.locator("#prints tbody td:first-child").all_text_contents()
    listed = [line["item"] for line in bill if line["group"] == "prints"]
    assert sorted(prints) == sorted(listed)
    minutes = next(line for line in bill if line["item"] == "holder/holder.stl")["for"]
    hours = tab.locator("#prints tr", has_text="holder/holder.stl").locator("td").nth(3)
    found = re.search(r"some (\d+) min", minutes)
    assert found
    assert hours.text_content() == "{} h {:02d} min".format(*divmod(int(found[1]), 60))


def test_the_page_is_no_part_of_the_build(site: Path) -> None:
    design = read_design(site / "design.json")
    assert all(m.passed for m in measure(site, design))
    assert "index.html" not in read_folder(site, "site").sha256


def test_make_outputs_ends_with_the_page(
    edited: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a check that fails the page is written too, and `make` fails. No report of files that
    were there before is left."""
    assert main(["page", "--out", str(edited)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"open {edited}/index.html in a browser"
    environment = {k: v for k, v in os.environ.items() if k not in {"MAKEFLAGS", "MAKELEVEL"}}
    program = tmp_path / "lumitip-fab"
    program.write_text('#!/bin/sh\necho $1; test "$1" != check || exit $FAKE\n')
    program.chmod(0o755)
    old = [tmp_path / "out/checks.json", tmp_path / "out/checks.xml"]
    old[0].parent.mkdir()
    variables = [f"BIN={tmp_path}", f"FAB={program}", f"OUT={old[0].parent}"]
    for code in (0, 1):
        for report in old:
            report.touch()
        made = subprocess.run(
            ["make", "--no-print-directory", "outputs", *variables],
            cwd=Path(__file__).parents[2],
            env={**environment, "FAKE": str(code)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert made.stdout.splitlines()[:3] == ["build", "check", "page"]
        assert (made.returncode == 0) == (code == 0)
        assert not any(report.exists() for report in old)


def test_a_folder_that_is_none_is_refused(
    tmp_path: Path, edited: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["page", "--out", str(tmp_path)]) == 2
    assert "has no usable manifest.json" in capsys.readouterr().err
    (edited / "checks.json").write_text("[{}]", encoding="utf-8")
    assert main(["page", "--out", str(edited)]) == 2
    assert "checks.json: cannot be read" in capsys.readouterr().err
    (edited / "bom.csv").unlink()
    assert main(["page", "--out", str(edited)]) == 2
    assert "files are missing, such as bom.csv" in capsys.readouterr().err
