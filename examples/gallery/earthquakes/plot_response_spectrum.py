"""
How do I plot a record and its response spectrum?
=================================================

Draw the components of an accelerogram with their elastic response spectra, and print
the intensity measures that an engineer asks for.
"""

import numpy as np

import stylobate as sb

record = sb.sample_record("el centro 1940 corrected").trimmed(20.0, 50.0)  # s
measures = sb.records.intensity_measures(record)
for name, unit in (("pga", "m/s²"), ("pgv", "m/s"), ("arias", "m/s")):
    x, y, z = abs(measures[name]).values
    print(f"{name}: x {x:.2f}, y {y:.2f}, z {z:.2f} {unit}")

periods = np.geomspace(0.05, 5.0, 60)  # s
spectra = sb.records.response_spectra(record, periods, damping=0.05)
sb.earthquakes.plot_records([record], {record.name: spectra})

# %%
# Left: the accelerations. Right: spectral accelerations at 5 % damping. To read your
# own file, use :func:`stylobate.read_record`; :doc:`/how-to/records` lists the formats.
