"""Pages under axe-core: WCAG 2.1, levels A and AA, at both widths, folded and unfolded."""

from __future__ import annotations

import json
from importlib.resources import files

import pytest

from strutwork.reports.build import WrittenReport
from tests.reports.browser import Browser

#: What axe-core is asked: rules by their tags.
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]

#: Kinds of reports and widths that differ from others in the width only.
OTHERS = [("model", 420), ("document", 1400), ("tolerance", 1400), ("hexapod", 420)]

AXE = files("axe_core_python").joinpath("axe.min.js")

RUN = f"""
axe.run(document, {{ runOnly: {json.dumps(TAGS)}, resultTypes: ["violations"] }}).then((found) =>
  ({{ rules: found.passes.length, violations: found.violations.map((one) =>
    [one.id, one.impact, one.help, one.nodes.slice(0, 5).map((n) => n.html.slice(0, 160))]) }}))
"""


def violations(browser: Browser) -> list[object]:
    """What axe-core finds on the page that is open."""
    if not browser.evaluate("typeof axe === 'object'"):
        browser.evaluate(AXE.read_text(encoding="utf-8") + "\n;true")
    found = browser.evaluate(RUN)
    # a run that looked at nothing has no violations either
    assert found["rules"] > 20
    listed: list[object] = found["violations"]
    return listed


@pytest.mark.parametrize(
    ("kind", "width"),
    [
        ("model", 1400),
        ("document", 420),
        # the same rules on the other pages of the same templates
        *(pytest.param(*case, marks=pytest.mark.slow) for case in OTHERS),
    ],
)
def test_no_violation_of_wcag(
    browser: Browser, kind: str, width: int, request: pytest.FixtureRequest
) -> None:
    written: WrittenReport = request.getfixturevalue(f"{kind}_report")
    browser.open(written.report, width, unfolded=False)
    assert violations(browser) == []
    browser.unfold()
    assert violations(browser) == []


def test_plots_are_turned_and_shifted_by_keys(
    browser: Browser, model_report: WrittenReport
) -> None:
    browser.open(model_report.report, 1400, unfolded=False)
    solid, flat = "#cover-softest .drawing", "#budget .drawing"
    browser.draw(flat)

    def press(selector: str, key: str) -> None:
        browser.evaluate(f"document.querySelector('{selector}').focus()")
        for kind in ("keyDown", "keyUp"):
            browser.send("Input.dispatchKeyEvent", type=kind, key=key)

    eye = f"document.querySelector('{solid}')._fullLayout.scene.camera.eye"
    before = browser.evaluate(eye)
    press(solid, "ArrowRight")
    browser.wait_for(f"Math.abs({eye}.x - ({before['x']})) > 1e-3")
    turned = browser.evaluate(eye)
    assert turned["z"] == pytest.approx(before["z"])
    assert sum(v**2 for v in turned.values()) == pytest.approx(sum(v**2 for v in before.values()))
    press(solid, "-")
    browser.wait_for(f"{eye}.z > 1.1 * {before['z']}")
    press(solid, "Home")
    browser.wait_for(f"Math.abs({eye}.x - ({before['x']})) < 1e-6")

    axis = f"document.querySelector('{flat}')._fullLayout.xaxis.range"
    low, high = browser.evaluate(axis)
    press(flat, "ArrowRight")
    browser.wait_for(f"{axis}[0] > {low}")
    moved = browser.evaluate(axis)
    assert moved[1] - moved[0] == pytest.approx(high - low)
    press(flat, "Home")
    browser.wait_for(f"Math.abs({axis}[0] - ({low})) < 1e-9")
    assert browser.complaints == []
