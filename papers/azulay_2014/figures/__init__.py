"""Drawings of the machines of the paper."""
