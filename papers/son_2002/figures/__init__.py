"""Drawings of the machines of the thesis."""
