"""Single runs of models that change between kinds of contact."""
