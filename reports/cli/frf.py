"""`strutwork frf`: frequency response between two ports, and the least dynamic stiffness."""

from __future__ import annotations

from pathlib import Path

from strutwork.errors import ModelError
from strutwork.fea import Port
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.covering_band import covering_band
from strutwork.reports.vibration import APART, TargetResponse, target_response, vibration_target


def run(
    name: str,
    given: str,
    output: str | None,
    band: tuple[float, float] | None,
    lines: int,
    out: str | None,
    *,
    at: Where = HOME,
    modal_ratio: float | None,
    loss_factor: float | None,
    preload: str | None = None,
    json: bool,
) -> None:
    """Compute the response and print what it says; without a band, over one that covers."""
    target = vibration_target(name, modal_ratio, loss_factor, preload, at.put)
    ports = (target.port(given), target.port(given if output is None else output))
    if band is None:
        band, stop = covering_band(target.placed, list(dict.fromkeys(ports)))
        if band is None:
            raise ModelError("frequency band", "has no elastic mode to cover.", "Give a band.")
        if stop:
            tell(f"Note: {stop}")
    found = target_response(target, *ports, band, lines)
    written = [] if out is None else [str(path) for path in found.write(Path(out))]
    if out is not None and found.is_relative:
        tell(
            "Note: a universal file cannot contain the motion between two nodes; only CSV is "
            "written."
        )
    if not found.least.certified:
        tell("Warning: the proof of the minimum was not completed.")
    if json:
        print_json(found.to_dict() | ({"data": written} if written else {}))
        return
    _print(found, band)
    for path in written:
        console().print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _print(found: TargetResponse, band: tuple[float, float]) -> None:
    out, least = console(), found.least
    out.print(found.target.title, markup=False, style="bold")
    out.print(f"Damping: {found.target.damping}", markup=False)
    if least.uncoupled:
        out.print(f"{least.input} and {least.output}: {APART}", markup=False, soft_wrap=True)
        return
    scale, unit = _unit(least.output, least.input)
    static = "infinite" if least.static is None else least.static * scale
    rows: list[tuple[str, object, str]] = [
        ("static stiffness", static, unit),
        ("least dynamic stiffness", least.value * scale, unit),
        ("at", f"{least.frequency:.6g}", "Hz"),
    ]
    out.print(f"From {band[0]:g} to {band[1]:g} Hz, other axes free", markup=False)
    out.print(table(f"{least.input} to {least.output}", ["", "", "unit"], rows))


def _unit(output: Port, given: Port) -> tuple[float, str]:
    turns, twists = (str(port.direction).startswith("r") for port in (output, given))
    if turns and twists:
        return 1e-3, "kN·m/rad"
    if not turns and not twists:
        return 1e-6, "N/µm"
    return (1.0, "N/rad") if turns else (1.0, "N·m/m")
