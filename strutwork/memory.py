"""Memory that work will take, against what may be had, before it begins."""

from __future__ import annotations

from math import inf
from pathlib import Path

from strutwork.errors import NumericalError

MEMINFO = Path("/proc/meminfo")
CONTROL_GROUPS = (
    (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory.current")),
    (
        Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
        Path("/sys/fs/cgroup/memory/memory.usage_in_bytes"),
    ),
)

#: Bytes that dense matrices of one step may take whatever the machine has: beyond it their
#: solution, which grows faster than they do, would not end.
DENSE = 3e9


def available_memory() -> float:
    """Bytes that can be had without swapping; infinite where the system does not say.

    The least of the kernel's `MemAvailable`, of what a control group leaves, and of what the
    process' own limit leaves.
    """
    found = [inf]
    try:
        lines = MEMINFO.read_text(encoding="ascii").splitlines()
    except OSError:
        lines = []
    found += [1024.0 * float(x.split()[1]) for x in lines if x.startswith("MemAvailable:")]
    for limit, usage in CONTROL_GROUPS:
        try:
            found.append(float(limit.read_text()) - float(usage.read_text()))
        except (OSError, ValueError):  # absent, or the word "max"
            continue
    found.append(_own_limit())
    return min(found)


def require_dense(part: str, what: str, need: float, remedy: str) -> None:
    """Refuse dense work before it begins.

    Parameters
    ----------
    part : str
        What asks for it.
    what : str
        Its size in words, as in "dense matrices of 60 684 coordinates".
    need : float
        Bytes.
    remedy : str

    Raises
    ------
    NumericalError
        More than `DENSE`, or than is available.
    """
    available = available_memory()
    if need <= min(DENSE, available):
        return
    limit = (
        f"{DENSE / 1e9:g} GB are the limit of such work"
        if need > DENSE
        else f"{max(available, 0.0) / 1e9:.3g} GB are available"
    )
    raise NumericalError(part, f"{what} will take about {need / 1e9:.3g} GB; {limit}.", remedy)


def out_of_memory(error: MemoryError) -> NumericalError:
    """What to say where memory ran out all the same.

    Parameters
    ----------
    error : MemoryError
        As raised; its text, if any, stands in brackets in the message.
    """
    why = f" ({error})" if str(error) else ""
    return NumericalError(
        "memory",
        f"ran out{why}.",
        "Divide beams into fewer elements, mesh coarser, request fewer lines or samples, or give "
        "the process more memory.",
    )


def _own_limit() -> float:
    """Bytes that the limit of the process' address space leaves; infinite without one."""
    try:
        import resource  # noqa: PLC0415 - not on every system
    except ImportError:
        return inf
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    if soft == resource.RLIM_INFINITY:
        return inf
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except (OSError, ValueError):
        return float(soft)
    return float(soft - pages * resource.getpagesize())
