"""Answers of a report: each found once, by processes beside or in an earlier run."""

from __future__ import annotations

import multiprocessing
import os
import warnings
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from strutwork import cache_folder
from strutwork.errors import CacheWarning, ModelError, ModelWarning, NumericalError
from strutwork.machines.model_file import read_model
from strutwork.reports import answering as answering_module
from strutwork.reports import subject as subject_module
from strutwork.reports.answer_store import AnswerStore, make_room, model_key
from strutwork.reports.answering import SIZES, Gathered, Kept, answering, questions
from strutwork.reports.answers import Outcome, Source, answer
from strutwork.reports.beside import Beside, processors
from strutwork.reports.build import compose
from strutwork.reports.composed import Offered, chapters_of
from strutwork.reports.content import Chapter, Page
from strutwork.reports.page import render
from strutwork.reports.subject import Subject

EXAMPLE = Path(__file__).parents[2] / "examples" / "06_table_on_two_rails.toml"
PLANAR = EXAMPLE.parent / "machines" / "planar-3-rrr.toml"

asked: list[str] = []


@dataclass(frozen=True)
class Thing:
    """Something with answers."""

    source: Source | None = field(default=None, compare=False)

    @answer
    def number(self) -> int:
        """A number, with a warning."""
        asked.append("number")
        warnings.warn("rough", ModelWarning, stacklevel=2)
        return 42

    @answer
    def nothing(self) -> int:
        """An error."""
        asked.append("nothing")
        raise ModelError("thing", "has none.", "Ask another.")


