"""What is remembered of every reducer, and what changed since.

`entry` sums up an assessment, `diary` decides when one is worth keeping, `series` puts a reducer's entries in rows, one
a reading, and `trend` looks for changes in them: the core, on frozen values. `ledger` is the file, the only part with
input and output.
"""
