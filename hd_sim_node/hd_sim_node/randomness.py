"""Reproducible randomness: each disturbance draws from a stream of its own and leaves the others alone."""

import zlib

import numpy as np


def generator(seed: int, purpose: str) -> np.random.Generator:
    """Random numbers for one purpose; the same for the same seed, whatever else is simulated."""
    return np.random.default_rng([seed, zlib.crc32(purpose.encode())])
