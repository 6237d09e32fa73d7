"""
How do I export results to xarray, pandas or CSV?
=================================================

Every result is an ``xarray.Dataset`` with units, or holds one.
``sb.results.to_dataframe`` makes a table in pandas of it, with one row per run; from
pandas it is one step to a spreadsheet.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.1, angular_frequency=1.0)

found = sb.studies.overturning_map(
    model,
    circle,
    over={
        "angular_frequency": np.linspace(1.0, 6.0, 21),  # Ω/ω₀
        "acceleration": np.linspace(0.11, 0.3, 20),  # g
    },
    periods=30.0,
)

# A table with one row per run; names of outcomes in place of codes.
table = sb.results.to_dataframe(found).reset_index()
print(table[["angular_frequency", "acceleration", "outcome", "peak_tilt"]].head())
# table.to_csv("runs.csv") would write a file that a spreadsheet opens.

fallen = table["outcome"].eq("OVERTURNED").groupby(table["angular_frequency"]).mean()
figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
axes.plot(fallen.index, 100.0 * fallen, "o-")
axes.set(xlabel="Ω/ω₀", ylabel="runs that overturn [%]")

# %%
# The fraction of the amplitudes between 0.11 g and 0.3 g that overturn the column, at
# each frequency. See :doc:`/how-to/ensembles` for the variables and their units.
