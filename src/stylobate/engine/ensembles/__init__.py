"""Ensembles: from arguments of any shape to labelled results, in parts that run side by side."""
