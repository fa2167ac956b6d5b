"""Reports: figures, tables, the self-contained HTML page, and the command line."""
