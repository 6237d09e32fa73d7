"""The driver of a kernel: fills lanes with runs, meets the events of single lanes, takes the runs out at their end.

The modules here are a pattern. A kernel is a copy of the parts below their marks, in the order of ORDER, behind a head
that defines for one model and one kind of base motion what they import from `head`, with names of rows (`R.TIME`)
replaced by their numbers. Functions take the buffer and a lane, and where they need them the table of the batch and the
polynomials of the base motion.
"""

ORDER = (
    "base_motion",
    "moving",
    "within",
    "tracing",
    "stops",
    "release",
    "release_search",
    "standing",
    "resting",
    "lift_off",
    "peaks",
    "passages",
    "events",
    "starting",
    "batch",
)

SWITCHING_ORDER = (
    "base_motion",
    "moving",
    "within",
    "tracing",
    "stops",
    "release",
    "release_search",
    "standing",
    "peaks",
    "contact_ends",
    "contact_changes",
    "contact_stiffness",
    "contact_steps",
    "implicit_step",
    "contact_implicit",
    "contact_events",
    "batch",
)
"""The same for models that change between kinds of contact."""
