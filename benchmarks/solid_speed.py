"""Ten lowest modes of an L-frame beside CalculiX, and a reduced frequency response, in one run.

Run `python -m benchmarks.solid_speed`; with `--write` its table goes to
docs/performance-solids.md. Each engine runs in a process of its own, and its processor time and
largest memory are the system's own count. CalculiX is Debian's `calculix-ccx`.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.solid_cases import SIZES, deck, frame_mesh, frame_pencil
from benchmarks.static_speed import machine_line
from fea.block_krylov import KrylovOptions, krylov_reduction
from fea.block_krylov_damping import MatrixDamping
from fea.factorize import factorize, installed_solvers
from fea.large_modes import lowest_modes
from fea.petsc import Ranks
from strutwork.files import write_text

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "performance-solids.md"
BEGIN, END = "<!-- measured -->", "<!-- end -->"

#: SLEPc with MUMPS in one process, for comparison; the launcher may be started by root.
ONE_RANK = Ranks(1, ("mpiexec", "--allow-run-as-root", "-n"))

#: Lines of the frequency response.
LINES = 1000


@dataclass(frozen=True)
class Run:
    """One engine's whole process, and what it said."""

    engine: str
    wall: float
    processor: float
    megabytes: float
    said: dict[str, Any]


def start(engine: str, command: list[str], folder: Path) -> Run:
    """Run a command to its end; its last line is JSON, or it leaves a .dat file."""
    output = folder / "output"
    begin = time.perf_counter()
    with output.open("wb") as sink:
        process = subprocess.Popen(command, stdout=sink, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    text = output.read_text(errors="replace")
    if status:
        message = f"{engine} failed:\n{text[-2000:]}"
        raise RuntimeError(message)
    said = json.loads(text.splitlines()[-1]) if engine != "CalculiX" else calculix_said(folder)
    processor = usage.ru_utime + usage.ru_stime
    return Run(engine, wall, processor, usage.ru_maxrss / 1024.0, said)


def calculix_said(folder: Path) -> dict[str, Any]:
    """Frequencies from CalculiX's .dat file, Hz."""
    rows = [line.split() for line in (folder / "frame.dat").read_text().splitlines()]
    found = [float(r[3]) for r in rows if len(r) == 5 and r[0].isdigit()]
    return {"frequencies": found[:10]}


def ours(size: str, solver: str) -> dict[str, Any]:
    """Assembly and ten modes."""
    begin = time.process_time()
    stiffness, mass, _ = frame_pencil(size)
    assembled = time.process_time()
    found = lowest_modes(stiffness, mass, 10, solver=solver, ranks=ONE_RANK)
    worker = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {
        "dofs": stiffness.shape[0],
        "assembly": assembled - begin,
        "modes": time.process_time() - assembled + worker.ru_utime + worker.ru_stime,
        "frequencies": found.frequencies.tolist(),
        "solver": found.solver,
    }


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
        said["cases"][name] = {
            "seconds": seconds,
            "share": seconds / factorised,
            "vectors": model.basis.shape[1],
            "estimated": model.error,
            "error": max(errors),
        }
    return said


def _error(
    stiffness: Any, mass: Any, loads: Any, damping: MatrixDamping, model: Any, frequency: float
) -> float:
    """Error of one line beside a direct solution."""
    import scipy.sparse as sp  # noqa: PLC0415 - only here

    w = 2.0 * np.pi * frequency
    dynamic = (1.0 + 1j * damping.loss_factor) * stiffness - w**2 * mass
    if damping.ports is not None:
        at = sp.csc_array(damping.ports)
        dynamic = dynamic + 1j * w * (at @ sp.diags_array(damping.dashpots) @ at.T)
    exact = loads.T @ factorize(sp.csc_array(dynamic)).solve(loads.astype(complex))
    return float(np.linalg.norm(model.receptance([frequency])[0] - exact) / np.linalg.norm(exact))


def engines(size: str, solvers: list[str]) -> list[Run]:
    """CalculiX's run and ours with each solver."""
    runs = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        ccx = shutil.which("ccx")
        if ccx is not None:
            mesh, held = frame_mesh(size)
            write_text(folder / "frame.inp", deck(mesh, held))
            runs.append(start("CalculiX", [ccx, "-i", str(folder / "frame")], folder))
        here = [sys.executable, "-m", "benchmarks.solid_speed", "--size", size, "--engine"]
        runs += [start(s, [*here, s], folder) for s in solvers]
    return runs


def table(sizes: list[str], solvers: list[str], response_size: str) -> str:
    """Measure everything and return the table."""
    lines = [
        machine_line(),
        "",
        "| dofs | engine | wall s | processor s | peak MB | of CalculiX's | modes s | apart |",
        "|---:|---|---:|---:|---:|---:|---:|---:|",
    ]
    for size in sizes:
        runs = engines(size, solvers)
        peer = runs[0] if runs[0].engine == "CalculiX" else None
        for run in runs:
            dofs = next(r.said["dofs"] for r in runs if "dofs" in r.said)
            ratio = f"{run.processor / peer.processor:.2f}" if peer else ""
            apart = (
                np.abs(np.array(run.said["frequencies"]) / peer.said["frequencies"] - 1).max()
                if peer
                else np.nan
            )
            lines.append(
                f"| {dofs:,} | {run.said.get('solver', run.engine)} | {run.wall:.1f} | "
                f"{run.processor:.1f} | {run.megabytes:,.0f} | {ratio} | "
                f"{run.said.get('modes', np.nan):.1f} | {apart:.1e} |"
            )
            sys.stderr.write(lines[-1] + "\n")
    lines += [
        "",
        f"{LINES} lines of the 3 x 3 receptance on top of one factorisation, {response_size} dofs:",
        "",
        "| factorisation | s | damping | s on top | share | vectors | error estimated | measured |",
        "|---|---:|---|---:|---:|---:|---:|---:|",
    ]
    with tempfile.TemporaryDirectory() as name:
        for solver in (s for s in solvers if s != "slepc"):
            command = [sys.executable, "-m", "benchmarks.solid_speed", "--size", response_size]
            said = start(solver, [*command, "--engine", solver, "--response"], Path(name)).said
            lines += [
                f"| {said['solver']} | {said['factorisation']:.1f} | {case} | {c['seconds']:.1f} | "
                f"{c['share']:.2f} | {c['vectors']} | {c['estimated']:.1e} | {c['error']:.1e} |"
                for case, c in said["cases"].items()
            ]
    return "\n".join(lines)


def main() -> None:
    """Measure, print and perhaps write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", choices=SIZES, action="append")
    parser.add_argument(
        "--solver", action="append", help="superlu, slepc, ...; by default all but slepc"
    )
    parser.add_argument("--engine", help="run one solver and print JSON")
    parser.add_argument("--response", action="store_true", help="with --engine: the response")
    parser.add_argument("--write", action="store_true", help="write docs/performance-solids.md")
    arguments = parser.parse_args()
    sizes = arguments.size or ["92k", "300k"]
    if arguments.engine:
        task = response if arguments.response else ours
        print(json.dumps(task(sizes[0], arguments.engine)))
        return
    text = table(sizes, arguments.solver or list(installed_solvers()), sizes[0])
    print(text)
    if arguments.write:
        page = DOCUMENT.read_text(encoding="utf-8")
        before, _, rest = page.partition(BEGIN)
        _, _, after = rest.partition(END)
        write_text(DOCUMENT, f"{before}{BEGIN}\n{text}\n{END}{after}")


if __name__ == "__main__":
    # one thread everywhere, set before any library of linear algebra is loaded by a child
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    main()
