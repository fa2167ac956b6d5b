"""Tool compliance of many poses through the compiled kernel, on one or more threads."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System, system_of
from strutwork.msa.program import Program
from strutwork.msa.program_builder import compile_program, element_offsets
from strutwork.msa.structure import PlacedStructure, Structure
from strutwork.msa.trust import TRUSTED
from strutwork.msa.variant_of import Programs, origin_of, renumbered, shared_programs

Array = NDArray[Any]

#: Poses handed to a thread at once.
PIECE = 8192

#: A pose whose error, by the correction of one wrench in the norm of its work, exceeds this is
#: solved again with diagnosis: a tenth of what is trusted, for the error of single columns was seen
#: to be nine times the estimate. The measure is that of `strutwork.msa.trust`. Poses near a
#: singularity lose digits so; solving one again costs as much as thousands.
ERROR_LIMIT = 0.1 * TRUSTED

#: A pose whose smallest pivot is below this share of its diagonal entry likewise.
PIVOT_LIMIT = 1e-5

#: So is one whose loops hardly determine their dependent coordinates, or whose redundant rows, of
#: order one, are not redundant at that pose to this.
LOOP_LIMIT, REDUNDANT_LIMIT = 1e-5, 1e-11

#: Doubtful poses, twice over, from which another choice of dependent coordinates is tried.
RENEWED_FROM = 256


@cache
def available() -> bool:
    """Whether the compiled kernel can be used: numba is installed."""
    try:
        import strutwork.msa.kernel  # noqa: F401, PLC0415 - numba is slow to import and may be absent
    except ImportError:
        return False
    return True


def program_of(system: System) -> Program | None:
    """The program of the system's structure, made once and kept with the structure.

    That of a structure which differs from another in numbers alone is the other's with its numbers:
    of those that a study made beforehand, or else made on these poses.

    Parameters
    ----------
    system : System
        On whose poses the dependent coordinates of closed loops are chosen.
    """
    structure: Structure = system.placed.structure
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    kept = structure.__dict__
    name = _kept_as(system)
    if name not in kept:
        origin, programs = origin_of(structure), shared_programs(structure)
        if origin is None or (programs is not None and name not in programs):
            kept[name] = compile_program(system)
        else:
            shared = (
                program_of(system_of(PlacedStructure(origin, system.placed.placement)))
                if programs is None
                else programs[name]
            )
            kept[name] = (
                None
                if shared is None
                else renumbered(shared, structure, element_offsets(structure))
            )
    program: Program | None = kept[name]
    return program


def programs_on(placed: PlacedStructure) -> Programs:
    """The programs that all variants of a structure share in a study, made on some of its poses.

    They are kept by the study and not with the structure, so that what was solved before, with
    whichever poses, has no part in them.

    Parameters
    ----------
    placed : PlacedStructure
        Of the structure that the variants share their topology with; at one pose or more.
    """
    system = system_of(placed)
    return {_kept_as(system): compile_program(system)} if available() else {}


def _kept_as(system: System) -> str:
    return "_program" if system.placed.placement.turns is None else "_turned_program"


def compiled_compliance(
    system: System, program: Program, workers: int = 1, *, keeps: bool = True
) -> tuple[Array, NDArray[np.bool_]]:
    """Tool compliance at every pose of a system.

    Where most poses are doubtful, the loops' dependent coordinates are chosen anew on those, and
    the better program is kept.

    Parameters
    ----------
    system : System
        With p poses.
    program : Program
        From `program_of`.
    workers : int
        Threads; each takes pieces of the batch.
    keeps : bool
        Whether a better program serves the next systems too; their answers then differ, by
        rounding, with what came before them.

    Returns
    -------
    compliance : (p, 6, 6)
    doubtful : (p,)
        True where a pivot or the error is not good: solve these another way.
    """
    compliance, again = _run(system, program, workers)
    if len(program.loops.joint) and 2 * again.sum() > max(system.poses, RENEWED_FROM):
        part = system_of(system.placed[again])
        renewed = compile_program(part)
        if renewed is not None and _dependent(renewed) != _dependent(program):
            compliance[again], doubt = _run(part, renewed, workers)
            if keeps and 2 * doubt.sum() < part.poses:
                system.placed.structure.__dict__[_kept_as(system)] = renewed
            again[again] = doubt
    return compliance, again


def _dependent(program: Program) -> set[tuple[int, int]]:
    """Joint and direction of the coordinates that the program takes to follow from others."""
    found = program.loops.dependent
    direction = program.axis_direction[found] + 3 * program.turns[found]
    return set(zip(program.axis_joint[found].tolist(), direction.tolist(), strict=True))


def _frames(part: PlacedStructure) -> Array:
    """Frames of the joints, then rotations of the bodies where these carry axes, (q, f, 3, 3)."""
    frames, turns = part.placement.frames, part.placement.turns
    return frames if turns is None else np.concatenate([frames, turns], axis=1)


def _run(system: System, program: Program, workers: int) -> tuple[Array, NDArray[np.bool_]]:
    from strutwork.msa.kernel import run_program  # noqa: PLC0415 - as in `available`

    poses = system.poses
    compliance = np.empty((poses, 6, 6))
    quality = np.empty((poses, 4))

    def piece(start: int) -> None:
        stop = min(start + PIECE, poses)
        part = PlacedStructure(system.placed.structure, system.placed.placement[start:stop])
        run_program(
            program,
            np.ascontiguousarray(part.positions, dtype=float),
            np.ascontiguousarray(_frames(part), dtype=float),
            compliance[start:stop],
            quality[start:stop],
        )

    starts = range(0, poses, PIECE)
    if workers > 1 and len(starts) > 1:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(piece, starts))
    else:
        for start in starts:
            piece(start)
    good = (quality[:, 0] > PIVOT_LIMIT) & (quality[:, 1] <= ERROR_LIMIT)
    good &= (quality[:, 2] > LOOP_LIMIT) & (quality[:, 3] <= REDUNDANT_LIMIT)
    good &= np.isfinite(compliance).all(axis=(1, 2))
    return compliance, ~good
