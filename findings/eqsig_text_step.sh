#!/usr/bin/env bash
# The text format of eqsig keeps four decimals of the time step.
#
# Package: eqsig 1.2.17
# Expected: `save_signal` writes all digits of the time step, and `load_asig` returns the same step.
# Seen: the step is written as "%.4f" and the samples as "%.6f". A record of 300 Hz is read with
#   0.0033 s, so its duration is 1 % too short. A sample of 2.4e-06 (a weak record in units of g) is
#   read as 2e-06. The reader uses only the digits after the point: a step of 1 s is read as 0 s.
#   There is no message.
# Output:
#   saved       loaded
#   0.005       0.005
#   0.0078125   0.0078
#   0.00333333  0.0033
#   1           0.0
#   sample 2.4e-06 is loaded as 2e-06
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check eqsig==1.2.17 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'PYTHON'
import eqsig
import numpy as np

weak = 2.4e-6
loaded = []
print("saved       loaded")
for step in (0.005, 1 / 128, 1 / 300, 1.0):
    eqsig.save_signal("record.txt", eqsig.AccSignal(np.full(100, weak), step, label="record"))
    record = eqsig.load_asig("record.txt")
    loaded.append(record.dt)
    print(f"{step:<12.6g}{record.dt}")
print(f"sample {weak} is loaded as {record.values[50]}")

assert loaded == [0.005, 0.0078, 0.0033, 0.0]
assert record.values[50] == 2e-6
PYTHON
