"""Cells: text stays text in workbooks and CSV files, and no character of a name ends or alters what is written."""

import csv
import io
import re
import zipfile
from xml.etree import ElementTree as ET

import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.cli.output import print_json, print_table, table_lines
from stylobate.cli.terminal import remark, say
from stylobate.earthquakes import InventoryObject, assess, export_inventory, inventory, lognormal_fragility
from stylobate.earthquakes.fragility.export import export_fragility, identifier
from stylobate.earthquakes.inventories.rows import ObjectTable
from stylobate.earthquakes.inventories.table import read_inventory
from stylobate.earthquakes.study_inputs import named_records
from stylobate.errors import ConfigError, ParameterError
from stylobate.files import csv_text, unmarked, write_workbook
from stylobate.plots.page import PageSection, PageTable, page
from stylobate.results.report_details import DesignSpectrum, ReportDetails
from stylobate.text import UNPRINTABLE, printable

FORMULAS = ["=2+2", "+1+1", "-2-2", "@SUM(1)", "\t=1", "\n=1", " =1", "\uff1d1", "'=1", "''-a", '=HYPERLINK("x")']
PLAIN = ["-0.5", "+3", "-1e-3", "-1,5 %", "-", "a=b", "'s-Hertogenbosch", "2024-05-01", "", "#N/A", "1.234,5", "柱"]
ODD = "a\x07b\x1b[31m\ud800\u202ec\uffff"
# Text with many beginnings of formulas, marks, numbers and controls.
CELLS = st.text(st.sampled_from("='+-@\uff0b,.;5eE% \"#\x0b\r\n\t") | st.characters(), max_size=8)
TABLE = """name;radius [mm];height [cm];density;damping;friction_coefficient;=cmd;remark
=2+2;62.5;55;2100;0.05;0.6;=1+1;two\x0blines
'+jug;80;40;2100;0.05;0.45;-0.5;bell\x07
"""


def cells_of(text):
    return list(csv.reader(io.StringIO(text, newline="")))


def curves(*names):
    """Return fragility curves in peak ground acceleration."""
    found = xr.concat([lognormal_fragility(2.0, 0.4, name=name) for name in names], "limit_state")
    found["median"].attrs |= {"long_name": "median peak ground acceleration", "units": "m s-2"}
    return found.assign_coords(limit_state=list(names))


@given(CELLS, CELLS)
def test_a_cell_comes_back_from_a_csv_file_unchanged(first, second):
    cells = [printable(first), printable(second)]
    (_, row) = cells_of(csv_text(["x", "y"], [cells]))
    assert list(map(unmarked, row)) == cells


@given(CELLS)
def test_no_text_of_a_csv_file_begins_a_formula(cell):
    ((written,),) = cells_of(csv_text([cell or "x"], []))
    assert not re.match(r"\s*[=@\uff1d\uff0b\uff0d\uff20]|[\t\r\n]", written)
    if re.match(r"\s*[-+]", written):
        assert not re.search(r"[^-+\d.,eE%\sinf]", written, re.ASCII)  # a number
    assert not UNPRINTABLE.search(written)


@pytest.mark.parametrize(("cells", "mark"), [(FORMULAS, "'"), (PLAIN, "")])
def test_formulas_are_marked_and_other_text_is_not(cells, mark):
    (_, row) = cells_of(csv_text(cells, [cells]))
    assert row == [mark + cell for cell in cells]
    numbers = [-0.5, -3, 1e-300]
    assert cells_of(csv_text(["x"] * 3, [numbers]))[1] == list(map(str, numbers))


