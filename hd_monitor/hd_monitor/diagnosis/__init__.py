"""From indexes to a verdict with reasons."""
