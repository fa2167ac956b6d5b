"""Writers that are killed before each of their file operations."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from typing import Any

#: Audit events of Python's that touch files; those of shutil and tempfile repeat them.
_TOUCHING = ("open", "os.", "fcntl.", "shutil.", "tempfile.")


def killed_before(number: int, work: Callable[[], object]) -> bool:
    """Do `work` in a child that kills itself before its file operation `number`.

    Returns
    -------
    bool
        False when it ended before it got so far.
    """
    child = os.fork()
    if child == 0:
        left = number

        def hook(event: str, _: tuple[Any, ...]) -> None:
            nonlocal left
            if event.startswith(_TOUCHING) and event != "os.kill":
                left -= 1
                if left < 0:
                    os.kill(os.getpid(), signal.SIGKILL)

        sys.addaudithook(hook)
        ended = 1
        try:
            work()
            ended = 0
        finally:
            # an error too ends here: nothing of the test may run in the child
            os._exit(ended)
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        assert os.WTERMSIG(status) == signal.SIGKILL
        return True
    assert os.WEXITSTATUS(status) == 0
    return False
