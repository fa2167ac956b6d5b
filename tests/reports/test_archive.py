"""All data in one file, and a page that keeps its links where it stands alone."""

from __future__ import annotations

import base64
import shutil
import zipfile
import zlib
from pathlib import Path

import pytest

from strutwork.reports.archive import ARCHIVE, carried, write_archive
from strutwork.reports.build import WrittenReport
from strutwork.reports.content import Chapter, Links, Page
from strutwork.reports.page import render
from tests.reports.browser import Browser

#: Of every file that the page links to: its name and SHA-256, as a reader would get it.
FETCHED = """
Promise.all([...document.querySelectorAll("main a[href]:not([href^='#'])")].map(async (link) => {
  const answer = await new Promise((done, fail) => {
    const asked = new XMLHttpRequest();
    asked.open("GET", link.href);
    asked.responseType = "arraybuffer";
    asked.onload = () => done(asked.response);
    asked.onerror = () => fail(new Error(link.href));
    asked.send();
  });
  let text = "";
  for (const byte of new Uint8Array(answer)) text += String.fromCharCode(byte);
  return [link.download, link.href.slice(0, 5), btoa(text)];
}))
"""


def test_the_archive_holds_every_file(any_report: WrittenReport) -> None:
    folder = any_report.report.parent
    with zipfile.ZipFile(folder / ARCHIVE) as found:
        assert found.testzip() is None
        names = found.namelist()
        assert names == sorted({p.name for p in any_report.data} - {ARCHIVE})
        assert all(found.read(n) == (folder / n).read_bytes() for n in names)


def test_equal_files_make_an_equal_archive(tmp_path: Path) -> None:
    files = []
    for name in ("b.csv", "a ü.nc"):
        files.append(tmp_path / name)
        files[-1].write_text(name * 100, encoding="utf-8")
    first = write_archive(tmp_path / "1.zip", files).read_bytes()
    # later, in another order
    files[0].touch()
    assert write_archive(tmp_path / "2.zip", reversed(files)).read_bytes() == first


def test_a_page_that_is_mailed_alone_keeps_its_links(
    browser: Browser, model_report: WrittenReport, tmp_path: Path
) -> None:
    alone = Path(shutil.copy(model_report.report, tmp_path / "mailed.html"))
    browser.open(alone, 1400, unfolded=False)
    browser.wait_for("document.documentElement.dataset.files === 'linked'")
    # the page itself may fetch nothing: the test may
    browser.send("Page.setBypassCSP", enabled=True)
    browser.open(alone, 1400, unfolded=False)
    browser.wait_for("document.documentElement.dataset.files === 'linked'")
    found = browser.evaluate(FETCHED)
    browser.send("Page.setBypassCSP", enabled=False)
    assert {name for name, _, _ in found} == {p.name for p in model_report.data}
    assert {start for _, start, _ in found} == {"blob:"}
    for name, _, content in found:
        expected = (model_report.report.parent / name).read_bytes()
        assert base64.b64decode(content) == expected, name
    assert browser.network == []


def test_what_is_too_large_to_carry_is_no_link(tmp_path: Path) -> None:
    small, large = tmp_path / "small.csv", tmp_path / "large.csv"
    small.write_text("1\n", encoding="utf-8")
    large.write_text("".join(f"{k * k}\n" for k in range(3000)), encoding="utf-8")
    archive = write_archive(tmp_path / ARCHIVE, [small, large])
    some = carried(archive, 100)
    assert set(some.names) == {"small.csv"}
    assert some.left == {"large.csv", ARCHIVE}
    links = Links((("small.csv", ""), ("large.csv", ""), (ARCHIVE, "")))
    page = render(Page("Title", "", (Chapter("files", "Files", (links,)),), ""), some)
    assert 'href="small.csv" data-file="small.csv"' in page
    for name in ("large.csv", ARCHIVE):
        assert f"{name} (in the folder of this report)" in page
        assert f'href="{name}"' not in page


@pytest.mark.parametrize("limit", [10**9, 200])
def test_what_is_carried_is_what_was_written(tmp_path: Path, limit: int) -> None:
    files = [tmp_path / name for name in ("a.csv", "ü.csv", "empty.csv")]
    for k, file in enumerate(files):
        file.write_text(f"{k},\n" * 50 * (2 - k), encoding="utf-8")
    found = carried(write_archive(tmp_path / ARCHIVE, files), limit)
    content = base64.b64decode(found.content)
    for file in files:
        start, length = found.names[file.name]
        assert zlib.decompress(content[start : start + length], -15) == file.read_bytes()
    assert (ARCHIVE in found.names) == (limit > 1000)
