#!/usr/bin/env bash
# The spectrum intensities of eqsig assume a period step of 0.01 s, whatever periods are passed.
#
# Package: eqsig 1.2.17
# Expected: `calc_asi` and `calc_vsi` integrate the spectrum over the periods passed. A step of
#   0.02 s or 0.05 s between the same limits changes the integral by a few percent at most.
# Seen: both integrals use 0.01 s between any two periods. A step of 0.02 s halves the intensity, a
#   step of 0.05 s divides the intensity by five. There is no message.
# Output:
#   step       ASI (g·s)   integral   VSI (m)   integral
#   0.01 s        0.1938     0.1938    0.1812     0.1812
#   0.02 s        0.0969     0.1939    0.0906     0.1812
#   0.05 s        0.0388     0.1938    0.0362     0.1811
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check eqsig==1.2.17 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'PYTHON'
import eqsig
import numpy as np

step = 0.01
time = np.arange(0, 20, step)
record = eqsig.AccSignal(np.exp(-(((time - 6) / 2) ** 2)) * np.sin(2 * np.pi * 2 * time), step)
ratios = []
print("step       ASI (g·s)   integral   VSI (m)   integral")
for interval in (0.01, 0.02, 0.05):
    row = []
    for end, measure, kind, scale in (
        (1.5, eqsig.im.calc_asi, 2, 9.81),
        (2.5, eqsig.im.calc_vsi, 1, 1.0),
    ):
        periods = np.arange(0.1, end + interval / 2, interval)
        spectrum = eqsig.sdof.pseudo_response_spectra(record.values, step, periods, 0.05)[kind]
        row += [measure(record, periods=periods), np.trapezoid(spectrum, periods) / scale]
    ratios.append((row[0] / row[1], row[2] / row[3]))
    print("{:4} s {:13.4f}{:11.4f}{:10.4f}{:11.4f}".format(interval, *row))

assert np.allclose(ratios, [[1, 1], [0.5, 0.5], [0.2, 0.2]], rtol=1e-6)
PYTHON
