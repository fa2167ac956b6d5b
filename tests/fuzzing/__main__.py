"""Run a campaign, or one mutant again."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.fuzzing.campaign import campaign
from tests.fuzzing.judge import commands, faults
from tests.fuzzing.mutations import mutant, seeds


def program() -> int:
    """The number of faults, at most 100, is the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description=__doc__)
    parser.add_argument("--mutants", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--workers", type=int, help="processes; one a processor by default")
    parser.add_argument("--only", type=int, help="run this mutant alone and print its file")
    asked = parser.parse_args()
    if asked.only is None:
        done = campaign(range(asked.first, asked.first + asked.mutants), asked.workers)
        found = done.faults
        counts = f"{done.mutants} mutants, {done.runs} runs, {done.refused} refused"
        print(f"{counts}, {len(found)} faults")  # noqa: T201
        return min(len(found), 100)
    with tempfile.TemporaryDirectory() as name:
        one = mutant(asked.only, seeds())
        print(f"# from {one.seed}: {', '.join(one.steps)}\n{one.text}")  # noqa: T201
        model = Path(name) / "mutant.toml"
        model.write_text(one.text, encoding="utf-8", errors="surrogatepass")
        found = tuple(
            f
            for c in commands(asked.only, model, Path(name) / "out")
            for f in faults(asked.only, c)
        )
    print(*found, sep="\n")  # noqa: T201
    return min(len(found), 100)


if __name__ == "__main__":
    sys.exit(program())