@pytest.fixture(autouse=True)
def nothing_asked() -> None:
    asked.clear()


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same questions over fewer points."""
    monkeypatch.setattr(subject_module, "SIZED", {1: 9, 2: 7, 3: 5})
    monkeypatch.setattr(subject_module, "SINGULAR_STEPS", 5)
    monkeypatch.setattr(subject_module, "REVERSAL_STEPS", 5)


@pytest.fixture
def store(tmp_path: Path) -> AnswerStore:
    return AnswerStore(tmp_path / "answers", "ab" * 32)


def test_an_answer_and_an_error_are_found_once() -> None:
    thing = Thing()
    with pytest.warns(ModelWarning, match="rough"):
        assert thing.number == 42
    with warnings.catch_warnings():
        # it is said once
        warnings.simplefilter("error")
        assert thing.number == 42
    for _ in range(2):
        with pytest.raises(ModelError, match="has none"):
            _ = thing.nothing
    assert asked == ["number", "nothing"]
    assert isinstance(Thing.number, answer)


def test_a_later_run_reuses_answers_errors_and_warnings(
    store: AnswerStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering_module, "WORTH", 0.0)
    for _ in range(2):
        thing = Thing(Kept(store))
        with pytest.warns(ModelWarning, match="rough"):
            assert thing.number == 42
        with pytest.raises(ModelError, match="has none"):
            _ = thing.nothing
    assert asked == ["number", "nothing"]
    fresh = Thing(Kept(replace(store, fresh=True)))
    with pytest.warns(ModelWarning, match="rough"):
        assert fresh.number == 42
    assert asked[2:] == ["number"]


@pytest.mark.parametrize("how", ["cut", "other", "foreign", "writable", "large"])
def test_what_is_damaged_or_not_ours_is_not_read(
    store: AnswerStore, how: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert store.write("number", Outcome(42))
    assert store.read("number") == Outcome(42)
    path = store.path("number")
    if how == "cut":
        path.write_bytes(path.read_bytes()[:-1])
        monkeypatch.setattr(cache_folder, "_noted", set())
        with pytest.warns(CacheWarning, match="damaged"):
            assert store.read("number") is None
    elif how == "other":
        path.write_bytes(b"something else")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CacheWarning)
            assert store.read("number") is None
    elif how == "foreign":
        user = os.getuid()
        monkeypatch.setattr(os, "getuid", lambda: user + 1)
        assert store.read("number") is None
    elif how == "writable":
        store.folder.chmod(0o770)
        assert store.read("number") is None
        monkeypatch.setattr(cache_folder, "_noted", set())
        with pytest.warns(CacheWarning, match="accessible to other users"):
            assert not store.write("number", Outcome(42))
    else:
        monkeypatch.setattr("strutwork.reports.answer_store.LARGEST", 3)
        assert store.read("number") is None
        assert not store.write("other", Outcome("long"))


def test_what_cannot_be_kept_is_no_fault(store: AnswerStore, tmp_path: Path) -> None:
    assert not store.write("function", Outcome(lambda: None))
    # memory may suffice the next time
    assert not store.write("memory", Outcome(error=MemoryError()))
    (tmp_path / "file").write_text("", encoding="utf-8")
    with warnings.catch_warnings(record=True):
        assert not replace(store, folder=tmp_path / "file").write("number", Outcome(42))


def test_answers_are_kept_where_groups_may_write(store: AnswerStore) -> None:
    before = os.umask(0o002)
    try:
        assert store.write("number", Outcome(42))
    finally:
        os.umask(before)
    assert store.read("number") == Outcome(42)


def test_answers_asked_for_longest_ago_make_room(tmp_path: Path) -> None:
    for age, name in enumerate(("new", "middle", "old")):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "a.answer").write_bytes(b"x" * 1000)
        os.utime(folder, (1e9 - age, 1e9 - age))
    make_room(tmp_path, tmp_path / "old", 2500)
    # what was just written stays, however old
    assert {p.name for p in tmp_path.iterdir()} == {"new", "old"}


def test_the_key_changes_with_the_machine(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    file = tmp_path / "other.toml"
    file.write_text(text.replace("safety_factor = 5", "safety_factor = 6"), encoding="utf-8")
    keys = [model_key(read_model(path)) for path in (EXAMPLE, EXAMPLE, file)]
    assert keys[0] == keys[1] != keys[2]


def test_processes_answer_beside_and_one_that_dies_is_stood_in_for() -> None:
    parent = os.getpid()

    def dies() -> int:
        if os.getpid() != parent:
            os._exit(9)
        return 1

    def fails() -> int:
        raise ModelError("part", "is wrong.")

    groups = [{"first": os.getpid, "wrong": fails}, {"function": lambda: lambda: None}]
    groups += [{"last": dies}]
    beside = Beside(groups, 2)
    try:
        told: list[tuple[int, int]] = []
        gathered = Gathered(Kept(), beside, lambda done, of: told.append((done, of)))
        first = gathered.ask("first", os.getpid)
        assert told
        assert {of for _, of in told} == {4}
        assert first.value not in {None, parent}
        wrong = beside.get("wrong", lambda: None)
        assert wrong is not None
        with pytest.raises(ModelError, match="part: is wrong"):
            wrong.get()
        # to be found in place
        for name in ("function", "last", "never asked"):
            assert beside.get(name, lambda: None) is None
    finally:
        beside.end()


def test_what_is_told_goes_by_the_size_of_the_questions() -> None:
    # every name is that of a question: one that is renamed loses its size
    assert {name for name in SIZES if not hasattr(Subject, name)} == set()
    beside = Beside([{"workspace": lambda: 1}, {"vibration": lambda: 2}], 1)
    told: list[tuple[int, int]] = []
    try:
        gathered = Gathered(Kept(), beside, lambda done, of: told.append((done, of)))
        gathered.ask("vibration", lambda: 2)
    finally:
        beside.end()
    assert told[-1] == (21, 21)
    assert {done for done, _ in told} <= {0, 1, 21}


def test_processes_end_with_the_block() -> None:
    def endless() -> None:
        while True:
            pass

    beside = Beside([{"endless": endless}, {"quick": lambda: 1}], 2)
    assert beside.get("quick", lambda: None) == Outcome(1)
    processes = beside._processes
    beside.end()
    assert [p.is_alive() for p in processes] == [False, False]


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
def test_a_report_is_the_same_however_it_is_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering_module, "WORTH", 0.0)

    def pages(processes: int, folder: Path | None) -> list[str | bytes]:
        monkeypatch.setattr(answering_module, "processors", lambda: processes)
        monkeypatch.setattr(answering_module, "answers_folder", lambda: folder)
        composed = compose(str(PLANAR))
        made: list[str | bytes] = [
            render(Page(composed.page.title, "", composed.page.chapters, ""))
        ]
        for file in composed.files:
            if not file.name.endswith(".nc"):
                file.write(tmp_path / "file")
                made.append((tmp_path / "file").read_bytes())
        return made

    alone = pages(1, None)
    assert pages(2, tmp_path / "answers") == alone
    kept = sorted(p.name for p in (tmp_path / "answers").glob("*/*"))
    names = [name for group in questions(_subject()) for name in group]
    # each of them can be passed on, then
    assert {Path(name).stem for name in kept} == {*names, "solution", "check"}
    # nothing is left to find: no process begins
    monkeypatch.setattr(answering_module, "Beside", None)
    assert pages(2, tmp_path / "answers") == alone


def test_without_processors_beside_answers_are_found_where_they_are_asked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(answering_module, "processors", lambda: 1)
    monkeypatch.setattr(answering_module, "answers_folder", lambda: None)
    with answering(_subject()) as subject:
        assert isinstance(subject.source, Kept)
        assert subject.check.mobility.mobility >= 0


def _subject() -> Subject:
    return Subject(read_model(PLANAR), "m", "m")


def test_a_chapter_that_fails_says_which() -> None:
    def fails(_: Subject) -> Chapter:
        raise NumericalError("matrix", "is singular.", "Look at the joints.")

    offered = [Offered("one", "How stiff is it?", lambda _: "", fails)]
    with pytest.raises(NumericalError) as caught:
        chapters_of(_subject(), offered)
    assert str(caught.value) == (
        'chapter "How stiff is it?", matrix: is singular.\nLook at the joints.'
    )


@pytest.mark.skipif(
    "fork" not in multiprocessing.get_all_start_methods(), reason="nothing is done beside"
)
def test_a_worker_of_a_pool_answers_alone() -> None:
    # a daemonic process may have no children: multiprocessing refuses them with an assertion
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply(processors) == 1
