"""`strutwork lobes`: how deep a machine can mill without chatter, by spindle speed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting import Cutter, Frame, Milling, material
from strutwork.errors import ModelError
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.lobes import TargetLobes, target_lobes
from strutwork.reports.vibration import vibration_target
from strutwork.units import ANGLE, LENGTH, quantity

#: What --tool takes, and the dimension of each.
TOOL = {"diameter": LENGTH, "helix": ANGLE, "lead": ANGLE}

Array = NDArray[Any]

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

#: Speeds at most.
MOST = 2000


def run(
    name: str,
    tool: str,
    of: str,
    immersion: float,
    way: str,
    speeds: str,
    *,
    node: str = "TCP",
    axis: str = "z",
    feed: str = "x",
    feed_per_tooth: str = "0.1 mm",
    deepest: str | None = None,
    out: str | None = None,
    at: Where = HOME,
    modal_ratio: float | None = None,
    loss_factor: float | None = None,
    preload: str | None = None,
    json: bool = False,
) -> None:
    """Compute limits and print the absolute one, the best pockets and the depths by speed."""
    file, _, entry = of.rpartition(":")
    coefficients = material(entry, file or None)
    process = Milling(cutter_of(tool), coefficients, immersion, way)  # type: ignore[arg-type]
    rpm = speeds_of(speeds)
    frame = Frame.along(direction_of(axis, "--axis"), direction_of(feed, "--feed"))
    per_tooth = quantity(feed_per_tooth, LENGTH, "--feed-per-tooth")
    deep = None if deepest is None else quantity(deepest, LENGTH, "--deepest")
    target = vibration_target(name, modal_ratio, loss_factor, preload, at.put)
    found = target_lobes(target, process, frame, node, rpm, per_tooth, deep)
    if found.note:
        tell(found.note)
    written = None if out is None else str(found.write(Path(out)))
    if json:
        print_json(found.to_dict() | ({"data": [written]} if written else {}))
        return
    _print(found, of)
    if written:
        console().print(f"Written: {visible(written)}", markup=False, soft_wrap=True)


def cutter_of(text: str) -> Cutter:
    """The cutter of --tool.

    Raises
    ------
    ModelError
        A word of another shape, no diameter, no teeth.
    """
    numbers: dict[str, float] = {}
    for word in text.split(","):
        key, sign, value = (part.strip() for part in word.partition("="))
        if not sign or key not in (*TOOL, "teeth") or key in numbers:
            raise ModelError(
                "--tool",
                f'"{word.strip()}" cannot be read.',
                "Write diameter=20mm,teeth=4 and, if needed, helix=30deg and lead=45deg.",
            )
        if key == "teeth":
            if not (value.isdecimal() and value.isascii() and len(value) < 4):
                raise ModelError("--tool", f'has "{value}" teeth.', "Give a whole number from 1.")
            numbers[key] = int(value)
        else:
            numbers[key] = quantity(value, TOOL[key], f"--tool, {key}")
    for key in ("diameter", "teeth"):
        if key not in numbers:
            raise ModelError("--tool", f"has no {key}.", "Write diameter=20mm,teeth=4.")
    teeth = int(numbers.pop("teeth"))
    return Cutter(numbers.pop("diameter"), teeth, **numbers)


def speeds_of(text: str) -> Array:
    """Speeds (s,) of LOW..HIGH:N, rpm.

    Raises
    ------
    ModelError
        Text of another shape, or numbers out of range.
    """
    span, _, count = text.partition(":")
    low, dots, high = span.partition("..")
    try:
        first, last, number = float(low), float(high if dots else low), int(count or "1")
    except ValueError:
        first, last, number = np.nan, np.nan, 0
    good = 0 < first <= last < np.inf and 1 <= number <= MOST and (number > 1 or first == last)
    if not good:
        raise ModelError(
            "--speeds",
            f'"{text}" cannot be read.',
            f"Write LOW..HIGH:N in rpm with up to {MOST} speeds, as in 2000..12000:51.",
        )
    return np.linspace(first, last, number)


def direction_of(text: str, option: str) -> tuple[float, float, float]:
    """A direction of x, -y, z, or three numbers.

    Raises
    ------
    ModelError
        Text of another shape.
    """
    bare = text.strip().removeprefix("-")
    if bare in AXES:
        sign = -1.0 if text.strip().startswith("-") else 1.0
        x, y, z = AXES[bare]
        return (sign * x, sign * y, sign * z)
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = np.nan
    if not np.all(np.isfinite([x, y, z])):
        raise ModelError(
            option, f'"{text}" is no direction.', "Write x, y, z, -x, -y, -z or three numbers."
        )
    return (x, y, z)


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
    out.print(
        f"Stable at every speed (zero order): {1e3 * depth:.4g} mm, chatter at {frequency:.5g} Hz",
        markup=False,
        soft_wrap=True,
    )


def _depth(depth: float) -> str:
    return f"{1e3 * depth:.4g}" if np.isfinite(depth) else ""
