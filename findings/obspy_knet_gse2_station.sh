#!/usr/bin/env bash
# A K-NET record that ObsPy writes to GSE2 cannot be read back: its station code is too long.
#
# Package: obspy 1.5.1
# Expected: GSE2 has five columns for the station code, and K-NET codes have six characters. The
#   writer shortens the code with a warning, or refuses the record.
# Seen: the writer writes all six characters without a warning, so most later fields move by one
#   column. The reader takes "5900" samples for 590 and "2.38e-06" for 2.38, and raises ChksumError.
#   With `headonly=True` the reader checks nothing and returns the wrong header without a message.
# Output:
#   written   AKT013  5900 samples  calib 2.384e-06  warnings 0
#   read      ChksumError
#   headonly  AKT01  590 samples  calib 2.380e+00
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check obspy==1.5.1 numpy==2.4.6 "setuptools==80.9.0"
venv/bin/python - <<'PYTHON'
import warnings
from obspy import read

fields = {
    "Origin Time": "1996/08/11 03:12:00", "Lat.": "38.920", "Long.": "140.630",
    "Depth. (km)": "7", "Mag.": "5.9", "Station Code": "AKT013", "Station Lat.": "39.6069",
    "Station Long.": "140.3213", "Station Height(m)": "34",
    "Record Time": "1996/08/11 03:12:39", "Sampling Freq(Hz)": "100Hz",
    "Duration Time(s)": "59", "Dir.": "E-W", "Scale Factor": "2000(gal)/8388608",
    "Max. Acc. (gal)": "1.407", "Last Correction": "1996/08/11 03:00:00", "Memo.": "",
}
with open("record.knet", "w") as file:
    file.writelines(f"{name:18}{value}\n" for name, value in fields.items())
    for first in range(0, 5900, 8):
        file.write("".join(f"{n:9d}" for n in range(first, min(first + 8, 5900))) + "\n")

record = read("record.knet", format="KNET")[0]
record.data = record.data.astype("int32")
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    record.write("record.gse", format="GSE2")
stats = record.stats
print(f"written   {stats.station}  {stats.npts} samples  calib {stats.calib:.3e}  "
      f"warnings {len(caught)}")
try:
    read("record.gse")
    outcome = "no error"
except Exception as error:
    outcome = type(error).__name__
print("read     ", outcome)
head = read("record.gse", headonly=True)[0].stats
print(f"headonly  {head.station}  {head.npts} samples  calib {head.calib:.3e}")

assert not caught and outcome == "ChksumError"
assert (head.station, head.npts, head.calib) == ("AKT01", 590, 2.38)
PYTHON
