"""The gallery has a page and a picture for each example, and says what the example says."""

from __future__ import annotations

import pytest
from PIL import Image

from tests.docs.examples import EXAMPLES, Example
from tests.docs.gallery import GALLERY, page, printed_on
from tests.docs.markdown import ROOT
from tests.docs.tutorial import TUTORIALS, cells


def test_every_page_belongs_to_an_example() -> None:
    assert {p.stem for p in GALLERY.glob("[0-9]*.md")} == {e.name for e in EXAMPLES}


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_a_page_is_made_of_the_head_of_its_example(example: Example) -> None:
    # that the command prints this is for test_examples
    text = (GALLERY / f"{example.name}.md").read_text(encoding="utf-8")
    printed = printed_on(text)
    assert text == page(example, printed), "python -m tests.docs.gallery writes it anew"
    kept = [line for line in printed if line != "..."]
    assert len(kept) == len(example.shown) > 0
    assert all(wanted in line for wanted, line in zip(example.shown, kept, strict=True))
    assert len(example.words.split()) > 10, "its head says what it shows"


def test_pictures_are_small_and_shown() -> None:
    pictures = sorted((ROOT / "docs" / "images").glob("[gt]*-*.png"))
    shown = "".join(
        [p.read_text(encoding="utf-8") for p in (*TUTORIALS, *GALLERY.glob("[0-9]*.md"))]
    )
    for picture in pictures:
        assert f"images/{picture.name})" in shown, f"no page shows {picture.name}"
        assert picture.stat().st_size < 100_000, picture.name
        with Image.open(picture) as image:
            assert len(image.getcolors() or []) > 8, f"{picture.name} is empty"


def test_every_tutorial_has_words_before_its_code() -> None:
    assert all(cells(page)[0].kind == "words" for page in TUTORIALS)
