"""Bags through the core, and reports."""
