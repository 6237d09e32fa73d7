"""
How do I save a run, load it again and repeat it?
=================================================

A saved run carries its own description. Load it on another machine and repeat the run
from the file alone.
"""

import tempfile
from pathlib import Path

import stylobate as sb

column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)  # m, m, kg/m³
circle = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)  # m/s², rad/s
run = sb.simulate(
    sb.Slender(column, damping=0.1),
    circle,
    tilt=(0.03, 0.0),
    tilt_rate=(0.0, 0.066),
    duration=60.0,
)

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "run.nc"  # netCDF: xarray, MATLAB and R read it, too
    run.save(path)
    loaded = sb.load(path)

setup = sb.config.config_of(loaded.provenance).build()
repeated = sb.simulate(setup.model, setup.motion, **setup.options)
difference = abs(repeated.data["tilt"] - run.data["tilt"]).max().item()
print(f"largest difference of the tilt: {difference} rad")

sb.plot([loaded, repeated], labels=["loaded", "repeated"])

# %%
# The two curves coincide: the repeated run is the same to the last digit. See
# :doc:`/getting-started/first-steps` and :func:`stylobate.load`.
