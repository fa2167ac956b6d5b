"""Chapters that only this document has."""
