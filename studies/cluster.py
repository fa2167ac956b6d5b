"""A cluster in place of threads: Dask's workers, here or elsewhere.

Workers need no common disk: a study's function is sent once to each of them, results come back as
soon as they are ready, and this process alone writes.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from dataclasses import dataclass
from queue import Empty, Queue
from typing import Any, TypeVar

from strutwork.errors import ClusterError
from strutwork.studies.cluster_client import LOCAL, client_of, forget
from strutwork.studies.cluster_work import compute, identity, pickled

C = TypeVar("C")
R = TypeVar("R")

#: Chunks under way for each thread of the workers: one in hand, one at hand.
AHEAD = 2
#: Finished chunks that wait for the reader, in sizes of what is under way.
WAITING = 4
#: Time for a result to come, unless its worker died, s.
FETCH = 5.0
#: Time between two looks at a cluster that sends nothing, s.
LOOK = 1.0


@dataclass(frozen=True)
class Dask:
    """Workers of a Dask cluster.

    Parameters
    ----------
    address : str
        Of its scheduler, as in "tcp://10.0.0.1:8786"; "local" starts workers on this computer, one
        per processor.
    patience : float
        s; how long a scheduler may take to answer, and how long a cluster may be without a worker.
    workers : int or None
        Of a local cluster, each a process with one thread; default one per processor.
    """

    address: str = LOCAL
    patience: float = 30.0
    workers: int | None = None

    def map(
        self,
        function: Callable[[C], R],
        chunks: Iterable[C],
        keep: Callable[[C, R], object] | None = None,
        lost: Callable[[Exception], R] | None = None,
    ) -> Iterator[R]:
        """Results in the order of the chunks; at most two for each of the workers' threads.

        Parameters
        ----------
        function : callable
            From a chunk to its result; sent to the workers by cloudpickle.
        chunks : iterable
        keep, lost : callable, optional
            As `strutwork.studies.executor.Executor`.

        Raises
        ------
        ClusterError
            The scheduler does not answer or goes away, there is no worker for `patience`, the
            workers have another Strutwork or Python, or the function cannot be sent.
        """
        payload = pickled(function)
        client = client_of(self.address, self.patience, self.workers)
        flow = _Flow(client, self, payload, keep, lost)
        try:
            yield from flow.results(iter(chunks))
        finally:
            flow.close()

    def close(self) -> None:
        """End the connection, and the workers of a local cluster."""
        forget(self.address, self.workers)


class _Flow:
    """Chunks on their way to the workers, and results on their way back."""

    def __init__(
        self,
        client: Any,
        of: Dask,
        payload: bytes,
        keep: Callable[[Any, Any], object] | None,
        lost: Callable[[Exception], Any] | None,
    ) -> None:
        self.client, self.of, self.keep, self.lost = client, of, keep, lost
        self.digest = hashlib.sha256(payload).hexdigest()
        self.done: Queue[Any] = Queue()
        self.under_way: dict[Any, tuple[int, Any]] = {}
        self.ready: dict[int, Any] = {}
        self.threads, self.looked, self.alone = 1, 0.0, time.monotonic()
        self.look()
        # a task of its own: a worker that dies takes a copy with it, not the function
        self.payload = client.submit(bytes, payload, key=f"strutwork-{self.digest}", pure=True)

    def results(self, chunks: Iterator[Any]) -> Iterator[Any]:
        sent, wanted, more = 0, 0, True
        while True:
            while more and len(self.under_way) < AHEAD * self.threads and self._has_space():
                chunk = next(chunks, _END)
                if chunk is _END:
                    more = False
                    break
                self._send(sent, chunk)
                sent += 1
            self._collect(block=wanted not in self.ready and bool(self.under_way))
            while wanted in self.ready:
                wanted += 1
                yield self.ready.pop(wanted - 1)
                self._collect(block=False)
            if not more and not self.under_way and not self.ready:
                return

    def _has_space(self) -> bool:
        return len(self.ready) < WAITING * AHEAD * self.threads

    def _send(self, number: int, chunk: Any) -> None:
        try:
            future = self.client.submit(
                compute, self.digest, self.payload, chunk, identity().code, pure=False
            )
        except Exception as error:
            raise self._gone(error) from error
        self.under_way[future] = number, chunk
        future.add_done_callback(self.done.put)

    def _collect(self, *, block: bool) -> None:
        """Take what is ready; with nothing ready, wait for it."""
        while True:
            try:
                future = self.done.get(timeout=LOOK) if block else self.done.get_nowait()
            except Empty:
                self.look()
                if block:
                    continue
                return
            self._take(future)
            block = False

    def _take(self, future: Any) -> None:
        number, chunk = self.under_way[future]
        try:
            found = self._result(future)
        except TimeoutError:
            # its worker died with the result: the scheduler has it computed again
            self.look()
            future.add_done_callback(self.done.put)
            return
        del self.under_way[future]
        future.release()
        self.ready[number] = found
        if self.keep is not None:
            self.keep(chunk, found)

    def _result(self, future: Any) -> Any:
        from distributed import KilledWorker  # noqa: PLC0415 - where the extra is installed
        from distributed.client import FutureCancelledError  # noqa: PLC0415

        try:
            return future.result(timeout=FETCH)
        except TimeoutError:
            raise
        except KilledWorker as error:
            told = ClusterError(
                "worker",
                f"ended {error.allowed_failures + 1} times while it computed this chunk.",
                "Look into its log: it may have run out of memory.",
            )
            if self.lost is None:
                raise told from error
            return self.lost(told)
        except (FutureCancelledError, CancelledError, OSError) as error:
            raise self._gone(error) from error

    def look(self) -> None:
        """See that the scheduler is there and has workers, now and then."""
        now = time.monotonic()
        if now - self.looked < LOOK:
            return
        self.looked = now
        try:
            threads = self.client.sync(
                self.client.scheduler.ncores, callback_timeout=self.of.patience
            )
        except Exception as error:
            raise self._gone(error) from error
        total = sum(threads.values())
        if total:
            self.threads, self.alone = total, now
        elif now - self.alone > self.of.patience:
            raise ClusterError(
                f"cluster {self.of.address}",
                f"has had no worker for {self.of.patience:g} s.",
                "Start some, as in `dask worker ADDRESS`, or wait until the queue has.",
            )

    def _gone(self, error: Exception) -> ClusterError:
        forget(self.of.address, self.of.workers)
        return ClusterError(
            f"cluster {self.of.address}",
            f"went away ({type(error).__name__}).",
            "Start its scheduler and workers again.",
        )

    def close(self) -> None:
        """Keep what has come meanwhile, and let the workers leave the rest."""
        if not self.under_way or self.client.status != "running":
            return
        for future, (number, chunk) in list(self.under_way.items()):
            if future.status == "finished" and self.keep is not None:
                self.keep(chunk, future.result(timeout=self.of.patience))
                del self.under_way[future]
                self.ready[number] = None
        self.client.cancel(list(self.under_way))
        self.under_way.clear()


_END = object()
