#!/usr/bin/env bash
# The response spectrum of a record without trailing zeros differs between pyrotd and eqsig.
#
# Packages: pyrotd 0.6.1, eqsig 1.2.17
# Expected: pyrotd pads the record with zeros before its Fourier transform, so the oscillator
#   starts at rest. Its spectrum agrees with the time-stepping of eqsig within a few percent.
# Seen: pyrotd does not pad, so it returns the response to the record repeated without end. For one
#   sine cycle of 1 s, Sa(1 s) is 10.0 (the resonance 1/2ζ) instead of 2.70. At periods longer than
#   the record, Sa is too small. eqsig stops at the last sample and misses later peaks: Sa(2 s) is
#   0.81 instead of 1.14. With 400 s of zeros appended, the two agree within 1 %.
# Output (spectral acceleration divided by the peak of the record):
#   T            1.0 s   2.0 s   4.0 s   8.0 s
#   pyrotd      10.000   0.333   0.067   0.016
#   eqsig        2.697   0.809   0.302   0.089
#   pyrotd +0    2.699   1.145   0.324   0.089
#   eqsig +0     2.698   1.145   0.324   0.089
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyrotd==0.6.1 eqsig==1.2.17 \
    numpy==2.4.6 scipy==1.17.1 "setuptools==80.9.0"
venv/bin/python -W ignore - <<'PYTHON'
import eqsig
import numpy as np
import pyrotd

pyrotd.processes = 1
step, damping = 0.01, 0.05
periods = np.array([1.0, 2.0, 4.0, 8.0])
sine = np.sin(2 * np.pi * np.arange(0, 1, step))
padded = np.concatenate([sine, np.zeros(40000)])


def both(record):
    fourier = pyrotd.calc_spec_accels(step, record, 1 / periods, damping).spec_accel
    stepped = eqsig.sdof.pseudo_response_spectra(record, step, periods, damping)[2]
    return fourier, stepped


rows = dict(zip(("pyrotd", "eqsig", "pyrotd +0", "eqsig +0"), both(sine) + both(padded)))
print("T          " + "".join(f"{period:6.1f} s" for period in periods))
for name, row in rows.items():
    print(f"{name:10}" + "".join(f"{value:8.3f}" for value in row))

assert abs(rows["pyrotd"][0] - 10) < 0.05 and rows["eqsig"][0] < 2.8
assert np.allclose(rows["pyrotd +0"], rows["eqsig +0"], rtol=0.01)
assert rows["pyrotd"][3] < 0.2 * rows["pyrotd +0"][3]
assert rows["eqsig"][1] < 0.75 * rows["eqsig +0"][1]
PYTHON
