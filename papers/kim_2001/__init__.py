"""Kim et al. 2001: what the document prints beside what its machine gives here."""
