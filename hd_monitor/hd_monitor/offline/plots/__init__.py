"""One plot a file: each takes results and returns a matplotlib figure; nothing is computed here."""
