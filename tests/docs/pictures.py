"""The pictures of the tutorials and the gallery: `python -m tests.docs.pictures [NAME ...]`.

A tutorial's pictures are of what its reader has made at its end; the page is followed in an empty
folder first. A gallery's picture is the example's own drawing. All are of few colours, to be small.
"""

from __future__ import annotations

import base64
import io
import sys
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image, ImageChops, ImageOps

import strutwork
from tests.docs.examples import EXAMPLES, Example
from tests.docs.markdown import ROOT
from tests.docs.tutorial import TUTORIALS, Session
from tests.reports.browser import Browser, chromium

IMAGES = ROOT / "docs" / "images"
SIZE = (1300, 1000)

#: By picture: the tutorial, what of it, and how it is drawn; "report" is a report as it opens.
OF_TUTORIALS: dict[str, tuple[str, str, dict[str, Any] | str]] = {
    "tutorial-1-head": ("01-three-rps", "head.toml", {}),
    "tutorial-1-report": ("01-three-rps", "out/head/report.html", "report"),
    "tutorial-2-gantry": ("02-gantry-on-granite", "gantry.toml", {}),
    "tutorial-2-report": ("02-gantry-on-granite", "out/gantry/report.html", "report"),
    "tutorial-3-hexapod": ("03-hexapod-with-bearings", "hexapod.toml", {}),
    "tutorial-3-report": ("03-hexapod-with-bearings", "out/hexapod/report.html", "report"),
    "tutorial-4-column": ("04-hammer-test", "column.toml", {}),
}


def picture_of(browser: Browser, source: str | Path, drawn: dict[str, Any]) -> bytes:
    """PNG of a machine as `plot(**drawn)` shows it in a notebook, and nothing else."""
    figure = strutwork.load(str(source)).plot(**drawn)
    hidden = {axis: {"visible": False} for axis in ("xaxis", "yaxis", "zaxis")}
    figure.update_layout(
        title=None,
        showlegend=False,
        width=SIZE[0],
        height=SIZE[1],
        margin={"l": 0, "r": 0, "t": 0, "b": 0},
    )
    figure.update_traces(showscale=False, selector={"type": "mesh3d"})
    figure.update_scenes(**hidden, camera={"eye": {"x": 1.3, "y": -1.5, "z": 0.7}})
    marked = "document.documentElement.dataset.plots = 'drawn'"
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "picture.html"
        page.write_text(figure.to_html(post_script=marked), encoding="utf-8")
        browser.open(page, *SIZE, unfolded=False)
        url = browser.evaluate(
            "Plotly.toImage(document.querySelector('.js-plotly-plot'), "
            f"{{format: 'png', width: {SIZE[0]}, height: {SIZE[1]}}})"
        )
    return base64.b64decode(url.partition(",")[2])


def first_screen(browser: Browser, report: Path) -> bytes:
    """PNG of a report as it opens."""
    browser.open(report, 1200, 900, unfolded=False)
    return browser.screenshot()


def keep(png: bytes, path: Path) -> None:
    """Write the picture with at most 128 colours, cut to what is drawn and at most 900 wide."""
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    drawn = ImageChops.difference(picture, Image.new("RGB", picture.size, "white")).getbbox()
    assert drawn, f"{path.name} would be empty"
    picture = picture.crop(drawn)
    picture.thumbnail((900, 640 if picture.width < picture.height * 2 else 900))
    picture = ImageOps.expand(picture, 12, "white")
    path.parent.mkdir(exist_ok=True)
    picture.quantize(128, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1000:.0f} kB")  # noqa: T201


def _tutorials(browser: Browser, chosen: set[str]) -> None:
    for page in TUTORIALS:
        wanted = {n: v for n, v in OF_TUTORIALS.items() if v[0] == page.stem and n in chosen}
        if not wanted:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            Session(page, folder).follow(slow=any(v[2] == "report" for v in wanted.values()))
            for picture, (_, file, drawn) in wanted.items():
                png = (
                    first_screen(browser, folder / file)
                    if isinstance(drawn, str)
                    else picture_of(browser, folder / file, drawn)
                )
                keep(png, IMAGES / f"{picture}.png")


def _gallery(browser: Browser, example: Example) -> None:
    keep(picture_of(browser, example.drawn, example.plot), IMAGES / f"{example.picture}.png")


def main(names: list[str]) -> None:
    """Draw the pictures of these names, or all."""
    gallery = {example.picture: example for example in EXAMPLES}
    chosen = set(names) or {*OF_TUTORIALS, *gallery}
    unknown = chosen - {*OF_TUTORIALS, *gallery}
    if unknown:
        raise SystemExit(f"No such picture: {', '.join(sorted(unknown))}")
    with chromium() as browser:
        for name, example in gallery.items():
            if name in chosen:
                _gallery(browser, example)
        _tutorials(browser, chosen)


if __name__ == "__main__":
    main(sys.argv[1:])
