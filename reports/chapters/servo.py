"""What the drives' controllers add: poles, margins, and stiffness with the servos in the loop."""

from __future__ import annotations

from strutwork.errors import StrutworkError
from strutwork.names import listed
from strutwork.reports.content import (
    Block,
    Cell,
    Chapter,
    Column,
    Figure,
    Note,
    Points,
    Table,
    Text,
)
from strutwork.reports.figures.theme import AXIS_COLOURS
from strutwork.reports.figures.vibration import responses
from strutwork.reports.numbers import significant
from strutwork.reports.servo import TargetLoop, margin_words
from strutwork.reports.subject import Subject
from strutwork.reports.vibration import model_target
from strutwork.reports.vibration_study import has_mass
from strutwork.studies.servo_loop import loop_question

KEY = "servo"
TITLE = "What do the drives' controllers add?"

#: Names of the data files begin so.
STEM = "drives"

#: Poles that the table lists: the lowest.
NAMED = 16

LIMITS = (
    "The damping of the structure acts on its vibration with the motors held. The inertia of a "
    "motor acts on the motion of its joint: what the frame does to the spin of the rotor is "
    "neglected, as are friction, backlash and the limits of force and speed. Margins of a loop "
    "hold while the loops of the other drives are closed; those of a velocity loop while the "
    "position loop of the same drive is open."
)


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    model = subject.model
    if not model.servos:
        return "no controllers are given: add [[servos]]"
    if model.tool is None:
        return "it has no tool: add [tool] with tcp"
    if subject.damping is None or not has_mass(model):
        return "it needs mass and damping: add densities and [damping]"
    try:
        _closed(subject)
    except StrutworkError as error:
        return f"the loops cannot be closed: {error.part} {error.problem}".rstrip(".")
    return ""


def _closed(subject: Subject) -> TargetLoop:
    target = model_target(subject.model, STEM)
    return TargetLoop.of(target, loop_question(subject.model, damping=target.damping))


def write(subject: Subject) -> Chapter:
    """The loops, their poles and margins, and the response of the tool."""
    found = _closed(subject)
    loop = found.loop
    blocks: list[Block] = [
        Text(_sentence(found)),
        _stiffness(found),
        _response(found),
        _margins(found),
        _poles(found),
        Text(f"{found.kept}."),
    ]
    if loop.connected.plant.modes.equivalent:
        blocks.append(
            Note(
                "The loss factor is replaced by viscous damping with the same loss at each "
                "resonance: a loop needs equations in time."
            )
        )
    blocks += [Points(tuple(_controllers(found))), Note(LIMITS)]
    return Chapter(KEY, TITLE, tuple(blocks), found.files(), _answer(found))


def _answer(found: TargetLoop) -> str:
    if found.least is None:
        worst = found.loop.slowest
        return (
            f"The closed loop is unstable: {worst.part} grows at {significant(worst.frequency)} Hz."
        )
    k = min(range(len(found.least)), key=lambda i: found.least[i].value if found.least else 0.0)
    least = found.least[k]
    text = (
        f"With its drives controlled, the machine is least stiff along "
        f"{found.loop.ports[k].direction}: {significant(least.value / 1e6)} N/µm at "
        f"{significant(least.frequency)} Hz"
    )
    if found.locked is not None:
        text += f", with the drives locked {significant(found.locked[k].value / 1e6)} N/µm"
    return f"{text}."


def _sentence(found: TargetLoop) -> str:
    loop = found.loop
    drives = ", ".join(str(servo) for servo in loop.servos)
    start = f"The loops of the drives {drives} are closed around the structure at home."
    worst = loop.slowest
    if not loop.stable:
        return (
            f"{start} The closed loop is unstable: {worst.part} grows at "
            f"{significant(worst.frequency)} Hz, so the machine has no dynamic stiffness with "
            "these gains. Lower the gains, raise the integral time or shorten the delay."
        )
    return (
        f"{start} The closed loop is stable; its slowest motion decays with a time constant of "
        f"{significant(-1e3 / worst.value.real)} ms ({worst.part}, {significant(worst.frequency)} "
        "Hz)."
    )


