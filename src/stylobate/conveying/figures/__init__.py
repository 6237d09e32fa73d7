"""Figures of contact maps, slip limits and conveying."""
