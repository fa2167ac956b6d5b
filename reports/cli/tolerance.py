"""`strutwork tolerance`: the forces that tolerances lock in, their limits and the tool."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.load import load
from strutwork.names import visible
from strutwork.overconstraint import joint_quantities
from strutwork.reports.cli.output import console, print_json, show, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.cli.tolerance_limits import parsed_limits
from strutwork.studies.dataset_files import write_netcdf
from strutwork.studies.tolerance_result import ToleranceStudy, write_table
from strutwork.studies.tolerance_study import StudyOptions, tolerance_study
from strutwork.studies.toleranced_machine import toleranced_machine

#: Quantiles that the tables show.
SHOWN = ("0.95", "0.99")

#: Units of the tables by SI unit: factor and name.
UNITS = {"N": (1.0, "N"), "N*m": (1.0, "N·m"), "m": (1e6, "µm"), "rad": (1e6, "µrad")}


def run(
    target: str,
    limits: Sequence[str],
    options: StudyOptions,
    out: str | None,
    *,
    json: bool,
    at: Where = HOME,
) -> None:
    """Study the tolerances of a model file or a machine and print what they do."""
    study, notes = _study(target, limits, options, at)
    result = {"target": target, **study.to_dict(), "notes": list(notes), "data": []}
    if out is not None:
        name = f"{Path(target).stem}-tolerances"
        written = [
            write_netcdf(Path(out) / f"{name}.nc", study.to_dataset()),
            write_table(Path(out) / f"{name}.csv", study),
        ]
        result["data"] = [str(path) for path in written]
    if json:
        print_json(result)
    else:
        _print(console(), study, notes, result)


def _study(
    target: str, given: Sequence[str], options: StudyOptions, at: Where
) -> tuple[ToleranceStudy, tuple[str, ...]]:
    with shown("assemblies") as started:
        if target in CATALOGUE and at.home:
            machine = toleranced_machine(target)
            made = tolerance_study(
                machine.placed,
                machine.tolerances,
                parsed_limits(machine.limits, given, machine.quantities),
                options,
                title=machine.title,
                poses=machine.poses,
                quantities=machine.quantities,
                progress=started,
            )
            return made, machine.notes
        model = at.put(load(target))
        if target in CATALOGUE:
            model = replace(model, tolerances=toleranced_machine(target).tolerances)
        quantities = joint_quantities(model.structure.linkage)
        made = tolerance_study(
            model.placed,
            model.tolerances,
            parsed_limits(model.force_limits, given, quantities),
            replace(options, costs=model.tolerance_costs),
            title=model.title or Path(target).stem,
            progress=started,
        )
        return made, ()


def _print(
    out: Console, study: ToleranceStudy, notes: Sequence[str], result: dict[str, Any]
) -> None:
    out.print(study.title or "Model", markup=False, style="bold")
    number, count = len(study.tolerances), result["self_stress_states"]
    plural = [
        f"{n} {word}{'' if n == 1 else 's'}"
        for n, word in ((number, "tolerance"), (count, "state"))
    ]
    out.print(
        f"{plural[0]}, {plural[1]} of self-stress" + ("" if count else ": no misfit causes a force")
    )
    if study.distribution is not None:
        shares = " and ".join(_quantile_heads(study))
        out.print(f"Columns {shares}: the value that this share of the assemblies stays below")
    if len(study.poses) > 1:
        out.print(f"{len(study.poses)} poses; quantiles at {result['governing_pose']}")
    rows = result["quantities"]
    forces = [r for r in rows if r["joint"] is not None]
    tool = [r for r in rows if r["joint"] is None]
    for unit, title in (("N", "Largest forces"), ("N*m", "Largest moments")):
        some = [r for r in forces if r["unit"] == unit]
        if some:
            out.print(_joints(study, title, some))
    if tool:
        out.print(_tool(study, tool, result["tool_deviation"]))
    if study.limits:
        _print_limits(out, study, result)
    if study.allocation is not None:
        _print_allocation(out, study, result)
    for note in notes:
        out.print(note, markup=False, highlight=False)
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)


def _joints(study: ToleranceStudy, title: str, rows: Sequence[dict[str, Any]]) -> Table:
    factor, unit = UNITS[rows[0]["unit"]]
    columns = ["joint", "what", "worst", *_quantile_heads(study)]
    columns += ["limit", "used, %"] if study.limits else []
    columns += ["mainly from"]
    columns += ["at"] if len(study.poses) > 1 else []
    lines: list[list[object]] = []
    for row in rows:
        limit = row["limit"]
        line = [row["joint"], row["kind"], factor * row["worst"], *_quantiles(row, factor)]
        if study.limits:
            line += ["-", "-"] if limit is None else [factor * limit, 100 * row["utilisation"]]
        line.append(_contributor(row))
        if len(study.poses) > 1:
            line.append(row["worst_pose"])
        lines.append(line)
    return table(f"{title}, {unit}", columns, lines, names=2)


def _tool(
    study: ToleranceStudy, rows: Sequence[dict[str, Any]], deviation: dict[str, Any] | None
) -> Table:
    lines: list[list[object]] = []
    for row in rows:
        factor, unit = UNITS[row["unit"]]
        what = f"{row['kind']} {row['directions'][0]}, {unit}"
        lines.append([what, factor * row["worst"], *_quantiles(row, factor), _contributor(row)])
    if deviation is not None:
        blank = ["" for _ in _quantile_heads(study)]
        lines.append(["displacement, any direction, µm", 1e6 * deviation["largest"], *blank, ""])
    columns = ["tool", "worst", *_quantile_heads(study), "mainly from"]
    return table("Displacements by the locked-in misfits", columns, lines)


def _quantile_heads(study: ToleranceStudy) -> list[str]:
    return [] if study.distribution is None else [f"{100 * float(s):g} %" for s in SHOWN]


def _quantiles(row: dict[str, Any], factor: float) -> list[object]:
    found = row["quantiles"]
    return [] if found is None else [factor * found[s]["value"] for s in SHOWN]


def _contributor(row: dict[str, Any]) -> str:
    name = row["contributor"]
    return "-" if name is None else f"{name} ({100 * row['shares'][name]:.0f} %)"


def _print_limits(out: Console, study: ToleranceStudy, result: dict[str, Any]) -> None:
    used = float(study.utilisation.max())
    name = study.quantities[int(study.utilisation.argmax())].name
    verdict = "No assembly exceeds a limit" if study.within_limits else "A limit can be exceeded"
    text = f"{verdict}: {name} reaches {show(100 * used)} % of its limit in the worst case"
    sampled = (result["distribution"] or {}).get("utilisation")
    if sampled:
        text += f"; 99 % of the assemblies reach less than {show(100 * sampled['0.99'])} %"
    out.print(text + ".", markup=False)


def _print_allocation(out: Console, study: ToleranceStudy, result: dict[str, Any]) -> None:
    found = result["allocation"]
    lines: list[list[object]] = []
    for tolerance in study.tolerances:
        angle = tolerance.slope is not None
        given, size = result["tolerances"][tolerance.name]["size"], found["sizes"][tolerance.name]
        lines.append(
            [tolerance.name, tolerance.kind, "µm/m" if angle else "µm", 1e6 * given, 1e6 * size]
        )
    columns = ["tolerance", "kind", "unit", "given", "allocated"]
    out.print(table("Tolerances that meet the limits", columns, lines, names=3))
    active = ", ".join(dict.fromkeys(found["active"])) or "nothing"
    for label, text in (
        ("Limited by", active),
        ("Method", found["method"]),
        ("Optimality", found["optimality"]),
    ):
        out.print(f"{label}: {text}.", markup=False)
