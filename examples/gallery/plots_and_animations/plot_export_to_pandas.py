"""
How do I export results to xarray, pandas or CSV?
=================================================

Every result is an ``xarray.Dataset`` with units. From there it is one step to a table
in pandas, and from pandas to a spreadsheet.
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

# A table with one row a run; names of outcomes in place of codes.
table = found[["outcome", "peak_tilt"]].to_dataframe().reset_index()
table["outcome"] = [sb.Outcome(code).label for code in table["outcome"]]
print(table.head())
# table.to_csv("runs.csv") would write a file that a spreadsheet opens.

fallen = table["outcome"].eq("overturned").groupby(table["angular_frequency"]).mean()
figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
axes.plot(fallen.index, 100.0 * fallen, "o-")
axes.set(xlabel="Ω/ω₀", ylabel="runs that overturn [%]")

# %%
# The fraction of the amplitudes between 0.11 g and 0.3 g that overturn the column, at
# each frequency. See :doc:`/how-to/ensembles` for the variables and their units.
