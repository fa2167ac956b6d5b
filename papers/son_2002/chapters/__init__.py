"""Chapters of the pages about the machines of the thesis."""
