"""Flow of a model over a period of the base motion, with its exact derivatives."""
