#!/usr/bin/env bash
# ObsPy rounds the sampling interval of a SAC file to whole microseconds.
#
# Package: obspy 1.5.1
# Expected: a record sampled at 128 Hz is written to SAC and read back at 128 Hz. SAC stores the
#   interval as float32, and float32 holds 1/128 s exactly.
# Seen: `read` returns 0.007812 s instead of 0.0078125 s, with a UserWarning. The last of 20001
#   samples is 10 ms early. `merge` refuses to join the SAC copy and the MiniSEED copy of the record,
#   although both print as 128.0 Hz. `round_sampling_interval=False` keeps the stored value.
#   An interval such as 0.01 s, a whole number of microseconds, is not affected.
# Output:
#   stored in the file  0.0078125
#   read                0.007812
#   read, not rounded   0.0078125
#   end of the record   -10.0 ms
#   rates that `merge` refuses [128.00819252432154, 128.0]
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check obspy==1.5.1 numpy==2.4.6 "setuptools==80.9.0"
venv/bin/python -W ignore - <<'PYTHON'
import re
import numpy as np
from obspy import Trace, read

record = Trace(np.zeros(20001, "float32"), {"sampling_rate": 128.0})
record.write("record.sac", format="SAC")
record.write("record.mseed", format="MSEED")

stored = float(np.fromfile("record.sac", "<f4", 1)[0])
rounded = read("record.sac")[0]
kept = read("record.sac", round_sampling_interval=False)[0]
shift = rounded.stats.endtime - record.stats.endtime
print("stored in the file ", stored)
print("read               ", rounded.stats.delta)
print("read, not rounded  ", kept.stats.delta)
print(f"end of the record   {1000 * shift:.1f} ms")
try:
    (read("record.sac") + read("record.mseed")).merge()
    rates = None
except Exception as error:
    rates = [float(rate) for rate in re.findall(r"128\.\d+", str(error))]
print("rates that `merge` refuses", rates)

assert stored == kept.stats.delta == 1 / 128
assert rounded.stats.delta == 0.007812
assert rates == [128.00819252432154, 128.0]
PYTHON
