"""What a calibration takes away of the geometry in an error sheet, in sentences."""

from __future__ import annotations

import numpy as np

from strutwork.reports.numbers import count, significant
from strutwork.studies.error_sheet import ErrorSheet

AFTER = "geometry after calibration"


def calibration_text(sheet: ErrorSheet) -> str:
    """What was measured and is known by it; empty without a calibration."""
    found = sheet.calibrated
    if found is None:
        return ""
    before, after = (
        1e6 * float(np.linalg.norm(one.worst[:3]))
        for one in (ErrorSheet(sheet.uncalibrated), sheet.of(AFTER))
    )
    text = (
        f"The calibration measures the tool at {count(found.poses, 'pose')} and determines "
        f"{found.found.rank} of {len(found.found.names)} combinations of the calibrated parameters "
        "better than their tolerances do. The geometry displaces the tool by "
        f"{significant(before)} µm before and by {significant(after)} µm after it, as the root of "
        "the squares of the worst cases along x, y and z; the uncertainty of the measurement "
        "counts with three standard deviations."
    )
    if found.picked:
        text += (
            f" {count(found.picked, 'pose is', 'poses are')} chosen so that the determinant of the "
            "information is as large as possible."
        )
    return text


def combination_words(weights: dict[str, float]) -> str:
    """As in "1 · place of y − 0.5 · zero of x", the largest first."""
    terms = sorted(weights.items(), key=lambda item: -abs(item[1]))
    words = ""
    for name, weight in terms:
        sign = "−" if weight < 0 else "+" if words else ""
        gap = " " if words else ""
        words += f"{gap}{sign}{gap if sign else ''}{significant(abs(weight))} · {name}"
    return words


def calibration_lines(sheet: ErrorSheet) -> list[str]:
    """For the terminal: the text, and combinations of few parameters that stay as they were."""
    found = sheet.calibrated
    if found is None:
        return []
    left = [weights for weights in found.undetermined if len(weights) <= 4]
    lines = [calibration_text(sheet)]
    if left:
        named = "; ".join(combination_words(weights) for weights in left[:4])
        lines.append(f"Not determined, in standard deviations: {named}.")
    return lines
