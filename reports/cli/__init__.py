"""The command line: one program, `strutwork`."""

from strutwork.reports.cli.app import main

__all__ = ["main"]
