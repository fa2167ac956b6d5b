"""The test suite of Strutwork."""
