"""Measurements as messages: serialised, lost or late in transit, paced by a clock."""