def test_text_of_a_workbook_is_text_and_numbers_are_numbers(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    rows = [FORMULAS, PLAIN, [-0.5, 3, True, None], [ODD, "\x0b", "TRUE"]]
    book = openpyxl.load_workbook(write_workbook(tmp_path / "book.xlsx", {"cells": rows}))
    read = [list(row) for row in book["cells"].iter_rows()]
    assert [cell.value for cell in read[0][: len(FORMULAS)]] == FORMULAS
    assert {(cell.data_type, bool(cell.quotePrefix)) for cell in read[0][: len(FORMULAS)]} == {("s", True)}
    assert {cell.data_type for cell in read[1] if cell.value} == {"s"}
    assert [(cell.value, cell.data_type) for cell in read[2][:3]] == [(-0.5, "n"), (3, "n"), (True, "b")]
    assert [cell.value for cell in read[3][:3]] == [printable(ODD), "\n", "TRUE"]


def test_the_same_tables_give_the_same_bytes_of_a_workbook(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    first, second = (write_workbook(tmp_path / name, {"a": [["x"], [1.0]], "b": [["y"]]}) for name in ("1", "2"))
    assert first.read_bytes() == second.read_bytes()
    assert {one.date_time[0] for one in zipfile.ZipFile(first).infolist()} == {1980}
    first.rename(tmp_path / "book.xlsx")
    about = openpyxl.load_workbook(tmp_path / "book.xlsx").properties
    assert about.created.year == about.modified.year == 1980


def test_an_inventory_keeps_the_text_of_its_table(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    (tmp_path / "objects.csv").write_text(TABLE, encoding="utf-8")
    objects = read_inventory(tmp_path / "objects.csv")
    assert [one.name for one in objects] == ["=2+2", "+jug"]  # the mark of a spreadsheet program is not of the name
    assert objects[0].carried == {"=cmd": "=1+1", "remark": "two\nlines"}
    found = inventory(objects, sb.sample_record(), samples=1, progress=False)
    again = ObjectTable.read(export_inventory(found, tmp_path / "ranking.csv"))
    carried = {row.cells["name"]: (row.cells["=cmd"], row.cells["remark"]) for row in again.rows}
    assert carried == {"=2+2": ("=1+1", "two\nlines"), "+jug": ("-0.5", "bell\N{REPLACEMENT CHARACTER}")}
    book = openpyxl.load_workbook(export_inventory(found, tmp_path / "ranking.xlsx"))
    assert "f" not in {cell.data_type for row in book["ranking"].iter_rows() for cell in row}


def test_a_name_that_cannot_be_printed_is_refused_in_one_line_where_it_enters(tmp_path):
    model = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0))
    pulse = sb.Pulse.one_sine(acceleration=2.5, angular_frequency=4.0)
    fits = curves("fallen")
    vase = InventoryObject(name=ODD, column={"radius": 0.1, "height": 0.5, "density": 2e3}, friction_coefficient=0.5)
    levels = {"central": {"damping": 0.05}}
    for enter in (
        lambda: vase.prepared("wobbling"),
        lambda: named_records({ODD: pulse}),
        lambda: assess({ODD: model}, pulse, dissipation=levels, friction_coefficient=0.6),
        lambda: assess({"a": model}, pulse, dissipation=levels, friction_coefficient=0.6, title=ODD),
        lambda: ReportDetails(author=ODD),
        lambda: ReportDetails(about_columns={"a": ODD}),
        lambda: DesignSpectrum(period=(0.1, 1.0), acceleration=(1.0, 1.0), name=ODD),
        lambda: export_fragility(fits, tmp_path / "f.xml", name=ODD),
        lambda: export_fragility(fits.assign_coords(limit_state=[ODD]), tmp_path / "f.xml", name="a"),
    ):
        with pytest.raises((ConfigError, ParameterError), match=r"holds a character that cannot be printed") as error:
            enter()
        assert "\n" not in str(error.value)
        assert not UNPRINTABLE.search(str(error.value))
    assert not list(tmp_path.iterdir())
    with pytest.raises(ParameterError, match="name: must be a text that is not empty"):
        export_fragility(fits, tmp_path / "f.xml", name=" ")


def test_the_name_of_a_record_is_cleaned():
    record = sb.Record(samples=[0.0, 2.0, 0.0], step=0.5, name=ODD)
    assert record.name == printable(ODD)
    assert list(named_records(record)) == [record.name]


def test_a_page_holds_no_character_that_cannot_be_printed():
    table = PageTable([ODD], [[ODD]])
    html = page(ODD, [ODD], [PageSection(ODD, [table])], author=ODD)
    assert not UNPRINTABLE.search(html)


def test_a_terminal_obeys_no_name(capsys):
    say(ODD)
    remark(ODD)
    print_table(ODD, [[ODD, "x"]], [ODD, "y"])
    print_json({ODD: [ODD]})
    shown = capsys.readouterr()
    assert not UNPRINTABLE.search(shown.out + shown.err)
    assert "\\ud800" in shown.out  # JSON keeps the name


@settings(max_examples=50)
@given(st.text(min_size=1, max_size=20), st.text(min_size=1, max_size=20), st.sampled_from("-."))
def test_identifiers_are_valid_and_differ_as_names_do(one, other, mark):
    first, second = identifier(one, mark), identifier(other, mark)
    assert re.fullmatch(rf"[A-Za-z0-9_{re.escape(mark)}]{{1,75}}", first)
    assert (first == second) == (one == other)


@pytest.mark.parametrize("mark", ["-", "."])
def test_identifiers_of_names_in_many_scripts_differ(mark):
    names = [
        "柱",
        "é",
        "e\u0301",
        "-",
        "--",
        " ",
        "_",
        "__",
        "tilt 0.1 α",
        "tilt 0,1 α",
        "tilt_0.1 α",
        "Säule",
        "Saule",
    ]
    names += [
        "колонна",
        "στήλη",
        "عمود",
        "स्तंभ",
        "หิน",
        "기둥",
        "はしら",
        "🏺",
        "u67f1",
        "-u67f1-",
        ".u67f1.",
        "a-dash-b",
    ]
    names += ["a-b", "a.b", "dot", "-dot-", ".dot.", "x" * 75, "x" * 76, "x" * 77, "柱" * 40, "柱" * 41]
    found = [identifier(name, mark) for name in names]
    assert len(set(found)) == len(names)
    assert identifier("my vase 2", mark) == "my_vase_2"


def test_nrml_states_the_names_of_its_identifiers(tmp_path):
    fits = curves("倒", "倒れ")
    (model,) = ET.parse(export_fragility(fits, tmp_path / "f.xml", name="柱 & é")).getroot()  # noqa: S314  written here
    description, states, function = model
    words = states.text.split()
    assert len(set(words)) == 2
    for word, name in zip(words, ("倒", "倒れ"), strict=True):
        assert f"{word} is '{name}'" in description.text
    assert "柱 & é" in description.text
    assert [one.get("ls") for one in function[1:]] == words


def test_a_table_breaks_no_name_while_a_heading_can_be_folded():
    header = ["record", "Arias [m/s]", "residual velocity [m/s]"]
    lines = table_lines([["RSN753_LOMAP_CLS", "3.245", "0.0001"]], header, 50)
    assert any("RSN753_LOMAP_CLS" in line for line in lines)
    assert max(map(len, lines)) <= 50
    assert max(map(len, table_lines([["x" * 200, "a b c d e f g"]], ["name", "y"], 50))) <= 50
