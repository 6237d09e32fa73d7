#!/usr/bin/env bash
# A GeoPackage layer without a reference system gets GDAL's own number 99999.
#
# Packages: pyogrio 0.13.0 (GDAL 3.12.4), geopandas 1.2.0
# Expected: GeoPackage reserves -1 (undefined Cartesian) and 0 (undefined geographic). The layer
#   has one of these if its coordinates are metres of a museum plan and its frame has no CRS.
# Seen: the layer and the header of each geometry have 99999, a new row "Undefined SRS" of the
#   organization "GDAL" in gpkg_spatial_ref_sys. A program that tests for -1 or 0 takes the layer for
#   georeferenced. pyogrio itself reads None. Writing warns that the layer has no CRS.
# Output:
#   layer      99999
#   geometry   99999
#   row        ('Undefined SRS', 'GDAL')
#   read back  None
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyogrio==0.13.0 geopandas==1.2.0 \
    pandas==3.1.1 shapely==2.2.0
venv/bin/python -W ignore::UserWarning - <<'PYTHON'
import sqlite3
import geopandas
import pyogrio
from shapely.geometry import Point

columns = geopandas.GeoDataFrame({"height": [1.5, 2.0]}, geometry=[Point(1, 2), Point(4, 2)])
columns.to_file("plan.gpkg", layer="columns", engine="pyogrio")
file = sqlite3.connect("plan.gpkg")
layer = file.execute("SELECT srs_id FROM gpkg_geometry_columns").fetchone()[0]
blob = file.execute("SELECT geom FROM columns").fetchone()[0]
geometry = int.from_bytes(blob[4:8], "little" if blob[3] & 1 else "big", signed=True)
row = file.execute(
    "SELECT srs_name, organization FROM gpkg_spatial_ref_sys WHERE srs_id = ?", (layer,)
).fetchone()
crs = pyogrio.read_info("plan.gpkg")["crs"]
print("layer     ", layer)
print("geometry  ", geometry)
print("row       ", row)
print("read back ", crs)

assert layer == geometry == 99999
assert row == ("Undefined SRS", "GDAL") and crs is None
PYTHON
