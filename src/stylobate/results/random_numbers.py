"""Reproducible random numbers: the arguments called `rng`."""

import numpy as np

from stylobate.errors import LARGEST_SEED, require_whole

Rng = int | np.random.Generator
"""A seed, or a generator."""


def seed_of(rng: Rng) -> int:
    """Return `rng` if it is a seed; draw a seed from a generator.

    Raises
    ------
    ParameterError
        If `rng` is neither.
    """
    if isinstance(rng, np.random.Generator):
        return int(rng.integers(LARGEST_SEED.number))
    return require_whole("rng", rng, least=0, most=LARGEST_SEED)


def generator_of(rng: Rng) -> np.random.Generator:
    """Return `rng` if it is a generator, or a new generator with this seed.

    Raises
    ------
    ParameterError
        If `rng` is neither.
    """
    return rng if isinstance(rng, np.random.Generator) else np.random.default_rng(seed_of(rng))
