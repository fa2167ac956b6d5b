"""How the program ends: its exit status, and output that cannot be written."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from strutwork.errors import OutputError, StrutworkError
from strutwork.files import write_error
from strutwork.memory import out_of_memory

#: Exit status where the model is wrong or cannot be solved.
WRONG = 1

#: What NumPy warns of where a number leaves the range of doubles.
OUT_OF_RANGE = r"(overflow|underflow|invalid value|divide by zero) encountered"

#: Modules that may meet such a number on the way to a sound answer: trial steps of a search, empty
#: places of a picture. Solvers check what comes of it; NumPy's own modules work on our numbers.
CHECKED = r"(gmsh|h5netcdf|matplotlib|meshio|pandas|plotly|pyvista|scipy|sfepy|trimesh|xarray)\b"

#: Exit status where a result cannot be written.
UNWRITTEN = 3

#: Exit status where the reader of the output went away: 128 and SIGPIPE, as in a shell.
UNREAD = 141


def guarded(program: Callable[[], object]) -> int:
    """Run a program and turn what it raises into one message and an exit status.

    Parameters
    ----------
    program : callable
        Prints, and ends by returning or by SystemExit.

    Returns
    -------
    int
        The exit status.
    """
    if sys.stderr is None:
        sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115
    if sys.stdout is None:
        # the next file opened would get its number, and what libraries print
        _say("standard output: is closed.\nSend it to a file, or to /dev/null.")
        return UNWRITTEN
    try:
        status = _status(program)
        # what is still held back fails here, where it can be told
        sys.stdout.flush()
    except StrutworkError as error:
        _say(str(error))
        return UNWRITTEN if isinstance(error, OutputError) else WRONG
    except (FloatingPointError, OverflowError, RuntimeWarning) as error:
        # a number that is made of one that overflowed may look sound
        _say(
            f"numbers: exceed the range of double precision ({error}); every result is "
            "withheld.\nLook for a quantity or an option that is out of proportion to the "
            "others, such as a size in the wrong unit."
        )
        return WRONG
    except MemoryError as error:
        _say(str(out_of_memory(error)))
        return WRONG
    except OSError as error:
        _drop_output()
        if error.errno == errno.EPIPE:
            return UNREAD
        _say(str(write_error(error.filename or "standard output", error)))
        return UNWRITTEN
    return status


def _status(program: Callable[[], object]) -> int:
    try:
        program()
    except SystemExit as end:
        # click turns the end of the reader into a status of its own
        if isinstance(end.__context__, BrokenPipeError):
            raise end.__context__ from None
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    return 0


def _say(problem: str) -> None:
    with suppress(OSError):
        sys.stderr.write(f"Error: {problem}\n")
        sys.stderr.flush()


def _drop_output() -> None:
    """Let what cannot be written go nowhere: the interpreter would try it again at its end."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
