#!/usr/bin/env bash
# eqsig returns PGA for every period shorter than six time steps.
#
# Packages: eqsig 1.2.17, pyrotd 0.6.1
# Expected: the method of Nigam and Jennings is exact for a record that is linear between samples.
#   A record refined by linear interpolation has nearly the same spectrum.
# Seen: `pseudo_response_spectra` and `true_response_spectra` replace all values below six steps by
#   PGA, without a message. At 50 Hz the limit is 0.12 s: Sa(0.119 s) is 0.99, Sa(0.121 s) is 7.87.
#   The refined record has 6.90 and 7.88 at these periods. pyrotd interpolates by Fourier series.
# Output (spectral acceleration divided by the amplitude of the record):
#   T (s)         0.08     0.1   0.119   0.121   0.125    0.15
#   0.02 s       0.986   0.986   0.986   7.874   8.840   2.019
#   0.002 s      1.549   2.496   6.903   7.883   8.863   2.028
#   pyrotd       1.679   2.715   7.499   8.570   9.406   2.197
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
periods = np.array([0.08, 0.1, 0.119, 0.121, 0.125, 0.15])
coarse, fine = 0.02, 0.002
time = np.arange(0, 20, coarse)
record = np.exp(-(((time - 6) / 2) ** 2)) * np.sin(2 * np.pi * 8 * time)
refined = np.interp(np.arange(0, 19.98, fine), time, record)

rows = {
    "0.02 s": eqsig.sdof.pseudo_response_spectra(record, coarse, periods, 0.05)[2],
    "0.002 s": eqsig.sdof.pseudo_response_spectra(refined, fine, periods, 0.05)[2],
    "pyrotd": pyrotd.calc_spec_accels(coarse, record, 1 / periods, 0.05).spec_accel,
}
print("T (s)     " + "".join(f"{period:8g}" for period in periods))
for name, row in rows.items():
    print(f"{name:10}" + "".join(f"{value:8.3f}" for value in row))

assert (rows["0.02 s"][:3] == np.abs(record).max()).all()
assert rows["0.002 s"][2] > 6.5
assert np.allclose(rows["0.02 s"][3:], rows["0.002 s"][3:], rtol=0.01)
PYTHON
