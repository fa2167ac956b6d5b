"""The command line: one program, `strutwork`."""

from __future__ import annotations

import os

from threadpoolctl import threadpool_limits

__all__ = ["main"]


def main() -> None:
    """Run the program: the console script.

    Its matrices are stacks of small ones, on which threads of the BLAS lose up to twenty times on
    a busy machine: it takes one, unless the environment asks for a number.
    """
    if not {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"} & set(os.environ):
        # SciPy's, which is not loaded yet, and NumPy's, which is
        os.environ["OPENBLAS_NUM_THREADS"] = "1"
        threadpool_limits(limits=1, user_api="blas")
    from strutwork.reports.cli.app import main as run

    run()
