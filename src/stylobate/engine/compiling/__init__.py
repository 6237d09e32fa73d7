"""Compiled modules: written for a model, compiled once in a process of their own, kept on disk."""
