#!/usr/bin/env bash
# The standardized cumulative absolute velocity (CAV) of eqsig leaves out parts of the record.
#
# Package: eqsig 1.2.17
# Expected: if every second exceeds the threshold of 0.025 g, `calc_cav_dp` equals `calc_cav`
#   divided by g. For a constant 0.5 m/s² over 10 s, both are 5.0 m/s.
# Seen: `calc_cav_dp` leaves out the last time step of each second: 0.5 % of CAV at 200 Hz, 5 % at
#   20 Hz. It also leaves out an incomplete last second: 1000 samples at 100 Hz span 9.99 s, and the
#   standardized CAV is 10.8 % too small.
# Output (m/s; the ratio is standardized CAV over CAV):
#   step     samples   CAV     standardized   ratio
#   0.005 s     2001   5.000          4.975   0.995
#    0.01 s     1001   5.000          4.950   0.990
#    0.01 s     1000   4.995          4.455   0.892
#    0.02 s      501   5.000          4.900   0.980
#    0.05 s      201   5.000          4.750   0.950
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check eqsig==1.2.17 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'PYTHON'
import eqsig
import numpy as np

ratios = []
print("step     samples   CAV     standardized   ratio")
for step, samples in ((0.005, 2001), (0.01, 1001), (0.01, 1000), (0.02, 501), (0.05, 201)):
    record = eqsig.AccSignal(np.full(samples, 0.5), step)
    plain = eqsig.im.calc_cav(record)[-1]
    standardized = eqsig.im.calc_cav_dp(record)[-1] * 9.81
    ratios.append(standardized / plain)
    print(f"{step:5} s {samples:8}{plain:8.3f}{standardized:15.3f}{ratios[-1]:8.3f}")

assert np.allclose(ratios, [0.995, 0.99, 0.892, 0.98, 0.95], atol=5e-4)
PYTHON
