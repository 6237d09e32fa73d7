#!/usr/bin/env bash
# The `noDamageLimit` of an OpenQuake fragility function has no effect below `minIML`.
#
# Package: openquake.engine 3.26.2
# Expected: below `noDamageLimit` the probability of damage is 0, for any `minIML`.
# Seen: intensities below `minIML` are first raised to `minIML`, then compared with `noDamageLimit`.
#   A limit of 0.05 g has no effect if `minIML` is 0.10 g: at PGA = 0 the function returns its value
#   at 0.10 g, here 1.8 %. A limit equal to `minIML` has an effect. The reader accepts both files
#   without a message.
# Output (median 0.27 g):
#   PGA (g)                0    0.02    0.05     0.1     0.3
#   limit 0.05 g       0.018   0.018   0.018   0.018   0.593
#   limit 0.10 g       0.000   0.000   0.000   0.000   0.593
# The engine requires the headers of GDAL on Linux. The readers do not, hence --no-deps.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check numpy==2.2.6 scipy==1.17.1 h5py==3.16.0 \
    pandas==3.1.1 numba==0.61.2 decorator==5.1.1 toml==0.10.2 psutil==7.2.2 requests==2.34.2 \
    shapely==2.2.0 h3==4.5.0 alpha_shapes==1.1.1 pyzmq==27.3.0 fiona==1.10.1
venv/bin/pip install --quiet --disable-pip-version-check --no-deps openquake-engine==3.26.2
cat > fragility.xml <<'XML'
<?xml version="1.0" encoding="utf-8"?>
<nrml xmlns="http://openquake.org/xmlns/nrml/0.5">
<fragilityModel id="columns" assetCategory="contents" lossCategory="contents">
 <description>free-standing columns</description>
 <limitStates>overturned</limitStates>
 <fragilityFunction id="column" format="continuous" shape="logncdf">
  <imls imt="PGA" noDamageLimit="LIMIT" minIML="0.1" maxIML="1.0"/>
  <params ls="overturned" mean="0.3" stddev="0.15"/>
 </fragilityFunction>
</fragilityModel>
</nrml>
XML
venv/bin/python - <<'PYTHON'
import numpy as np
from openquake.hazardlib import nrml
from openquake.risklib import read_nrml  # registers the reader of fragility models

pga = np.array([0, 0.02, 0.05, 0.1, 0.3])
text = open("fragility.xml").read()
rows = {}
for limit in ("0.05", "0.10"):
    with open("model.xml", "w") as file:
        file.write(text.replace("LIMIT", limit))
    model = nrml.to_python("model.xml")
    (function,) = model["PGA", "column"].build(model.limitStates)
    rows[limit] = function(pga)
print("PGA (g)         " + "".join(f"{value:8g}" for value in pga))
for limit, row in rows.items():
    print(f"limit {limit} g    " + "".join(f"{value:8.3f}" for value in row))

assert (rows["0.05"][:4] == rows["0.05"][3]).all() and 0.018 < rows["0.05"][0] < 0.019
assert (rows["0.10"][:4] == 0).all()
PYTHON