def _stiffness(found: TargetLoop) -> Table:
    rows: list[list[str | Cell]] = []
    for i, port in enumerate(found.loop.ports):
        row: list[str | Cell] = [str(port)]
        for each, none in ((found.least, "unstable"), (found.locked, "rigid")):
            if each is None:
                row += [none, "", ""]
                continue
            one = each[i]
            static = significant(one.static / 1e6) if one.static < float("inf") else "infinite"
            row += [significant(one.value / 1e6), significant(one.frequency, 4), static]
        rows.append(row)
    columns = (
        Column("port", "", False),
        Column("least with servos", "N/µm"),
        Column("at", "Hz"),
        Column("static", "N/µm"),
        Column("least with drives locked", "N/µm"),
        Column("at", "Hz"),
        Column("static", "N/µm"),
    )
    low, high = found.band
    proved = all(one.certified for one in (*(found.least or ()), *(found.locked or ())))
    return Table(
        f"Dynamic stiffness at the tool from {significant(low)} to {significant(high)} Hz, other "
        "axes free" + ("; each least value is proved to 1e-6" if proved else ""),
        columns,
        rows,
        f"{STEM}-servo-response.csv",
    )


def _response(found: TargetLoop) -> Figure:
    curves, marks = {}, []
    for i, port in enumerate(found.loop.ports):
        colour = AXIS_COLOURS[str(port.direction)]
        for each, least, words, dash in zip(
            found.curves,
            (found.least, found.locked),
            ("with servos", "locked"),
            ("solid", "dot"),
            strict=True,
        ):
            if each is None or least is None:
                continue
            name = f"{port}, {words}"
            curves[name] = (found.lines, each[:, i], colour, dash)
            marks.append((name, least[i].frequency, least[i].value, colour))
    return Figure(
        "servo-response",
        "Receptance at the tool: solid with the servos in the loop, dotted with the drives "
        "locked. Diamonds mark the least dynamic stiffness."
        if found.least is not None
        else "Receptance at the tool with the drives locked; with these gains there is none.",
        responses(curves, marks),
        "Receptance over frequency at the tool, with the drives controlled and locked.",
        f"{STEM}-servo-response.csv",
        420,
    )


def _margins(found: TargetLoop) -> Table:
    rows = [
        [str(one.servo), words, *margin_words(margins)]
        for one in found.loop.margins
        for words, margins in (("velocity", one.velocity), ("position", one.position))
    ]
    columns = (
        Column("drive", "", False),
        Column("loop", "", False),
        Column("gain margin"),
        Column("phase margin"),
        Column("crossover", "Hz"),
    )
    return Table("Stability margins", columns, rows, f"{STEM}-servo-margins.csv")


def _poles(found: TargetLoop) -> Table:
    poles = [p for i, p in enumerate(found.loop.poles) if i < NAMED or not p.stable]
    rows = [
        [p.part, significant(p.frequency, 4), f"{p.damping:.3g}", f"{100 * p.share:.0f} %"]
        for p in poles
    ]
    columns = (
        Column("what moves most", "", False),
        Column("frequency", "Hz"),
        Column("damping ratio"),
        Column("its share"),
    )
    return Table(
        f"Poles of the closed loops, the lowest {len(poles)} of {len(found.loop.poles)}",
        columns,
        rows,
        f"{STEM}-servo-poles.csv",
    )


def _controllers(found: TargetLoop) -> list[str]:
    """What is known of the controllers, equal ones together."""
    names: dict[str, list[str]] = {}
    for servo in found.loop.servos:
        turns = servo.direction.startswith("r")
        gain, inertia = ("N·m·s/rad", "kg·m²") if turns else ("N·s/m", "kg")
        text = (
            f"position gain {servo.position_gain:g} 1/s, velocity gain "
            f"{significant(servo.velocity_gain)} {gain} and inertia of the motor "
            f"{significant(servo.inertia)} {inertia} at the joint"
        )
        if servo.integral_time is not None:
            text += f", integral time {1e3 * servo.integral_time:g} ms"
        if servo.delay:
            text += f", delay {1e3 * servo.delay:g} ms"
        names.setdefault(f"{text}; encoder at the {servo.encoder}.", []).append(str(servo))
    return [f"{listed(drives)}: {text}" for text, drives in names.items()]
