"""Driver of a kernel: fills the lanes with runs, handles events of single lanes, and removes runs at their end.

The functions take the buffer and a lane, and if necessary the table of the batch and the polynomials of the base
motion. They are ordinary functions. Equations, row indices (`R.TIME`) and options come from `bound`, which each kernel
binds to a model and a kind of base motion.
"""
