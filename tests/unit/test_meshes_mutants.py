"""Damaged mesh files: a mesh or an error that names the file, nothing else."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from strutwork.errors import ModelError
from strutwork.meshes import read_mesh, write_mesh
from tests.mesh_cases import every_kind

CASES = Path(__file__).parents[1] / "cases"
PIECES = (
    *(b"9999999999999999999", b"-1", b"nan", b"1e999", b"1.5"),
    *(b"\0", b",,,", b"\n", b"*NODE\n", b"\xff"),
)


def mutant(content: bytes, rng: random.Random) -> bytes:
    """The content with a byte, a piece or a stretch changed."""
    made = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 5))):
        at = rng.randrange(len(made))
        how = rng.randrange(5)
        if how == 0:
            made[at] = rng.randrange(256)
        elif how == 1:
            made[at] = ord(rng.choice('0123456789,.*+-$\n E"'))
        elif how == 2:
            del made[at : at + rng.choice((1, 3, 20))]
        elif how == 3:
            made[at:at] = rng.choice(PIECES)
        else:
            del made[max(at, 1) :]
        made = made or bytearray(b"x")
    return bytes(made)


def outcome(path: Path) -> Exception | None:
    """The error of reading a file, None for none."""
    try:
        read_mesh(path)
    except ModelError as error:
        return error
    return None


@pytest.mark.parametrize("suffix", [".inp", ".bdf", ".msh", ".vtu", ".med"])
@pytest.mark.parametrize("kind", ["hexahedron", "tetra10"])
def test_a_damaged_file_is_a_mesh_or_an_error(suffix: str, kind: str, tmp_path: Path) -> None:
    rng = random.Random(f"{suffix} {kind}")  # noqa: S311 - the same mutants every time
    whole = write_mesh(every_kind()[kind], tmp_path / f"seed{suffix}")
    seeds = [p.read_bytes() for p in (whole, *sorted(CASES.rglob(f"*{suffix}")))]
    path = tmp_path / f"mutant{suffix}"
    refused = 0
    for _ in range(120):
        path.write_bytes(mutant(rng.choice(seeds), rng))
        error = outcome(path)
        refused += error is not None
        # an error that only repeats an exception is one that was not foreseen
        assert error is None or error.__cause__ is None or isinstance(error.__cause__, ModelError)
    assert refused > 0
