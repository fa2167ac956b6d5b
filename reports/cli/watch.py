"""A watch beside a command: says what long work is at, and lets Ctrl-C through to any of it."""

from __future__ import annotations

import os
import select
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from strutwork.stages import Stage, current

#: Work shorter than this is not worth a word, and then time between two words, s.
PATIENCE = 2.0
INTERVAL = 15.0

#: How long compiled code may go on after Ctrl-C before the process ends without it, s.
GRACE = 1.0

#: Exit status of a command that was interrupted: 128 and the number of the signal.
INTERRUPTED = 130

_SAID = "Interrupted: no file is left half written.\n"


@contextmanager
def watched() -> Iterator[None]:
    """Watch the work inside.

    Ctrl-C ends it with one line and `INTERRUPTED`. Python's own handler waits for the end of a
    factorisation; here another thread hears of the signal at once.
    """
    if (
        threading.current_thread() is not threading.main_thread()
        or signal.getsignal(signal.SIGINT) is not signal.default_int_handler
    ):
        # someone else has the signal: a notebook, another program
        yield
        return
    ear, mouth = socket.socketpair()
    mouth.setblocking(False)
    done = threading.Event()
    thread = threading.Thread(target=_watch, args=(ear, done), daemon=True)
    heard = signal.set_wakeup_fd(mouth.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, _interrupted)
    thread.start()
    try:
        yield
    finally:
        done.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.set_wakeup_fd(heard)
        mouth.send(b"\0")
        thread.join()
        ear.close()
        mouth.close()


def _interrupted(*_: object) -> None:
    sys.stderr.write(_SAID)
    sys.stderr.flush()
    raise SystemExit(INTERRUPTED)


def _watch(ear: socket.socket, done: threading.Event) -> None:
    last: Stage | None = None
    begun = time.monotonic()
    due = begun + PATIENCE
    while not done.is_set():
        ready, _, _ = select.select([ear], [], [], max(due - time.monotonic(), 0.0))
        if ready:
            if signal.SIGINT in ear.recv(64) and not done.wait(GRACE):
                os.write(2, _SAID.encode("ascii"))
                # files are written whole or not at all: nothing is left half done
                os._exit(INTERRUPTED)
            continue
        now = time.monotonic()
        at = current() or Stage("", begun=begun)
        # a new piece of work has its own time before it is spoken of
        if at is last or now - at.begun >= PATIENCE:
            _say(at, now)
            due = now + INTERVAL
        else:
            due = at.begun + PATIENCE
        last = at


def _say(at: Stage, now: float) -> None:
    # that work goes on without a word of what it is helps who waits at a terminal only
    if at.silent or (not at.what and not sys.stderr.isatty()):
        return
    try:
        text = at.line(now)
        sys.stderr.write(f"{text[:1].upper()}{text[1:]}\n")
        sys.stderr.flush()
    except (OSError, ValueError):  # closed: nobody reads
        return
