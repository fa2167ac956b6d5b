"""Chapters: each a function from results to typed content with its data files."""
