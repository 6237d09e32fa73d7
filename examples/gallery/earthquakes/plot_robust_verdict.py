"""
Does a small change of the record flip the outcome? Robustness
==============================================================

A single rocking run is barely repeatable. Repeat it under small changes of the record
and of the column, one at a time, before you report its outcome.
"""

import stylobate as sb

column = sb.Column.solid(radius=0.4, height=4.0, density=2700.0)  # m, m, kg/m³
pulses = {
    f"{omega:g} rad/s": sb.Pulse.one_sine(acceleration=1.0, angular_frequency=omega)
    for omega in (3.0, 4.0, 5.0, 6.0, 8.0)
}
found = sb.earthquakes.robustness(sb.Slender(column, damping=0.03), pulses, scale=2.75)
for name, stable in zip(pulses, found["repeatable"].values, strict=True):
    print(f"{name}: {'repeatable' if stable else 'open'}")
figure = sb.plot(found)

# %%
# Each column of the table is one sine of 2.75 m/s², each row one small change. If any
# change flips the outcome, report the outcome as open. Resampling and filters apply to
# records, not to these pulses. See :doc:`/how-to/scaled-records`.
