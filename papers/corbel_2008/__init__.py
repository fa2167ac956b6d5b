"""Corbel et al. 2008: what the document prints beside what its two machines give here."""
