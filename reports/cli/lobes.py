"""`strutwork lobes`: how deep a machine can mill without chatter, by spindle speed and pose."""

from __future__ import annotations

from dataclasses import replace
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.fea import ModalRatio
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.cli.cut_words import Cut, CutWords
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.cli.survey_output import print_kept, written
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.limiting_part import limiting_sentence
from strutwork.reports.lobes import TargetLobes, target_lobes
from strutwork.reports.survey_words import extremes, grid_text, kept_poses
from strutwork.reports.vibration import Target, model_target, vibrating_model
from strutwork.studies.stability_answer import Stability
from strutwork.studies.survey import survey
from strutwork.units import LENGTH, quantity

#: Directions of the feed that are printed.
PRINTED = 12

#: Quantities of a survey that are printed: name, words, factor, unit.
OVER = (
    ("limiting_depth", "depth stable at every speed", 1e3, "mm"),
    ("least_depth", "the same, worst feed direction", 1e3, "mm"),
    ("chatter_frequency", "chatter frequency", 1.0, "Hz"),
    ("pocket_depth", "depth at the best speed", 1e3, "mm"),
    ("removal_rate", "removal rate there", 6e7, "cm³ per minute"),
)


def run(
    name: str,
    words: CutWords,
    *,
    node: str = "TCP",
    deepest: str | None = None,
    over: list[str] | None = None,
    rose: bool = False,
    out: str | None = None,
    workers: int | None = None,
    at: Where = HOME,
    modal_ratio: float | None = None,
    loss_factor: float | None = None,
    preload: str | None = None,
    json: bool = False,
) -> None:
    """Compute limits and print the absolute one, the best pockets and the depths by speed."""
    model, stem, given = vibrating_model(name, modal_ratio, loss_factor, preload, at.put)
    cut = words.of(model)
    target = model_target(model, stem, given)
    if target.damping is None and cut.modal_ratio is not None:
        target = replace(target, damping=ModalRatio(cut.modal_ratio))
    deep = None if deepest is None else quantity(deepest, LENGTH, "--deepest")
    found = target_lobes(target, cut.process, cut.frame, node, cut.speeds, cut.feed_per_tooth, deep)
    if found.note:
        tell(found.note)
    surveyed = None if not over else _survey(model, target, cut, node, over, workers, name)
    files = [] if out is None else [str(p) for p in found.write(Path(out), rose=rose)]
    if out is not None and surveyed is not None:
        files += written(out, name, "stability", surveyed)
    result = found.to_dict(rose=rose)
    if surveyed is not None:
        result["over"] = _result(name, model, surveyed)
    if json:
        print_json(result | ({"data": files} if files else {}))
        return
    _print(found, cut.material)
    if rose:
        _print_rose(found)
    if surveyed is not None and over:
        _print_over(result["over"], _grid_text(model, over))
    for file in files:
        console().print(f"Written: {visible(file)}", markup=False, soft_wrap=True)


def _survey(
    model: Model,
    target: Target,
    cut: Cut,
    node: str,
    over: list[str],
    workers: int | None,
    name: str,
) -> xr.Dataset:
    """The cut over poses; axis and feed turn with the tool."""
    port = target.port(f"{node}:x")
    answer = Stability.at(
        model, cut.process, cut.frame, cut.speeds, target.damping, cut.feed_per_tooth
    )
    answer = replace(answer, tool=port.node, against=port.against)
    with shown() as started:
        progress = started(f"stability of {visible(name)}")
        return survey(model, _grid(model, over), [answer], workers=workers, progress=progress)


def _grid(model: Model, over: list[str]) -> Any:
    if over != ["workspace"]:
        return grid_of_words(over)
    if model.workspace is None:
        raise ModelError(
            "--over", "names the workspace, and none is stated.", "Give ranges, as x=0mm..20mm:5."
        )
    return model.workspace


def _grid_text(model: Model, over: list[str]) -> str:
    return grid_text(_grid(model, over))


def _result(name: str, model: Model, found: xr.Dataset) -> dict[str, Any]:
    return {
        "target": name,
        "model": model.title,
        **kept_poses(found),
        "extremes": {key: extremes(found, found[key].to_numpy()) for key, *_ in OVER},
    }


def _print(found: TargetLobes, of: str) -> None:
    out, exact, lobes = console(), found.exact, found.lobes
    process = found.process
    out.print(found.target.title, markup=False, style="bold")
    out.print(f"Damping: {found.target.damping}", markup=False)
    out.print(
        f"{process.way}-milling of {of}, {process.teeth} teeth, diameter "
        f"{1e3 * process.cutter.diameter:g} mm, radial immersion {process.immersion:g}",
        markup=False,
        soft_wrap=True,
    )
    columns = ["speed rpm", "zero order mm"]
    rows: list[list[object]] = [
        [f"{n:g}", _depth(a)] for n, a in zip(lobes.speeds, lobes.depth, strict=True)
    ]
    if exact is not None:
        columns += ["exact mm", "chatter Hz", "kind"]
        for row, a, f, kind in zip(rows, exact.depth, exact.frequencies, exact.kinds, strict=True):
            limit = _depth(a) if np.isfinite(a) else f"above {1e3 * exact.deepest:.4g}"
            row += [limit, f"{f:.5g}" if np.isfinite(f) else "", kind]
    out.print(table("Limiting depth of cut", columns, rows))
    if found.pockets:
        best = [
            [f"{p.speed:g}", _depth(p.depth), f"{6e7 * p.removal_rate:.4g}"] for p in found.pockets
        ]
        out.print(table("Best speeds", ["speed rpm", "depth mm", "cm³ per minute"], best))
    depth, frequency = found.absolute
    for line in (
        f"Stable at every speed (zero order): {1e3 * depth:.4g} mm, chatter at {frequency:.5g} Hz",
        limiting_sentence(found.effects),
    ):
        out.print(line, markup=False, soft_wrap=True)


def _print_rose(found: TargetLobes) -> None:
    rose = found.rose
    some = slice(None, None, max(1, len(rose.feeds) // PRINTED))
    rows = [
        [f"{degrees(angle):g}", _depth(depth), f"{at:.5g}" if np.isfinite(at) else ""]
        for angle, depth, at in zip(
            rose.feeds[some], rose.depth[some], rose.frequencies[some], strict=True
        )
    ]
    console().print(
        table(
            "Depth stable at every speed, by direction of the feed",
            ["turned by degrees", "depth mm", "chatter Hz"],
            rows,
        )
    )


def _print_over(result: dict[str, Any], grid: str) -> None:
    print_kept(result, grid)
    rows: list[tuple[object, ...]] = []
    for key, text, factor, unit in OVER:
        entry = result["extremes"][key]
        if entry is None:
            rows.append((text, unit, "no limit", "", "no limit", ""))
            continue
        low, high = entry["least"], entry["largest"]
        rows.append(
            (
                text,
                unit,
                low["value"] * factor,
                low["words"],
                high["value"] * factor,
                high["words"],
            )
        )
    columns = ["", "unit", "least", "at", "largest", "at"]
    console().print(table("Over the poses", columns, rows, names=2))


def _depth(depth: float) -> str:
    return f"{1e3 * depth:.4g}" if np.isfinite(depth) else ""
