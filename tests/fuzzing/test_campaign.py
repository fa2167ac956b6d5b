"""Mutants of model files: a sample in the quick run, ten thousand in the slow one."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from tests.fuzzing import judge
from tests.fuzzing.campaign import campaign
from tests.fuzzing.mutations import mutant, seeds


@pytest.mark.parametrize("number", range(60))
def test_sample(number: int, tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("mutant")
    model = folder / "mutant.toml"
    model.write_text(mutant(number, seeds()).text, encoding="utf-8", errors="surrogatepass")
    # pages and maps are left to the slow run
    runs = [c for c in judge.commands(number, model, folder / "out") if c[0] in judge.QUICK]
    assert len(runs) == len(judge.QUICK)
    assert [fault for command in runs for fault in judge.faults(number, command)] == []


@pytest.mark.slow
def test_ten_thousand() -> None:
    done = campaign(range(10_000))
    assert done.faults == ()
    assert done.mutants == 10_000
    assert done.runs > 50_000
    # most mutants must reach a solver: refused ones alone would show little
    assert 0.1 < done.refused / done.runs < 0.9
    assert [str(fault) for fault in done.faults] == []


@pytest.mark.slow
@pytest.mark.parametrize("number", [1750])
def test_faults_of_before(number: int, tmp_path: Path) -> None:
    """1750: a hexapod whose legs have come off their parts, so that no drive moves."""
    model = tmp_path / "mutant.toml"
    model.write_text(mutant(number, seeds()).text, encoding="utf-8", errors="surrogatepass")
    runs = judge.commands(number, model, tmp_path / "out")
    assert [fault for command in runs for fault in judge.faults(number, command)] == []


def test_a_number_is_one_mutant() -> None:
    texts = seeds()
    changed = [mutant(n, texts) for n in range(60)]
    assert changed == [mutant(n, texts) for n in range(60)]
    assert len({m.text for m in changed}) > 50
    assert len({m.seed for m in changed}) > 10


def test_some_mutants_are_sound_and_some_are_no_toml() -> None:
    texts = seeds()
    broken = 0
    for number in range(60):
        try:
            tomllib.loads(mutant(number, texts).text)
        except tomllib.TOMLDecodeError:
            broken += 1
    assert 0 < broken < 30


@pytest.mark.parametrize(
    ("status", "out", "err", "as_json", "what"),
    [
        (0, "K 3.1 N/um, nan Hz\n", "", False, "prints nan"),
        (0, "K inf N/um\n", "", False, "prints inf"),
        (0, '{"k": NaN}\n', "", True, "JSON holds NaN"),
        (0, '{"k": -Infinity}\n', "", True, "JSON holds -Infinity"),
        (0, '{"k": 1', "", True, "no JSON"),
        (0, "", "Traceback (most recent call last)\n", False, "a traceback"),
        (1, "", "Error: it went wrong\n", False, "names no remedy"),
        (1, "K 3", "Error: a: b\nDo c.\n", False, "a result with status 1"),
        (4, "", "Error: a: b\nDo c.\n", False, "exit status 4"),
        (-11, "", "", False, "exit status -11"),
    ],
)
def test_the_judge_sees(status: int, out: str, err: str, as_json: bool, what: str) -> None:
    (found,) = judge.judged(status, out, err, as_json=as_json)
    assert what in found


@pytest.mark.parametrize(
    ("status", "out", "err", "as_json"),
    [
        (0, "node nano: information of 3 N/um, infinite in rz\n", "", False),
        (0, '{"k": null}\n', "Warning: x\n", True),
        (1, "", "Error: a: b\nDo c.\n", False),
        (2, "", "╭─ Error ─╮\n│ Invalid value │\n", False),
    ],
)
def test_the_judge_lets_pass(status: int, out: str, err: str, as_json: bool) -> None:
    assert judge.judged(status, out, err, as_json=as_json) == []


def test_a_raise_is_a_fault_with_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> None:
        raise KeyError("leg")

    monkeypatch.setattr(judge.program, "main", broken)
    (fault,) = judge.faults(7, ("check", "m.toml"))
    assert "mutant 7, check m.toml: KeyError: 'leg' (test_campaign.py:" in str(fault)


def test_a_campaign_counts_and_spreads() -> None:
    done = campaign(range(1, 5), workers=2)
    assert (done.mutants, done.faults) == (4, ())
    # the third is moved too
    assert done.runs == 4 * len(judge.QUICK) + 1
