"""Studies on a cluster of processes: the same results, workers and schedulers killed for real."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ClusterError, StudyError, StudyWarning
from strutwork.kinematics import following
from strutwork.machines.load import load
from strutwork.studies import cluster_work
from strutwork.studies import study as study_module
from strutwork.studies.chunks import Arrays
from strutwork.studies.cluster import Dask
from strutwork.studies.cluster_client import check_versions, forget
from strutwork.studies.cluster_work import Identity, compute, identity, pickled
from strutwork.studies.design import Design
from strutwork.studies.design_store import run_design
from strutwork.studies.executor import Threads, computed_on
from strutwork.studies.parameter import Parameter
from strutwork.studies.run import Chunk, Run
from strutwork.studies.study import Study
from strutwork.studies.trajectory import Samples, study_trajectory
from tests.cluster_processes import STARTS, Cluster, cluster

pytest.importorskip("distributed")

KEY = "0123456789abcdef" * 4
ITEMS, SIZE = 60, 3
CHUNKS = ITEMS // SIZE


class Work:
    """Squares, slowly, with a line of who computed which chunk."""

    def __init__(self, log: Path, seconds: float = 0.1) -> None:
        self.log, self.seconds = log, seconds

    def __call__(self, chunk: Chunk) -> Arrays:
        self.begin(chunk)
        time.sleep(self.seconds)
        return {"square": np.arange(chunk.start, chunk.stop) ** 2.0}

    def begin(self, chunk: Chunk) -> None:
        with self.log.open("a", encoding="utf-8") as file:
            file.write(f"{chunk.number} {os.getpid()}\n")

    @property
    def begun(self) -> list[tuple[int, int]]:
        """Chunk and process of every line."""
        if not self.log.exists():
            return []
        lines = self.log.read_text(encoding="utf-8").splitlines()
        return [(int(a), int(b)) for a, b in (line.split() for line in lines)]


class Deadly(Work):
    """Ends any process that takes chunk 4, and fails at chunk 7."""

    def begin(self, chunk: Chunk) -> None:
        super().begin(chunk)
        if chunk.number == 4:
            os.kill(os.getpid(), signal.SIGKILL)
        if chunk.number == 7:
            raise ValueError("seven")


def squares(run: Run, work: Work) -> list[float]:
    found = run.chunks(work, ITEMS, SIZE, lambda: KEY)
    return np.concatenate([part["square"] for _, part in found]).tolist()


EXPECTED = [float(i) ** 2 for i in range(ITEMS)]


@pytest.fixture
def two(tmp_path: Path) -> Iterator[Cluster]:
    with cluster(tmp_path, 2) as made:
        yield made
        forget(made.address)


def dask(made: Cluster, patience: float = STARTS) -> Dask:
    return Dask(made.address, patience)


def wait_until(begun: int, work: Work) -> None:
    end = time.monotonic() + STARTS
    while len(work.begun) < begun:
        assert time.monotonic() < end, "the study does not begin"
        time.sleep(0.02)


def later(action: threading.Thread) -> threading.Thread:
    action.start()
    return action


@pytest.mark.slow
def test_a_killed_worker_loses_what_it_had_in_hand(two: Cluster, tmp_path: Path) -> None:
    work = Work(tmp_path / "log")

    def kill() -> None:
        wait_until(6, work)
        two.workers[0].send_signal(signal.SIGKILL)

    killer = later(threading.Thread(target=kill))
    assert squares(Run(executor=dask(two), folder=tmp_path / "kept"), work) == EXPECTED
    killer.join()
    assert two.workers[0].wait() == -signal.SIGKILL
    # the one in hand, and one that was done and not yet sent
    assert len(work.begun) <= CHUNKS + 2
    assert {number for number, _ in work.begun} == set(range(CHUNKS))


@pytest.mark.slow
def test_a_killed_scheduler_ends_the_study_which_goes_on(two: Cluster, tmp_path: Path) -> None:
    work, folder = Work(tmp_path / "log", 0.2), tmp_path / "kept"

    def kill() -> None:
        wait_until(8, work)
        two.scheduler.send_signal(signal.SIGKILL)

    killer = later(threading.Thread(target=kill))
    with pytest.raises(ClusterError, match="went away") as caught:
        squares(Run(executor=dask(two, 20.0), folder=folder), work)
    killer.join()
    kept = len(list(folder.rglob("chunk-*.npz")))
    assert f"{kept} of {CHUNKS} chunks are kept in {folder}" in caught.value.remedy
    begun = len(work.begun)
    assert begun - kept <= 4  # in hand at two workers, and done there but not yet sent
    assert squares(Run(workers=1, folder=folder), work) == EXPECTED
    assert len(work.begun) - begun == CHUNKS - kept


@pytest.mark.slow
def test_chunks_that_fail_are_named_while_the_rest_goes_on(tmp_path: Path) -> None:
    work, folder = Deadly(tmp_path / "log", 0.0), tmp_path / "kept"
    with cluster(tmp_path, 3, deaths=1) as made:
        with pytest.warns(StudyWarning, match="rest goes on"), pytest.raises(StudyError) as caught:
            squares(Run(executor=dask(made), folder=folder), work)
        forget(made.address)
    # a worker was killed, the chunk given to another one, and then given up
    assert [number for number, _ in work.begun].count(4) == 2
    said = str(caught.value)
    assert "poses 12 to 14: worker: ended 2 times" in said
    assert "poses 21 to 23: ValueError: seven" in said
    # Dask counts a worker's death against all that waited there: a chunk may go down with its like
    lost = said.count("poses ")
    assert 2 <= lost <= 4
    assert f"{CHUNKS - lost} of {CHUNKS} chunks are kept in {folder}" in said
    good = Work(tmp_path / "again")
    assert squares(Run(workers=1, folder=folder), good) == EXPECTED
    again = sorted(number for number, _ in good.begun)
    assert len(again) == lost
    assert {4, 7} <= set(again)


@pytest.mark.slow
def test_a_cluster_without_workers_is_said(tmp_path: Path) -> None:
    with cluster(tmp_path, 0) as made:
        with pytest.raises(ClusterError, match="has had no worker for 2 s") as caught:
            squares(Run(executor=dask(made, 2.0)), Work(tmp_path / "log"))
        assert f"dask worker {made.address}" in caught.value.remedy


def test_a_cluster_that_does_not_answer_is_said(tmp_path: Path) -> None:
    work = Work(tmp_path / "log")
    with pytest.raises(ClusterError, match="no scheduler answers within 1 s") as caught:
        squares(Run(executor=Dask("tcp://127.0.0.1:1", 1.0)), work)
    assert "dask scheduler" in caught.value.remedy
    assert work.begun == []


def test_an_address_that_is_none_is_said(tmp_path: Path) -> None:
    with pytest.raises(ClusterError, match="cannot be reached"):
        squares(Run(executor=Dask("carrier-pigeon://coop", 1.0)), Work(tmp_path / "log"))


class Reported:
    """A client whose workers report what they compute with."""

    def __init__(self, there: object) -> None:
        self.there = there

    def run(self, *_: object, **__: object) -> dict[str, object]:
        return {"tcp://worker:1": self.there}


def test_workers_of_another_version_are_refused() -> None:
    other = Identity("strutwork 0.0.1 (abc) on Python 3.11", identity().libraries)
    with pytest.raises(ClusterError, match=r"worker tcp://worker:1: has another .*0\.0\.1"):
        check_versions(Reported(other))
    with pytest.raises(ClusterError, match="cannot load Strutwork"):
        check_versions(Reported(ModuleNotFoundError("No module named 'strutwork'")))
    check_versions(Reported(identity()))


def test_workers_with_other_libraries_are_named() -> None:
    libraries = {**identity().libraries, "numpy": "1.0"}
    with pytest.warns(StudyWarning, match=r"has numpy 1\.0 in place of .*last digits"):
        check_versions(Reported(Identity(identity().code, libraries)))


def test_a_worker_that_came_later_is_held_to_the_version() -> None:
    payload = pickled(abs)
    assert compute("a", payload, -3, identity().code) == 3
    with pytest.raises(ClusterError, match="has another Strutwork"):
        compute("a", payload, -3, "another")


def test_a_function_that_cannot_be_sent_is_said() -> None:
    lock = threading.Lock()
    with pytest.raises(ClusterError, match="cannot be sent to workers"):
        pickled(lambda chunk: (lock, chunk))


def test_a_function_is_read_once_per_process(monkeypatch: pytest.MonkeyPatch) -> None:
    cloudpickle = pytest.importorskip("cloudpickle")
    read: list[int] = []
    loads = cloudpickle.loads
    monkeypatch.setattr(cloudpickle, "loads", lambda b: read.append(1) or loads(b))
    cluster_work._loaded.cache_clear()
    for number in range(3):
        assert compute("b", pickled(abs), -number, identity().code) == number
    assert len(read) == 1


def test_without_a_folder_the_first_failure_ends_the_study() -> None:
    def fails(_: Chunk) -> Arrays:
        raise LookupError

    with pytest.raises(StudyError, match="poses 0 to 2: LookupError") as caught:
        list(Run(workers=1).chunks(fails, ITEMS, SIZE, lambda: KEY))
    assert "Give a folder" in caught.value.remedy


def test_where_everything_fails_the_rest_is_not_begun(tmp_path: Path) -> None:
    begun: list[int] = []

    def fails(chunk: Chunk) -> Arrays:
        begun.append(chunk.number)
        raise ZeroDivisionError

    with pytest.warns(StudyWarning), pytest.raises(StudyError, match="8 of 20 chunks"):
        list(Run(workers=1, folder=tmp_path).chunks(fails, ITEMS, SIZE, lambda: KEY))
    assert len(begun) <= 10
    (report,) = tmp_path.rglob("failures.txt")
    assert report.read_text(encoding="utf-8").count("ZeroDivisionError\nTraceback") == 8


def test_ctrl_c_says_what_is_kept(tmp_path: Path) -> None:
    def interrupted(chunk: Chunk) -> Arrays:
        if chunk.number == 5:
            raise KeyboardInterrupt
        return {"square": np.arange(chunk.start, chunk.stop) ** 2.0}

    found = Run(executor=Threads(1), folder=tmp_path).chunks(interrupted, ITEMS, SIZE, lambda: KEY)
    said = rf"interrupted: \d+ of {CHUNKS} chunks are kept"
    with pytest.warns(StudyWarning, match=said), pytest.raises(KeyboardInterrupt):
        list(found)
    assert squares(Run(workers=1, folder=tmp_path), Work(tmp_path / "log", 0.0)) == EXPECTED


@pytest.mark.slow
def test_study_trajectory_and_design_are_the_same_on_a_local_cluster(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("pymoo")
    monkeypatch.setattr(study_module, "CHUNK_MOST", 4)
    monkeypatch.setattr(following, "PIECE", 16)
    hexapod = "examples/machines/6-ups.toml"
    varied = Parameter("joints.ball*.stiffness.*", distribution="normal", scatter="10 %")
    answers = ("stiffness", "frequency", "mass")
    study = Study.of(hexapod, [varied], *answers, count=8, workspace={"x": [-0.1, 0.1]})
    model, times = load(hexapod), np.linspace(0.0, 1.0, 12)
    samples = Samples(times, {("", "x"): 0.02 * np.sin(3 * times)})
    design = Design.of(
        hexapod,
        {"sections.ram.diameter": ("45 mm", "60 mm"), "joints.ball*.stiffness.*": (3e8, 5e8)},
        *("stiffness_z", "first_frequency", "mass"),
        workspace={"x": [-0.1, 0.1]},
        population=72,
        generations=2,
    )

    def every() -> tuple[xr.Dataset, bytes, xr.Dataset]:
        forces = study_trajectory(model, samples, reactions=True).followed.forces
        return study.run(), forces.tobytes(), run_design(design)

    here, cluster_of_two = every(), Dask(workers=2)
    try:
        with computed_on(cluster_of_two):
            there = every()
    finally:
        cluster_of_two.close()
    assert there[0].identical(here[0])
    assert there[1] == here[1]
    for name, values in here[2].data_vars.items():
        assert there[2][name].to_numpy().tobytes() == values.to_numpy().tobytes(), name
