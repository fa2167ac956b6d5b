"""The command line: one program, `strutwork`."""

from reports.cli.app import main

__all__ = ["main"]
