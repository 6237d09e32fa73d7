"""Figures of contact and of conveying."""
