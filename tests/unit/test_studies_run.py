"""Chunks, executors and progress: interrupted work goes on, damaged files are made again."""

from __future__ import annotations

import io
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from rich.progress import Progress as Bars

from strutwork.errors import ModelError
from strutwork.reports.cli.progress import LeftColumn
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.executor import Threads, default_executor
from strutwork.studies.progress import INTERVAL, LONGER, PATIENCE, Lines, Remaining, share
from strutwork.studies.run import Chunk, Run, fill

KEY = "0123456789abcdef" * 4


class InterruptError(BaseException):
    """Stands for the user's Ctrl-C in the middle of a study."""


class Work:
    """Squares of a range; counts its calls, and stops at a given chunk."""

    def __init__(self, stop_at: int | None = None) -> None:
        self.done: list[int] = []
        self.stop_at = stop_at

    def __call__(self, chunk: Chunk) -> Arrays:
        if chunk.number == self.stop_at:
            raise InterruptError
        self.done.append(chunk.number)
        return {"square": np.arange(chunk.start, chunk.stop) ** 2}


def squares(
    work: Work, folder: Path | None, key: str = KEY
) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    whole: Arrays = {}
    for chunk, part in Run(workers=1, folder=folder).chunks(work, 10, 3, lambda: key):
        fill(whole, chunk, part, 10)
    return whole["square"]


def chunk_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("chunk-*.npz"))


def test_chunks_cover_every_item_once() -> None:
    work = Work()
    assert squares(work, None).tolist() == [i**2 for i in range(10)]
    assert work.done == [0, 1, 2, 3]


def test_interrupted_work_goes_on_where_it_stopped(tmp_path: Path) -> None:
    first = Work(stop_at=2)
    with pytest.raises(InterruptError):
        squares(first, tmp_path)
    # the executor may have begun a later chunk before the interrupt was seen
    assert first.done[:2] == [0, 1]
    second = Work()
    assert squares(second, tmp_path).tolist() == [i**2 for i in range(10)]
    assert sorted(first.done + second.done) == [0, 1, 2, 3]
    third = Work()
    assert squares(third, tmp_path).tolist() == [i**2 for i in range(10)]
    assert third.done == []


def flip_a_byte(path: Path) -> None:
    content = bytearray(path.read_bytes())
    at = content.index((np.arange(3, 6) ** 2).tobytes())
    content[at] ^= 0xFF
    path.write_bytes(bytes(content))


def cut_off(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:100])


def empty(path: Path) -> None:
    path.write_bytes(b"")


def other_content(path: Path) -> None:
    path.write_text("no archive at all", encoding="utf-8")


@pytest.mark.parametrize("damage", [flip_a_byte, cut_off, empty, other_content])
def test_a_damaged_chunk_is_computed_again(tmp_path: Path, damage: Callable[[Path], None]) -> None:
    expected = squares(Work(), tmp_path)
    damage(chunk_files(tmp_path)[1])
    work = Work()
    assert squares(work, tmp_path).tolist() == expected.tolist()
    assert work.done == [1]


def test_other_inputs_have_other_chunks(tmp_path: Path) -> None:
    squares(Work(), tmp_path)
    other = Work()
    squares(other, tmp_path, key=KEY[::-1])
    assert other.done == [0, 1, 2, 3]


def test_a_chunk_of_another_study_is_not_taken(tmp_path: Path) -> None:
    ours = ChunkStore(tmp_path, KEY)
    # the same folder, for the first sixteen characters agree
    theirs = ChunkStore(tmp_path, KEY[:16] + "f" * 48)
    theirs.write(0, {"square": np.arange(3)})
    assert theirs.read(0) is not None
    assert ours.read(0) is None


def test_no_half_written_chunk_is_left(tmp_path: Path) -> None:
    store = ChunkStore(tmp_path, KEY)
    with pytest.raises(TypeError, match="bad holds Python objects"):
        store.write(0, {"bad": np.array([object()])})
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == []
    assert store.read(0) is None


def test_results_keep_the_order_of_the_chunks() -> None:
    second_done = threading.Event()

    def slow_first(number: int) -> int:
        if number == 0:
            assert second_done.wait(timeout=60)
        if number == 1:
            second_done.set()
        return number

    assert list(Threads(2).map(slow_first, range(5))) == [0, 1, 2, 3, 4]


def test_chunks_are_not_begun_without_bound() -> None:
    asked: list[int] = []

    def numbers() -> Iterator[int]:
        for i in range(1000):
            asked.append(i)
            yield i

    results = Threads(1).map(abs, numbers())
    assert next(results) == 0
    assert len(asked) == 2


def test_an_error_of_a_chunk_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        list(Threads(2).map(lambda x: 1 // x, [2, 1, 0]))


def test_an_executor_needs_a_worker() -> None:
    with pytest.raises(ModelError, match="0 workers"):
        default_executor(0)


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def test_short_work_says_nothing() -> None:
    stream, clock = io.StringIO(), Clock()
    lines = Lines("map", stream=stream, clock=clock)
    for done in range(11):
        clock.now = 0.1 * done
        lines(done, 10)
    assert stream.getvalue() == ""


def test_long_work_speaks_seldom() -> None:
    stream, clock = io.StringIO(), Clock()
    lines = Lines("map", stream=stream, clock=clock)
    seconds = 40
    for done in range(seconds + 1):
        clock.now = float(done)
        lines(done, seconds)
    # at PATIENCE, then every INTERVAL, and the end
    due = [int(PATIENCE), int(PATIENCE + INTERVAL), int(PATIENCE + 2 * INTERVAL)]
    expected = [f"map: {d} of 40 poses, 1 per s, about {40 - d} s left" for d in due]
    assert stream.getvalue().splitlines() == [*expected, "map: 40 of 40 poses, done in 40 s"]


def test_one_long_part_promises_nothing() -> None:
    # two answers within 4 s, the third takes minutes: the estimate grew with every line
    stream, clock = io.StringIO(), Clock()
    lines = Lines("report", "steps", stream=stream, clock=clock)
    for second in range(0, 100, 2):
        clock.now = float(second)
        lines(min(second // 2, 2), 3)
    said = stream.getvalue().splitlines()
    assert said[0] == "report: 1 of 3 steps, 0.5 per s, about 4 s left"
    assert len(said) > 4
    assert set(said[1:]) == {f"report: 2 of 3 steps, 0.5 per s, {LONGER}"}


def test_time_left_counts_down_between_two_units() -> None:
    left = Remaining()
    assert left(0.0, 0, 4) is None
    assert left(9.0, 0, 4) is None
    assert left(10.0, 1, 4) == 30.0
    assert left(25.0, 1, 4) == 15.0
    assert left(60.0, 1, 4) == 0.0
    assert left(60.0, 2, 4) == 60.0


def test_a_bar_promises_no_more_than_a_line() -> None:
    bars = Bars(console=Console(file=io.StringIO()))
    bars.add_task("report", total=3)
    (task,) = bars.tasks
    column = LeftColumn()
    assert column.render(task).plain == ""
    task.fields["end"] = time.monotonic() + 100.4
    assert column.render(task).plain in {"100 s left", "99 s left"}
    task.fields["end"] = time.monotonic() - 1.0
    assert column.render(task).plain == LONGER


def test_parts_report_to_the_whole() -> None:
    told: list[tuple[int, int]] = []
    for number in range(2):
        tell = share(lambda done, total: told.append((done, total)), number, 2)
        tell(0, 5)
        tell(5, 5)
    assert told == [(0, 10), (5, 10), (5, 10), (10, 10)]
