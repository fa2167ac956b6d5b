"""Ten lowest modes of an L-frame beside CalculiX and SLEPc, and a reduced frequency response.

Run `python -m benchmarks.solid_speed`; with `--write` its tables go to
docs/performance-solids.md, those of other sizes than `--size` left as they are. Each engine runs
in a process of its own, and its processor time and largest memory are the system's own count.
CalculiX is Debian's `calculix-ccx`; SLEPc with MUMPS its `python3-petsc4py` and `python3-slepc4py`.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from benchmarks.solid_cases import SIZES, deck, frame_mesh, frame_pencil
from strutwork.fea.block_krylov import KrylovOptions, krylov_reduction
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.factorize import factorize, installed_solvers
from strutwork.fea.large_modes import lowest_modes
from strutwork.fea.petsc import petsc_environment, petsc_python
from strutwork.files import write_text

#: `benchmarks.measure` is no part of an engine's run: what it imports would count.
ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs" / "performance-solids.md"

#: Modes of every engine.
MODES = 10

#: Lines of the frequency response, and the size at which it is measured.
LINES, RESPONSE_SIZES = 1000, ("smallest", "92k")

#: Frequencies agree with CalculiX's, which prints seven digits, and of the same matrices among all
#: solvers, to these shares; a response with direct lines to the tolerance it was given.
APART, SAME = 1e-5, 1e-9

CALCULIX, SLEPC = "CalculiX", "SLEPc with MUMPS"


@dataclass(frozen=True)
class Run:
    """One engine's whole process, and what it said."""

    engine: str
    wall: float
    processor: float
    megabytes: float
    said: dict[str, Any]


def start(
    engine: str, command: list[str], folder: Path, environment: dict[str, str] | None = None
) -> Run:
    """Run a command to its end; its last line is JSON, or it leaves a .dat file.

    CalculiX runs in the folder: it leaves a log where it runs.
    """
    output = folder / "output"
    begin = time.perf_counter()
    with output.open("wb") as sink:
        process = subprocess.Popen(
            command,
            stdout=sink,
            stderr=subprocess.STDOUT,
            env=environment,
            cwd=folder if engine == CALCULIX else ROOT,
        )
        _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    text = output.read_text(errors="replace")
    if status:
        message = f"{engine} failed:\n{text[-2000:]}"
        raise RuntimeError(message)
    said = json.loads(text.splitlines()[-1]) if engine != CALCULIX else calculix_said(folder)
    processor = usage.ru_utime + usage.ru_stime
    return Run(engine, wall, processor, usage.ru_maxrss / 1024.0, said)


def calculix_said(folder: Path) -> dict[str, Any]:
    """Frequencies from CalculiX's .dat file, Hz."""
    rows = [line.split() for line in (folder / "frame.dat").read_text().splitlines()]
    found = [float(r[3]) for r in rows if len(r) == 5 and r[0].isdigit()]
    return {"frequencies": found[:MODES]}


def ours(size: str, solver: str) -> dict[str, Any]:
    """Assembly and ten modes."""
    begin = time.process_time()
    stiffness, mass, _ = frame_pencil(size)
    return _modes(stiffness, mass, solver) | {"whole": time.process_time() - begin}


def ours_from(folder: Path, solver: str) -> dict[str, Any]:
    """Ten modes of matrices from files."""
    stiffness, mass = (sp.csc_array(sp.load_npz(folder / name)) for name in ("K.npz", "M.npz"))
    return _modes(stiffness, mass, solver)


def _modes(stiffness: sp.csc_array, mass: sp.csc_array, solver: str) -> dict[str, Any]:
    begin = time.process_time()
    found = lowest_modes(stiffness, mass, MODES, solver=solver)
    return {
        "dofs": stiffness.shape[0],
        "modes": time.process_time() - begin,
        "frequencies": found.frequencies.tolist(),
        "solver": found.solver,
    }


def prepare(size: str, folder: Path) -> dict[str, Any]:
    """Write CalculiX's input and the matrices.

    In a process of its own: a child's largest memory is never less than its parent's.
    """
    mesh, held = frame_mesh(size)
    write_text(folder / "frame.inp", deck(mesh, held))
    stiffness, mass, _ = frame_pencil(size)
    sp.save_npz(folder / "K.npz", stiffness, compressed=False)
    sp.save_npz(folder / "M.npz", mass, compressed=False)
    return {"dofs": stiffness.shape[0]}


