"""Connections to Dask clusters: one for each address, checked when it is made."""

from __future__ import annotations

import atexit
import logging
import os
import threading
import warnings
from contextlib import suppress
from importlib import import_module
from typing import Any

from strutwork.errors import ClusterError, StudyWarning
from strutwork.studies.cluster_work import Identity, identity

#: In place of an address: workers on this computer.
LOCAL = "local"

#: What Dask sets for its workers, by which they give memory back to the system after each step: the
#: large arrays of a chunk then take most of its time, 1.7 times that of a thread.
_TRIM = "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_"

_clients: dict[tuple[str, int | None], Any] = {}
_lock = threading.Lock()


def client_of(address: str, patience: float, workers: int | None = None) -> Any:
    """The connection to a cluster, made when there is none.

    Parameters
    ----------
    address : str
        Of the scheduler, or `LOCAL`.
    patience : float
        s; how long it may take to answer, and to have a worker.
    workers : int, optional
        Of a local cluster.

    Raises
    ------
    ClusterError
        Dask is not installed, no scheduler answers, it has no worker, or the workers have another
        Strutwork or Python.

    Warns
    -----
    StudyWarning
        The workers have other versions of the libraries that compute.
    """
    with _lock:
        known = _clients.get((address, workers))
        if known is not None and known.status == "running":
            return known
        made = _connected(address, patience, workers)
        try:
            check_versions(made)
        except BaseException:
            _close(made)
            raise
        _clients[address, workers] = made
        return made


def _connected(address: str, patience: float, workers: int | None) -> Any:
    try:
        # by its name: its classes are untyped
        dask: Any = import_module("dask")
        distributed: Any = import_module("distributed")
        from distributed.comm.addressing import parse_address  # noqa: PLC0415
        from distributed.comm.registry import get_backend  # noqa: PLC0415
    except ImportError as error:
        raise ClusterError(
            "cluster", "needs Dask, which is not installed.", "pip install strutwork[cluster]"
        ) from error
    # what they tell of lost connections is said by our errors
    for name in ("distributed", "tornado.application", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    if address == LOCAL:
        count = workers or len(os.sched_getaffinity(0))
        with dask.config.set({_TRIM: None}):
            cluster = distributed.LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                dashboard_address=":0",
                silence_logs=logging.CRITICAL,
            )
        client = distributed.Client(cluster, timeout=patience, set_as_default=False)
        # closed with the connection
        client.strutwork_cluster = cluster
        return client
    try:
        # a scheme that is none leaves a client behind that waits a minute for its end
        get_backend(parse_address(address)[0])
        with warnings.catch_warnings():
            # versions are compared here, with what matters to a study
            warnings.simplefilter("ignore")
            client = distributed.Client(address, timeout=patience, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        why = f"no scheduler answers within {patience:g} s"
        why = str(error) if isinstance(error, ValueError) else why
        raise ClusterError(
            f"cluster {address}",
            f"cannot be reached: {why}.",
            'Start it with `dask scheduler` and give the address that it prints, or "local".',
        ) from error
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError as error:
        _close(client)
        raise ClusterError(
            f"cluster {address}",
            f"has had no worker for {patience:g} s.",
            f"Start some, as in `dask worker {address}`, or wait until the queue has.",
        ) from error
    return client


def check_versions(client: Any) -> None:
    """Compare the workers' versions with those here.

    Parameters
    ----------
    client : distributed.Client

    Raises
    ------
    ClusterError
        Another Strutwork or Python, or none: functions cannot be sent.

    Warns
    -----
    StudyWarning
        Other libraries: numbers may differ in their last digits.
    """
    here = identity()
    for worker, there in client.run(identity, on_error="return").items():
        if not isinstance(there, Identity):
            raise ClusterError(
                f"worker {worker}",
                f"cannot load Strutwork ({type(there).__name__}: {there}).",
                "Install the same Strutwork there as here.",
            )
        if there.code != here.code:
            raise ClusterError(
                f"worker {worker}",
                f"has another Strutwork or Python: {there.code}; here it is {here.code}.",
                "Install the same there as here, and start the workers again.",
            )
        other = [
            f"{name} {there.libraries.get(name)} in place of {version}"
            for name, version in here.libraries.items()
            if there.libraries.get(name) != version
        ]
        if other:
            warnings.warn(
                f"worker {worker} has {', '.join(other)}: numbers may differ in their last digits.",
                StudyWarning,
                stacklevel=2,
            )


def forget(address: str, workers: int | None = None) -> None:
    """Close a connection, and the local cluster behind it.

    Parameters
    ----------
    address : str
    workers : int, optional
        As in `client_of`.
    """
    with _lock:
        client = _clients.pop((address, workers), None)
    if client is not None:
        _close(client)


def _close(client: Any) -> None:
    with suppress(Exception):
        client.close(timeout=2)
    cluster = getattr(client, "strutwork_cluster", None)
    if cluster is not None:
        with suppress(Exception):
            cluster.close(timeout=5)


@atexit.register
def _close_all() -> None:
    for address, workers in list(_clients):
        forget(address, workers)
