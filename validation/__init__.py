"""Comparisons with other people's numbers: measurements, frozen references, other programs, rules of practice.

`python -m validation` computes all of them and writes the tables of the page "Verification and validation".
"""
