"""Identification from a vibration sensor: a frozen state, and its update by each new segment."""
