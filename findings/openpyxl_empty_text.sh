#!/usr/bin/env bash
# openpyxl reads a formula whose result is the empty text as None, as if it had never been computed.
#
# Package: openpyxl 3.1.5
# Expected: with `data_only=True` a formula that was never computed is None, and a formula whose
#   stored result is the empty text is "". A survey sheet uses such formulas for "not measured":
#   =IF(B2="","",B2/100).
# Seen: both are None, as is a blank cell. A reader cannot separate "not measured" from "the program
#   that wrote this file computed nothing" by the value. The attribute `data_type` does: "str" for
#   the computed empty text, "n" for the others.
# Output:
#   never computed    None 'n'
#   empty text        None 'str'
#   blank cell        None 'n'
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check openpyxl==3.1.5
venv/bin/python - <<'PYTHON'
import zipfile
import openpyxl

book = openpyxl.Workbook()
book.active["A1"] = book.active["A2"] = '=IF(B2="","",B2/100)'
book.save("formulas.xlsx")

# Store the empty text as the result of A2, as a spreadsheet program does.
sheet = "xl/worksheets/sheet1.xml"
with zipfile.ZipFile("formulas.xlsx") as source, zipfile.ZipFile("survey.xlsx", "w") as target:
    for name in source.namelist():
        content = source.read(name)
        if name == sheet:
            assert content.count(b'<c r="A2"><f>') == 1
            content = content.replace(b'<c r="A2"><f>', b'<c r="A2" t="str"><f>')
        target.writestr(name, content)

cells = openpyxl.load_workbook("survey.xlsx", data_only=True).active
seen = {name: (cells[cell].value, cells[cell].data_type) for name, cell in (
    ("never computed", "A1"), ("empty text", "A2"), ("blank cell", "A3"))}
for name, (value, kind) in seen.items():
    print(f"{name:18}{value!r} {kind!r}")

assert list(seen.values()) == [(None, "n"), (None, "str"), (None, "n")]
PYTHON
