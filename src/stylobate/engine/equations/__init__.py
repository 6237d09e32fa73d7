"""Symbolic expressions of the equations of a model: recording, differentiation, and series expansion."""
