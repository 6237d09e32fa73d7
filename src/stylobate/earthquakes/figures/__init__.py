"""Figures and reports of what earthquakes do to columns."""
