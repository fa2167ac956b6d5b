"""`strutwork gradient`: which dimensions to change first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import xarray as xr

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio
from strutwork.fea.coupled import AnyDamping
from strutwork.files import write_whole
from strutwork.machines.model import Model
from strutwork.machines.model_poses import pose_words
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.subject import where
from strutwork.reports.first_changes import SMALL, Effect, effects, what_to_change_file
from strutwork.reports.numbers import percent, significant
from strutwork.studies.dimension import Dimension, dimensions
from strutwork.studies.gradient import gradient, worst_pose
from strutwork.studies.gradient_quantities import Vibrating
from strutwork.studies.model_damping import model_damping
from strutwork.studies.parametric import Parametric

#: Asked for where nothing is.
USUAL = ("stiffness_x", "stiffness_y", "stiffness_z")

#: Rows of a table.
MOST = 25


@dataclass(frozen=True)
class Options:
    """What is asked.

    Parameters
    ----------
    of, by : tuple of str
        Quantities and paths; empty for the usual ones.
    worst : bool
        At the worst pose of the workspace.
    band : (float, float)
        Hz.
    """

    of: tuple[str, ...]
    by: tuple[str, ...]
    worst: bool
    band: tuple[float, float]


def run(
    name: str,
    pose: Sequence[str],
    options: Options,
    damping: tuple[float | None, float | None],
    out: str | None,
    *,
    json: bool,
) -> None:
    """Take the gradients and print what ten percent more of each dimension brings."""
    task = where(pose, None).task
    machine = Parametric.of(name)
    model = machine.model()
    quantities = options.of or USUAL
    vibrating = Vibrating(_damping(model, damping), options.band)
    if options.worst:
        task = _worst(model, quantities[0], task, vibrating)
    parameters = (
        [Dimension.of(machine, path) for path in options.by] if options.by else dimensions(machine)
    )
    found = gradient(
        machine.model, parameters, quantities, {d: [v] for d, v in task.items()}, vibrating
    )
    if out is not None:
        written = Path(out)
        write_whole(written, what_to_change_file([found], written.name).write)
    if json:
        print_json(_result(name, found, task))
        return
    _print(machine.title, found, task)
    if out is not None:
        console().print(f"Written: {visible(out)}", markup=False, soft_wrap=True)


def _damping(model: Model, given: tuple[float | None, float | None]) -> AnyDamping | None:
    ratio, loss = given
    if ratio is not None and loss is not None:
        raise ModelError("damping", "is given twice.", "Give --modal-ratio or --loss-factor.")
    if ratio is not None:
        return model_damping(model, ModalRatio(ratio))
    return model_damping(model, LossFactor(loss) if loss is not None else None)


def _worst(
    model: Model, quantity: str, task: dict[str, float], vibrating: Vibrating
) -> dict[str, float]:
    if task:
        raise ModelError("--worst", "cannot stand beside --pose.", "Ask for one of the two.")
    if model.workspace is None:
        raise ModelError(
            "workspace", "is not given.", "Add a table [workspace], or name a pose by --pose."
        )
    return worst_pose(model, quantity, model.workspace, vibrating)


def _result(name: str, found: xr.Dataset, task: dict[str, float]) -> dict[str, Any]:
    def plain(value: float) -> float | None:
        return value if isfinite(value) else None

    quantities = {}
    for q, quantity in enumerate(found["quantity"].to_numpy().tolist()):
        quantities[quantity] = {
            "value": plain(float(found["value"].to_numpy()[q, 0])),
            "unit": str(found["quantity_unit"].to_numpy()[q]),
            "gradient": {
                parameter: {
                    "gradient": plain(float(found["gradient"].to_numpy()[q, g, 0])),
                    "unit": str(found["gradient_unit"].to_numpy()[q, g]),
                    "elasticity": plain(float(found["elasticity"].to_numpy()[q, g, 0])),
                }
                for g, parameter in enumerate(found["parameter"].to_numpy().tolist())
            },
        }
    return {
        "machine": name,
        "pose": task,
        "parameters": {
            str(p): {"value": float(v), "unit": str(u)}
            for p, v, u in zip(
                found["parameter"].to_numpy(),
                found["parameter_value"].to_numpy(),
                found["parameter_unit"].to_numpy(),
                strict=True,
            )
        },
        "quantities": quantities,
        "no_influence": found.attrs["no_influence"],
        "refused": found.attrs["refused"],
        "remarks": found.attrs["remarks"],
    }


def _print(title: str, found: xr.Dataset, task: dict[str, float]) -> None:
    out = console()
    out.print(title, markup=False, style="bold")
    out.print(pose_words(task, {}) if task else "as it is described", markup=False)
    quantities = [str(q) for q in found["quantity"].to_numpy()]
    for q, quantity in enumerate(quantities):
        value = float(found["value"].to_numpy()[q, 0])
        unit = str(found["quantity_unit"].to_numpy()[q]).replace(" ", "·")
        out.print(f"{quantity} = {significant(value, 4)} {unit}", markup=False)
    every = effects(found)
    shown = [e for e in every if max(map(_size, e.shares)) >= SMALL][:MOST]
    columns = ["dimension", "is", *(f"{q}, %" for q in quantities)]
    rows = [(visible(e.label), e.value, *map(_share, e.shares)) for e in shown]
    out.print(table("Effect of 10 % more, linear, from the gradient", columns, rows))
    _print_rest(found, every, shown)


def _size(share: float) -> float:
    return abs(share) if isfinite(share) else 0.0


def _share(share: float) -> str:
    return percent(100.0 * share, 2).removesuffix(" %") if isfinite(share) else "none"


def _print_rest(found: xr.Dataset, every: list[Effect], shown: list[Effect]) -> None:
    """What the table does not say."""
    out = console()
    none = found.attrs["no_influence"]
    small = len([e for e in every if e not in shown and not set(e.names) <= set(none)])
    if none:
        names = ", ".join(visible(n) for n in none)
        out.print(f"Without influence: {names}.", markup=False, soft_wrap=True)
    if small:
        out.print(f"{small} more with less effect; --out has all.", markup=False)
    for remark in (*found.attrs["remarks"], *found.attrs["refused"]):
        tell(f"Note: {remark}")
