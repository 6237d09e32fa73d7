"""A model's equations as expressions: recorded from its functions, differentiated, expanded in series."""
