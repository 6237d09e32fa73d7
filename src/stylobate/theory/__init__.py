"""Closed forms of the slender column: what theory says before anything is integrated."""
