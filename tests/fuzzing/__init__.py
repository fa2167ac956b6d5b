"""Mutated model files through every command: a result or one message, nothing else.

`python -m tests.fuzzing --mutants 10000` runs a campaign, `--only N` one mutant again.
"""