def response(size: str, solver: str) -> dict[str, Any]:
    """Seconds of a factorisation and of 1000 lines on top of it, and errors of direct lines."""
    stiffness, mass, patch = frame_pencil(size)
    n = stiffness.shape[0]
    loads = np.zeros((n, 3))
    for i in range(3):
        loads[patch + i, i] = 1.0 / len(patch)
    begin = time.process_time()
    factor = factorize(stiffness, solver)
    factorised = time.process_time() - begin
    at = np.array([n // 5, n // 3, n // 2, n - n // 7]) // 3 * 3
    ports = np.zeros((n, 4))
    for column, row in enumerate(at):
        ports[row + column % 3 : row + 90 : 3, column] = 1.0 / 30.0
    local = 1.0 / np.einsum("ij,ij->j", ports, factor.solve(ports))
    band = (1.0, 1000.0)
    said: dict[str, Any] = {"factorisation": factorised, "solver": factor.name, "cases": {}}
    for name, damping, tolerance in (
        ("loss factor 0.01", MatrixDamping(loss_factor=0.01), 1e-8),
        (
            "loss factor 0.005 and four dashpots",
            MatrixDamping(loss_factor=0.005, ports=ports, dashpots=0.3 * local / 2000.0),
            1e-6,
        ),
    ):
        begin = time.process_time()
        options = KrylovOptions(tolerance=tolerance)
        model = krylov_reduction(stiffness, mass, loads, band, damping, options, factor)
        model.receptance(np.linspace(*band, LINES))
        seconds = time.process_time() - begin
        errors = [_error(stiffness, mass, loads, damping, model, f) for f in (model.worst, 517.0)]
        if not max(errors) <= tolerance:
            message = f"the response with {name} is {max(errors):.1e} from direct lines"
            raise RuntimeError(message)
        said["cases"][name] = {
            "seconds": seconds,
            "share": seconds / factorised,
            "vectors": model.basis.shape[1],
            "bound": model.error,
            "error": max(errors),
        }
    return said


def _error(
    stiffness: Any, mass: Any, loads: Any, damping: MatrixDamping, model: Any, frequency: float
) -> float:
    """Error of one line beside a direct solution."""
    w = 2.0 * np.pi * frequency
    dynamic = (1.0 + 1j * damping.loss_factor) * stiffness - w**2 * mass
    if damping.ports is not None:
        at = sp.csc_array(damping.ports)
        dynamic = dynamic + 1j * w * (at @ sp.diags_array(damping.dashpots) @ at.T)
    exact = loads.T @ factorize(sp.csc_array(dynamic)).solve(loads.astype(complex))
    return float(np.linalg.norm(model.receptance([frequency])[0] - exact) / np.linalg.norm(exact))


def engines(size: str, solvers: list[str], folder: Path) -> tuple[list[Run], list[Run]]:
    """Whole runs, CalculiX's first, and runs from the matrices on, SLEPc's first."""
    here = [sys.executable, "-m", "benchmarks.solid_speed", "--size", size]
    start("preparation", [*here, "--prepare", str(folder)], folder)
    whole, rest = [], []
    ccx = shutil.which("ccx")
    if ccx is None:
        left_out(CALCULIX)
    else:
        whole.append(start(CALCULIX, [ccx, "-i", str(folder / "frame")], folder))
    whole += [start(s, [*here, "--engine", s], folder) for s in solvers]
    python = petsc_python()
    if python is None:
        left_out(SLEPC)
    else:
        command = [python, str(Path(__file__).with_name("slepc_modes.py")), str(folder), str(MODES)]
        rest.append(start(SLEPC, command, folder, petsc_environment()))
    rest += [start(s, [*here, "--engine", s, "--matrices", str(folder)], folder) for s in solvers]
    for runs, limit in ((whole, APART), (rest, SAME)):
        for run in runs[1:]:
            gap = _gap(run, runs[0])
            if not gap <= limit:
                message = f"{run.engine} is {gap:.1e} from {runs[0].engine}"
                raise RuntimeError(message)
    return whole, rest


def left_out(engine: str) -> None:
    """Say that a peer is left out."""
    sys.stderr.write(f"{engine} is not installed: its row is left out.\n")


def _gap(run: Run, peer: Run) -> float:
    return float(np.abs(np.array(run.said["frequencies"]) / peer.said["frequencies"] - 1.0).max())


def _apart(run: Run, peer: Run) -> str:
    """Largest relative difference of a frequency."""
    return f"{_gap(run, peer):.0e}" if run is not peer else ""


def whole_table(runs: list[Run]) -> list[str]:
    """Whole runs beside CalculiX's."""
    lines = [
        "| engine | wall s | processor s | peak MB | of CalculiX's time | apart |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    peer = runs[0] if runs[0].engine == CALCULIX else None
    for run in runs:
        beside = f"{run.processor / peer.processor:.2f} | {_apart(run, peer)}" if peer else " | "
        lines.append(
            f"| {run.said.get('solver', run.engine)} | {run.wall:.1f} | {run.processor:.1f} | "
            f"{run.megabytes:,.0f} | {beside} |"
        )
    return lines


def matrices_table(runs: list[Run]) -> list[str]:
    """Runs from the matrices on beside SLEPc's."""
    lines = [
        "| engine | processor s | peak MB | of SLEPc's time | of SLEPc's memory | apart |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    peer = runs[0] if runs[0].engine == SLEPC else None
    for run in runs:
        beside = " | | "
        if peer:
            seconds = run.said["modes"] / peer.said["modes"]
            memory = run.megabytes / peer.megabytes
            beside = f"{seconds:.2f} | {memory:.2f} | {_apart(run, peer)}"
        lines.append(
            f"| {run.said['solver']} | {run.said['modes']:.1f} | {run.megabytes:,.0f} | {beside} |"
        )
    return lines


def response_table(size: str, solvers: list[str], folder: Path) -> list[str]:
    """Lines of a response on top of a factorisation."""
    lines = [
        "| factorisation | s | damping | s on top | share | vectors | error at most | measured |",
        "|---|---:|---|---:|---:|---:|---:|---:|",
    ]
    for solver in solvers:
        command = [sys.executable, "-m", "benchmarks.solid_speed", "--size", size]
        said = start(solver, [*command, "--engine", solver, "--response"], folder).said
        lines += [
            f"| {said['solver']} | {said['factorisation']:.1f} | {case} | {c['seconds']:.1f} | "
            f"{c['share']:.2f} | {c['vectors']} | {c['bound']:.1e} | {c['error']:.1e} |"
            for case, c in said["cases"].items()
        ]
    return lines


def tables(size: str, solvers: list[str]) -> str:
    """Measure one size and return its tables."""
    from benchmarks.measure import machine_line  # noqa: PLC0415 - no part of an engine's run

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        whole, rest = engines(size, solvers, folder)
        lines = [
            f"{rest[-1].said['dofs']:,} degrees of freedom. {machine_line()}",
            "",
            "Complete runs:",
            "",
            *whole_table(whole),
            "",
            "From the assembled matrices on:",
            "",
            *matrices_table(rest),
        ]
        sys.stderr.write("\n".join(lines) + "\n")
        if size in RESPONSE_SIZES:
            lines += ["", f"{LINES} lines of the 3 x 3 receptance on top of one factorisation:", ""]
            lines += response_table(size, solvers, folder)
    return "\n".join(lines)


def merged(page: str, size: str, text: str) -> str:
    """The page with one size's tables replaced."""
    begin, end = f"<!-- measured {size} -->", f"<!-- end {size} -->"
    before, found, rest = page.partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        message = f"docs/performance-solids.md has no place for {size}: {begin} ... {end}"
        raise RuntimeError(message)
    return f"{before}{begin}\n{text}\n{end}{after}"


def main() -> None:
    """Measure, print and perhaps write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", choices=SIZES, action="append", help="by default 92k and 300k")
    parser.add_argument("--smallest", action="store_true", help="some thousand dofs, in seconds")
    parser.add_argument("--solver", action="append", help="by default all that are installed")
    parser.add_argument("--engine", help="run one solver and print JSON")
    parser.add_argument("--matrices", type=Path, help="with --engine: the folder they come from")
    parser.add_argument("--response", action="store_true", help="with --engine: the response")
    parser.add_argument("--prepare", type=Path, help="write the input of all engines to a folder")
    parser.add_argument("--write", action="store_true", help="write docs/performance-solids.md")
    arguments = parser.parse_args()
    if arguments.smallest and arguments.write:
        parser.error("--smallest is a check; its figures are not written")
    sizes = ["smallest"] if arguments.smallest else arguments.size or ["92k", "300k"]
    if arguments.prepare:
        print(json.dumps(prepare(sizes[0], arguments.prepare)))
    elif arguments.matrices:
        print(json.dumps(ours_from(arguments.matrices, arguments.engine)))
    elif arguments.engine:
        task = response if arguments.response else ours
        print(json.dumps(task(sizes[0], arguments.engine)))
    else:
        for size in sizes if arguments.write else ():
            # a page without a place for them is told before minutes of measurement, not after
            merged(DOCUMENT.read_text(encoding="utf-8"), size, "")
        for size in sizes:
            text = tables(size, arguments.solver or list(installed_solvers()))
            print(text)
            if arguments.write:
                page = DOCUMENT.read_text(encoding="utf-8")
                write_text(DOCUMENT, merged(page, size, text))


if __name__ == "__main__":
    # one thread everywhere, set before any library of linear algebra is loaded by a child
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    main()
