"""Spectra, RMS per speed and line pairs."""
