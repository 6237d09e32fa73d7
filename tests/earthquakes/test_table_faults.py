"""Tables of objects with users' words and faults: all headings are understood or refused, all faults listed at once."""

import re
import warnings
import zipfile

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stylobate.aliases import ALIASES
from stylobate.config.parts import DIAMETERS
from stylobate.earthquakes import read_inventory
from stylobate.earthquakes.config.assess import AssessConfig
from stylobate.earthquakes.inventories.headings import Heading, quantities
from stylobate.errors import ConfigError, FileError, ParameterError, UnlikelyInputWarning

pytestmark = pytest.mark.filterwarnings("ignore:.*taken as solid cylinders")

MUSEUM = """Inventory no.;Object;Ø (cm);Height (cm);Weight (kg);Friction;Damping;Remarks
A-1;amphora;22,5;95;14,2;0,5;housner;chipped, rim
A-2;jug;11;30;2,1;0,45;0,05;
A-3;hydria;18,4;44;6,5;0,5;housner;restored
"""


def table(tmp_path, text, name="objects.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def problems(path, **more):
    with pytest.raises(ConfigError) as error:
        read_inventory(path, **more)
    return list(error.value.problems)


@pytest.mark.parametrize("written", ["{} ({})", "{} [{}]", "{}, {}", "{} / {}", "{} in {}", "{}_{}"])
def test_every_alias_is_read_as_its_number_with_its_unit(written):
    units = {"radius": "mm", "height": "cm", "mass_height": "in", "mass": "kg", "density": "g/cm³"}
    for name, aliases in ALIASES.items():
        for alias in (name, *aliases):
            unit = units.get(DIAMETERS.get(name, name).removeprefix("inner_").removeprefix("top_"), "")
            found = Heading.read(written.format(alias, unit) if unit else alias, "wobbling")
            assert found is not None, alias
            assert (found.name, found.unit, found.is_spread) == (name, unit, False), alias
            assert found.is_alias == (alias != name), alias


def test_a_museum_table_with_a_title_is_read_as_it_is(tmp_path):
    path = table(tmp_path, f"Greek vases, room 12\n;;;;;;;\n{MUSEUM}")
    with pytest.warns(UnlikelyInputWarning, match=r"above the headings is left out \(row 1: 'Greek vases, room 12'\)"):
        amphora, jug, _ = read_inventory(path)
    assert amphora.column == {"diameter": 0.225, "height": 0.95, "mass": 14.2}
    assert (amphora.model, jug.model, jug.friction_coefficient) == ({"damping": "housner"}, {"damping": 0.05}, 0.45)
    assert amphora.carried == {"Inventory no.": "A-1", "Remarks": "chipped, rim"}
    assert amphora.where == "objects.csv, row 4"
    assert amphora.read_as == {
        "Object": "name",
        "Ø (cm)": "diameter",
        "Weight (kg)": "mass",
        "Friction": "friction_coefficient",
    }
    assert read_inventory(table(tmp_path, MUSEUM), carry=["Object"])[0].name == "A-1"
    german = MUSEUM.replace("Inventory no.", "Inv.-Nr.").replace("Object", "Objekt")
    assert read_inventory(table(tmp_path, german))[0].name == "amphora"
    (line,) = problems(table(tmp_path, MUSEUM), carry=["Remark"])
    assert line == "carry: no such heading in objects.csv (got 'Remark'); did you mean Remarks?"


@pytest.mark.parametrize(
    ("heading", "meant"),
    [
        ("Wieght (kg)", "mass"),
        ("Max. height (cm)", "height"),
        ("Foot radus (m)", "radius"),
        ("Bodendurchmesser [cm]", "diameter"),
        ("width", "radius or diameter"),
        ("Height tolerance (mm)", "height_spread"),
        ("moment of inertia", "transverse_inertia or axial_inertia"),
    ],
)
def test_a_heading_that_only_resembles_a_number_is_refused_with_what_it_may_mean(tmp_path, heading, meant):
    lines = problems(table(tmp_path, f"{heading};damping;friction\n1;0,1;0,5\n"))
    assert any(f"heading {heading!r}: unknown column; did you mean {meant}?" in line for line in lines), lines
    assert not any(f"{meant} is missing" in line for line in lines)


def test_weighed_objects_without_a_centre_of_mass_are_taken_as_cylinders_with_a_warning(tmp_path):
    rows = [line.split(";") for line in MUSEUM.splitlines()]
    more = {
        "": [[], ["rows 2, 3, 4"]],
        "shape": [["shape", "solid", "", "solid"], ["row 3"]],
        "mass_height [cm];profile": [["mass_height [cm];profile", *["15;vase"] * 3], []],
    }
    for cells, named in more.values():
        text = "\n".join(";".join([*row, *cells[place : place + 1]]) for place, row in enumerate(rows))
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            read_inventory(table(tmp_path, text))
        texts = [str(one.message) for one in found if "solid cylinders" in str(one.message)]
        assert [one.partition(", ")[2].partition(":")[0] for one in texts] == named


def test_usual_columns_of_museums_are_carried_through(tmp_path):
    others = "Room Material Location Type Notes Origin Provenance Showcase Shelf Value Condition Culture Lender Date"
    others = [
        *others.split(),
        "Description",
        "Insurance value",
        "Base material",
        "Height of plinth (cm)",
        "Max. radius (cm)",
        "Inv. photo",
    ]
    head, *rows = MUSEUM.splitlines()
    text = "\n".join([";".join([head, *others]), *(";".join([row, *"x" * len(others)]) for row in rows)])
    assert set(read_inventory(table(tmp_path, text))[0].carried) == {"Inventory no.", "Remarks", *others}


def spoilt(kinds):
    """Return the museum table with these faults, and its defaults."""
    head, *rows = [line.split(";") for line in MUSEUM.splitlines()]
    defaults = {}
    changes = {
        "misspelt": lambda: head.__setitem__(3, "Hieght (cm)"),
        "unit": lambda: head.__setitem__(2, "Ø (kg)"),
        "cell": lambda: rows[0].__setitem__(4, "heavy"),
        "empty": lambda: rows[1].__setitem__(5, ""),
        "cells": lambda: rows[2].extend(["", "more"]),
        "name": lambda: rows[1].__setitem__(1, rows[0][1]),
        "headless": lambda: (head.insert(0, ""), [row.insert(0, "7") for row in rows]),
        "sum": lambda: rows.append([*[""] * (len(head) - 8), "Total", *[""] * 7]),
        "default": lambda: defaults.update(dampign=0.1),
        "value": lambda: defaults.update(density="heavy"),
        "column": lambda: [row.pop(head.index("Damping")) for row in (*rows, head)],
    }
    for kind, change in changes.items():
        if kind in kinds:
            change()
    return "\n".join(";".join(row) for row in (head, *rows)), defaults


EXPECTED = {
    "misspelt": "heading 'Hieght (cm)': unknown column; did you mean height?",
    "unit": "heading 'Ø (kg)': must be in mm, cm, m, in or ft, got 1 kg. Correct the unit.",
    "cell": "row 2, Weight (kg): must be a number, with or without a unit, got 'heavy'. Correct the cell.",
    "empty": "row 3, Friction: the cell is empty. Fill it, or state friction_coefficient in defaults",
    "cells": "row 4: ",
    "name": "rows 2, 3, Object: 2 objects have this name (got 'amphora'). Give each its own, or name 'Object' in carry",
    "headless": "column 1 has no heading (got '7' in row 2). Write one, or empty its cells.",
    "sum": "row 5: a sum, and no object (got 'Total'). Remove the row.",
    "default": "defaults: unknown (got 'dampign'); did you mean damping?",
    "value": "defaults.density: must be a number, with or without a unit, got 'heavy'. Correct it.",
    "column": "the column damping is missing. Write the word housner or a measured value, or state damping in defaults",
}


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sets(st.sampled_from(sorted(EXPECTED)), min_size=1))
def test_one_pass_lists_each_fault_in_a_line_of_its_own(tmp_path, kinds):
    text, defaults = spoilt(kinds)
    found = problems(table(tmp_path, text), defaults=defaults)
    for kind in kinds:
        (line,) = (line for line in found if EXPECTED[kind] in line)
        found.remove(line)
    assert not found


