"""Comparison of models of one column."""
