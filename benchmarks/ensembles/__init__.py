"""Benchmarks of ensembles against other solvers: speed, error, cost and memory; run by `make bench`."""
