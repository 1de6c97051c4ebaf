"""The source paper's figures, tables and claims, recomputed."""