def test_all_missing_columns_are_named_together_with_their_remedies(tmp_path):
    found = problems(table(tmp_path, "Object;Remarks\namphora;whole\n"))
    assert [re.search(r"the column (.*) is missing", line)[1] for line in found] == [
        "friction_coefficient",
        "damping",
        "radius or diameter",
        "height or mass_height",
        "density or mass",
    ]
    assert all(
        f"--default {name}=" in line for line, name in zip(found, ("friction_coefficient", "damping"), strict=False)
    )


def test_equal_faults_of_many_rows_have_one_line_and_others_are_cut_with_their_count(tmp_path):
    rows = [f"o{place};10;{f'x{place}'};2;;housner" for place in range(60)]
    found = problems(table(tmp_path, "\n".join(["name;Ø [cm];height;mass;friction;damping", *rows])))
    assert found[1].startswith("objects.csv, rows 2, 3, 4, 5, 6, 7 and 54 more, friction: the cell is empty.")
    assert found[-1] == "objects.csv, height: and 48 more lines on this column."
    assert len(found) == 14


@pytest.mark.parametrize(
    ("row", "line"),
    [
        (";;cm;cm;kg;;;", "row 2: units in a row of their own (got 'cm', 'cm', 'kg'). Write each in its heading"),
        ("Room 12;;;;;;;", "row 2: one cell only, and no object (got 'Room 12'). Remove the row"),
    ],
)
def test_a_row_that_is_no_object_is_named(tmp_path, row, line):
    head, *rows = MUSEUM.splitlines()
    (found,) = problems(table(tmp_path, "\n".join([head, row, *rows])))
    assert line in found


