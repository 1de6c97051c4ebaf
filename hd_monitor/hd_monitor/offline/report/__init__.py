"""The report of a replay: analyses that only it needs, the page and its pictures."""
