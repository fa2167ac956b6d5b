"""The thesis of Son 2002: a planar machine, its forces of assembly, its modes, a hexapod."""