def test_a_default_fills_cells_by_any_name_and_joins_no_other_number(tmp_path):
    text = MUSEUM.replace("14,2", "").replace(";housner;", ";;")
    defaults = {"η": "housner", "Dichte": "2,1 g/cm³"}
    amphora, jug, _ = read_inventory(table(tmp_path, text), defaults=defaults)
    assert amphora.column == {"diameter": 0.225, "height": 0.95, "density": 2100.0}
    assert jug.column == {"diameter": 0.11, "height": 0.3, "mass": 2.1}
    assert (amphora.model, jug.model) == ({"damping": "housner"}, {"damping": 0.05})


def book(tmp_path, change=lambda sheet: None, others=()):
    openpyxl = pytest.importorskip("openpyxl")
    made = openpyxl.Workbook()
    made.active.title = "vases"
    for line in MUSEUM.splitlines():
        made.active.append([_cell(one) for one in line.split(";")])
    change(made.active)
    for name in others:
        made.create_sheet(name).append(["name"])
    made.create_sheet("empty")
    made.save(tmp_path / "objects.xlsx")
    return tmp_path / "objects.xlsx"


def _cell(text):
    return float(text.replace(",", ".")) if re.fullmatch(r"\d+(,\d+)?", text) else text or None


def test_merged_cells_are_named_and_are_the_only_fault(tmp_path):
    (line,) = problems(book(tmp_path, lambda sheet: [sheet.merge_cells(one) for one in ("H2:H3", "E3:E4")]))
    assert line == "objects.xlsx: merged cells (got H2:H3, E3:E4). Unmerge them, and fill each cell."


def test_a_formula_that_was_never_computed_is_named(tmp_path):
    path = book(tmp_path, lambda sheet: sheet.__setitem__("D3", "=3*10"))
    with pytest.raises(FileError, match=r"vases: formulas were never computed \(got D3\)\. Open the workbook"):
        read_inventory(path)


def test_a_workbook_whose_stated_size_is_out_of_date_keeps_all_its_rows(tmp_path):
    whole = read_inventory(book(tmp_path))
    with zipfile.ZipFile(tmp_path / "objects.xlsx") as given, zipfile.ZipFile(tmp_path / "stale.xlsx", "w") as stale:
        for name in given.namelist():
            stale.writestr(name, re.sub(rb'<dimension ref="[^"]*"', b'<dimension ref="A1:B2"', given.read(name)))
    assert [one.column for one in read_inventory(tmp_path / "stale.xlsx")] == [one.column for one in whole]


def test_other_sheets_are_named_unless_the_path_names_the_sheet(tmp_path):
    path = book(tmp_path, others=["bronzes", "lamps"])
    with pytest.warns(UnlikelyInputWarning, match=r"only its first sheet is read \(others are 'bronzes', 'lamps'\)"):
        read_inventory(path)
    assert len(read_inventory(path / "vases")) == 3


def test_an_assessment_names_the_row_of_an_empty_damping_and_takes_a_default(tmp_path):
    path = table(tmp_path, MUSEUM.replace("0,05", ""))
    values = {"columns": str(path), "records": "quakes"}
    with pytest.raises(ConfigError) as error:
        AssessConfig.parse(values)
    (line,) = error.value.problems
    assert "objects.csv, row 3, Damping: the cell is empty. Write the word housner or a measured value, or" in line
    found = AssessConfig.parse({**values, "defaults": {"damping": 0.1}, "carry": ["Remarks"]})
    assert found.dissipation["jug"]["central"] == {"damping": 0.1}
    assert found.read_as["Weight (kg)"] == "mass"
    with pytest.raises(ConfigError, match=r"carry: belongs to a table of objects"):
        AssessConfig.parse({"columns": {}, "carry": ["x"]})


def test_what_is_left_out_of_a_table_is_a_note_of_the_assessment(tmp_path):
    path = table(tmp_path, f"Vases\n{MUSEUM}")
    with pytest.warns(UnlikelyInputWarning, match="row 1: 'Vases'"):
        found = AssessConfig.parse({"columns": str(path), "records": "quakes", "notes": ["In room 12."]})
    assert [one.partition(":")[0] for one in found.notes] == ["In room 12.", "Warning", "Warning"]
    assert "solid cylinders" in found.notes[-1]


def test_a_default_without_a_value_is_refused():
    from stylobate.cli.object_tables import with_object_table

    stated = {"default": ["friction=0.5", "damping = housner"], "carry": ["Ø"]}
    assert with_object_table({"defaults": {"friction": 1.0}}, stated) == {
        "defaults": {"friction": "0.5", "damping": "housner"},
        "carry": ("Ø",),
    }
    with pytest.raises(ParameterError, match=r"--default: must be NAME=VALUE \(got 'damping'\)"):
        with_object_table({}, {"default": ["damping"], "carry": None})


def test_numbers_of_a_table_are_those_of_column_and_model():
    assert set(ALIASES) - {"name", "site", "shape", "profile"} <= set(quantities("wobbling"))


def test_a_wrong_uncertainty_hides_no_other_fault_of_its_row(tmp_path):
    text = "name,radius,height,density,damping,damping_spread,friction\na,0.1,1,2000,,x,0.5\n"
    assert [line.split(":")[0] for line in problems(table(tmp_path, text))] == [
        "objects.csv, row 2, damping",
        "objects.csv, row 2, damping_spread",
    ]
