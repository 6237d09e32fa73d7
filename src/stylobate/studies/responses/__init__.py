"""Steady responses, their stability and their bifurcations."""
