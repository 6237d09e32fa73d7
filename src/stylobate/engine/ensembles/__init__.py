"""Ensembles: from arguments of any shape to labelled results, computed in parts in parallel."""
