"""Meshes: generated, imported and exported; surfaces and their mass properties."""
