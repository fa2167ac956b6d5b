"""Two machines asked the same questions, row by row, with the differences marked."""
