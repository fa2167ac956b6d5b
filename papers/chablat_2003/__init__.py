"""Chablat, Wenger and Majou 2003: what the document prints beside what its machines give here."""
