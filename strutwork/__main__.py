"""`python -m strutwork`: the program."""

from strutwork.reports.cli import main

main()
