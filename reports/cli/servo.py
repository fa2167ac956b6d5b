"""`strutwork servo`: closed loops of the drives, and stiffness with the servos in the loop."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.fea.dynamic_stiffness import check_band
from strutwork.machines.model import Model
from strutwork.machines.servo_file import read_servos
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.cli.survey_output import print_kept, written
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.servo import TargetLoop, margin_words
from strutwork.reports.survey_words import extremes, grid_text, kept_poses
from strutwork.reports.vibration import model_target, vibrating_model
from strutwork.servo import LeastStiffness
from strutwork.studies.servo_answer import ControlledDrives
from strutwork.studies.servo_loop import LoopQuestion, loop_question
from strutwork.studies.survey import survey

#: A column over poses.
DECAY = "decay of the slowest motion"

#: Poles that are printed: the lowest, and those that are unstable.
PRINTED = 16


def run(
    name: str,
    servos: str | None,
    ports: Sequence[str],
    band: tuple[float, float] | None,
    modes: int | None,
    *,
    over: list[str] | None = None,
    workers: int | None = None,
    out: str | None = None,
    at: Where = HOME,
    modal_ratio: float | None = None,
    loss_factor: float | None = None,
    preload: str | None = None,
    json: bool = False,
) -> None:
    """Close the loops and print poles, margins and the least dynamic stiffness."""
    model, stem, given = vibrating_model(name, modal_ratio, loss_factor, preload, at.put)
    if band is not None:
        check_band(*band)
    target = model_target(model, stem, given)
    question = loop_question(
        model,
        () if servos is None else read_servos(servos, model),
        [target.port(text) for text in ports],
        damping=target.damping,
        band=band,
        modes=modes,
    )
    found = TargetLoop.of(target, question)
    surveyed = None if not over else _survey(model, question, over, workers, name)
    result = found.to_dict()
    files = [] if out is None else [str(path) for path in found.write(Path(out))]
    if surveyed is not None:
        result["over"] = _result(name, model, surveyed)
        files += [] if out is None else written(out, name, "servo", surveyed)
    if result["loss_factor_replaced"]:
        tell(
            "Note: the loss factor is replaced by viscous damping with the same loss at each "
            "resonance: a loop needs equations in time."
        )
    if json:
        print_json(result | ({"data": files} if files else {}))
        return
    _print(found)
    if surveyed is not None and over:
        _print_over(result["over"], grid_text(_grid(model, over)))
    for file in files:
        console().print(f"Written: {visible(file)}", markup=False, soft_wrap=True)


def _print(found: TargetLoop) -> None:
    out, loop = console(), found.loop
    out.print(found.target.title, markup=False, style="bold")
    out.print(f"Damping: {found.target.damping}, with the motors held", markup=False)
    out.print(found.kept, markup=False, soft_wrap=True)
    poles = loop.poles
    rows = [
        [p.part, f"{p.frequency:.5g}", f"{p.damping:.4g}", f"{100 * p.share:.0f}"]
        for i, p in enumerate(poles)
        if i < PRINTED or not p.stable
    ]
    if len(rows) < len(poles):
        rows.append([f"{len(poles) - len(rows)} more", "", "", ""])
    heads = ["moves most", "Hz", "damping ratio", "share %"]
    out.print(table("Poles of the closed loops", heads, rows))
    rows = []
    for one in loop.margins:
        for words, margins in (("velocity", one.velocity), ("position", one.position)):
            rows.append([str(one.servo), words, *margin_words(margins)])
    heads = ["drive", "loop", "gain margin", "phase margin", "crossover Hz"]
    out.print(table("Margins, the other drives in their loops", heads, rows, names=2))
    stiffnesses: list[list[object]] = []
    for i, port in enumerate(loop.ports):
        scale, unit = (1e-3, "kN·m/rad") if _turns(port.direction) else (1e-6, "N/µm")
        stiffnesses.append(
            [
                str(port),
                unit,
                *_stiffness(None if found.least is None else found.least[i], scale, "unstable"),
                *_stiffness(None if found.locked is None else found.locked[i], scale, "rigid"),
            ]
        )
    heads = ["", "unit", "with servos", "at Hz", "static", "drives locked", "at Hz", "static"]
    title = f"Least dynamic stiffness from {found.band[0]:.4g} to {found.band[1]:.4g} Hz"
    out.print(table(title, heads, stiffnesses, names=2))
    if loop.stable:
        worst = loop.slowest
        line = (
            "The closed loop is stable. Its slowest motion decays with a time constant of "
            f"{-1e3 / worst.value.real:.4g} ms: {worst.part}, {worst.frequency:.4g} Hz."
        )
    else:
        worst = loop.slowest
        line = (
            f"The closed loop is UNSTABLE: {worst.part} grows at {worst.frequency:.5g} Hz. Lower "
            "the gains, raise the integral time or shorten the delay."
        )
    out.print(line, markup=False, soft_wrap=True)


def _stiffness(found: LeastStiffness | None, scale: float, missing: str) -> list[object]:
    if found is None:
        return [missing, "", ""]
    return [found.value * scale, f"{found.frequency:.5g}", found.static * scale]


def _turns(direction: str | tuple[float, ...]) -> bool:
    return direction.startswith("r") if isinstance(direction, str) else not any(direction[:3])


def _survey(
    model: Model, question: LoopQuestion, over: list[str], workers: int | None, name: str
) -> xr.Dataset:
    answer = ControlledDrives.of(model, question)
    with shown() as started:
        progress = started(f"closed loops of {visible(name)}")
        return survey(model, _grid(model, over), [answer], workers=workers, progress=progress)


def _grid(model: Model, over: list[str]) -> Any:
    if over != ["workspace"]:
        return grid_of_words(over)
    if model.workspace is None:
        raise ModelError(
            "--over", "names the workspace, and none is stated.", "Give ranges, as x=0mm..20mm:5."
        )
    return model.workspace


def _result(name: str, model: Model, found: xr.Dataset) -> dict[str, Any]:
    ports = [str(port) for port in found["port"].to_numpy()]
    columns = [(DECAY, found["decay"].to_numpy())]
    for words, key in (("with servos", "servo_stiffness"), ("drives locked", "locked_stiffness")):
        values = found[key].to_numpy()
        columns += [(f"{port}, {words}", values[..., i]) for i, port in enumerate(ports)]
    return {
        "target": name,
        "model": model.title,
        **kept_poses(found),
        "unstable": int(np.nansum(found["unstable"].to_numpy())),
        "extremes": {words: extremes(found, values) for words, values in columns},
    }


def _print_over(result: dict[str, Any], grid: str) -> None:
    print_kept(result, grid)
    rows: list[tuple[object, ...]] = []
    for words, entry in result["extremes"].items():
        rate = words == DECAY
        turns = words.partition(",")[0].rpartition(":")[2].startswith("r")
        scale, unit = (1.0, "1/s") if rate else (1e-3, "kN·m/rad") if turns else (1e-6, "N/µm")
        if entry is None:
            rows.append((words, unit, "none", "", "none", ""))
            continue
        low, high = entry["least"], entry["largest"]
        rows.append(
            (
                *(words, unit, low["value"] * scale, low["words"]),
                *(high["value"] * scale, high["words"]),
            )
        )
    heads = ["", "unit", "least", "at", "largest", "at"]
    console().print(table("Over the poses", heads, rows, names=2))
    if result["unstable"]:
        console().print(
            f"The closed loop is UNSTABLE at {result['unstable']} of the poses.", markup=False
        )
