#!/usr/bin/env bash
# The spectral acceleration "sa" of pyrotd is not the acceleration of the oscillator.
#
# Package: pyrotd 0.6.1
# Expected: `osc_type="sa"` returns the peak absolute acceleration. At 5 % damping it is close to
#   the pseudo-acceleration "psa": it tends to PGA for short periods and to 0 for long periods.
# Seen: pyrotd computes H·(1 + (iω)²), with H the transfer function of relative displacement.
#   The absolute acceleration is 1 + (iω)²·H. The result tends to 0 for short periods and to PGA for
#   long periods. "sa" and "psa" agree only near 0.5 s, the period of the record. eqsig confirms the
#   expected values.
# Output (PGA 0.298):
#   T (s)           0.05      0.1      0.5        1        4
#   pyrotd psa     0.302    0.311    2.266    0.101    0.005
#   pyrotd sa      0.003    0.012    2.250    0.397    0.301
#   eqsig true     0.298    0.310    2.274    0.103    0.006
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
periods = np.array([0.05, 0.1, 0.5, 1.0, 4.0])
time = np.arange(0, 20, step)
record = 0.3 * np.exp(-(((time - 6) / 2) ** 2)) * np.sin(2 * np.pi * 2 * time)
peak = np.abs(record).max()


def spectrum(kind):
    return pyrotd.calc_spec_accels(step, record, 1 / periods, damping, osc_type=kind).spec_accel


rows = {
    "pyrotd psa": spectrum("psa"),
    "pyrotd sa": spectrum("sa"),
    "eqsig true": eqsig.sdof.true_response_spectra(record, step, periods, damping)[2],
}
print(f"PGA {peak:.3f}")
print("T (s)      " + "".join(f"{period:9g}" for period in periods))
for name, row in rows.items():
    print(f"{name:11}" + "".join(f"{value:9.3f}" for value in row))

assert np.allclose(rows["pyrotd psa"][:3], rows["eqsig true"][:3], rtol=0.02)
assert rows["pyrotd sa"][0] < 0.05 * peak and rows["pyrotd sa"][4] > 0.95 * peak
PYTHON
