"""
How much do the models of a column differ?
==========================================

One column, one base motion, every model of the hierarchy. Two assumptions separate the
models: small angles, and a column that cannot turn about its own axis.
"""

import stylobate as sb

column = sb.Column.dimensionless(slenderness=0.2)  # a stout column
circle = sb.Harmonic.circular(acceleration=0.13, angular_frequency=1.8)  # g, ω₀
found = sb.studies.model_hierarchy(
    column,
    circle,
    damping=0.1,
    spin_damping=0.1,
    tilt=(0.08, 0.0),  # rad
    tilt_rate=(0.0, 0.14),  # rad × ω₀
    duration=40.0,  # in units of 1/ω₀
    slenderness=[0.05, 0.1, 0.2],  # the same case for more slender columns
    samples=1000,
)
table = found["mean_late_tilt"] / found["slenderness"]
print(table.to_pandas().round(3).to_string())

sb.plot(found)

# %%
# Above: tilt and spin of each model. The models that may spin tilt half as far as the
# others. Below: the slender models approach the models of finite tilt as the square of
# the slenderness; the free spin stays important for every slenderness.
# :doc:`/explanation/model-hierarchy` explains which model to choose.
