"""What is remembered of every reducer, and what changed since.

`entry` sums up an assessment, `diary` decides when one is worth keeping, `trend` looks for changes: the core, on frozen
values. `ledger` is the file, the only part with input and output.
"""
