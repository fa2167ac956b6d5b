"""The command line: one program, `strutwork`."""

from __future__ import annotations

import gc
import os
import sys

__all__ = ["main"]

#: New objects between two looks for garbage; 700 or 2000 by default.
FEW_LOOKS = 20_000


def main() -> None:
    """Run the program: the console script.

    Its matrices are stacks of small ones, on which threads of the BLAS lose up to twenty times on
    a busy machine: it takes one, unless the environment asks for a number.
    """
    if not {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"} & set(os.environ):
        # for the copies of NumPy and SciPy, which are not loaded yet
        os.environ["OPENBLAS_NUM_THREADS"] = "1"
        if "numpy" in sys.modules:
            # by a program that calls this one: it takes no variable any more
            from threadpoolctl import threadpool_limits

            threadpool_limits(limits=1, user_api="blas")
    # no plug-in has a part in a model file, and to look for one reads every installed package
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    # modules are read without garbage, for which Python looks a hundred times on the way
    gc.set_threshold(FEW_LOOKS)
    from strutwork.reports.cli.app import main as run

    run()
