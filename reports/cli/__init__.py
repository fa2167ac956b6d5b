"""The command line: one program, `strutwork`."""

from __future__ import annotations

import os

__all__ = ["main"]


def main() -> None:
    """Run the program: the console script.

    Its matrices are stacks of small ones, on which threads of the BLAS lose up to twenty times on
    a busy machine: it takes one, unless the environment asks for a number.
    """
    if "OMP_NUM_THREADS" not in os.environ:
        # read when NumPy is loaded: before anything else is
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from strutwork.reports.cli.app import main as run

    run()
