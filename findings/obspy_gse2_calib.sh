#!/usr/bin/env bash
# ObsPy writes the calibration of a GSE2 file with three significant digits.
#
# Package: obspy 1.5.1
# Expected: `stats.calib` survives a GSE2 file to five digits or more. The field has ten columns,
#   enough for "2.3842e-06". Samples are integers, so `calib` carries the whole scale of the record.
# Seen: the writer formats `calib` as "%10.2e". A K-NET scale factor of 2000 gal / 8388608 becomes
#   2.38e-06 m/s² per count: each acceleration is 0.18 % too small. Other factors lose up to 0.5 %.
#   There is no warning. SAC keeps the same factor to the precision of float32.
# Output:
#   WID2 field  '  2.38e-06'
#   GSE2        2.3800000000e-06  -0.1756 %
#   SAC         2.3841857910e-06  +0.0000 %
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check obspy==1.5.1 numpy==2.4.6 "setuptools==80.9.0"
venv/bin/python -W error::UserWarning - <<'PYTHON'
import numpy as np
from obspy import Trace, read

factor = 2000 / 8388608 * 0.01  # m/s² per count, from "2000(gal)/8388608" of a K-NET header
header = {"station": "AKT13", "sampling_rate": 100.0, "calib": factor}
record = Trace(np.arange(1000, dtype="int32"), header)
record.write("record.gse", format="GSE2")
record.write("record.sac", format="SAC")

with open("record.gse") as lines:
    print("WID2 field ", repr(next(lines)[69:79]))
error = {}
for name, path in (("GSE2", "record.gse"), ("SAC", "record.sac")):
    calib = read(path)[0].stats.calib
    error[name] = calib / factor - 1
    print(f"{name:10}  {calib:.10e}  {100 * error[name]:+.4f} %")

assert abs(error["GSE2"] + 0.001756) < 1e-6
assert abs(error["SAC"]) < 1e-7
PYTHON
