"""Tables of objects: separators, decimal commas, units, spreads, workbooks, GeoPackages, and lines on mistakes."""

import sys

import numpy as np
import pytest

from stylobate.earthquakes import LognormalSpread, NormalSpread, export_inventory, inventory, read_inventory
from stylobate.earthquakes.inventories.geopackages import read_layer
from stylobate.errors import ConfigError, FileError, ParameterError, UnlikelyInputWarning, UnsupportedError
from stylobate.records import sample_record

HEAD = "name,radius [mm],radius_spread [mm],height [cm],height_spread,density,damping,friction_coefficient,room"
PLAIN = f"""{HEAD}
amphora,62.5,0.5,55,2 %,2100,housner,0.6,12
"jug, large",80,,40,,2100,0.05,0.45,
"""
GERMAN = """Name;Radius [mm];radius_spread [mm];Height [cm];height spread;Density;Damping;Friction coefficient;room
amphora;62,5;0,5;55;2 %;2100;housner;0,6;12
jug, large;80;;40;;2100;0,05;0,45;
"""


def table(tmp_path, text, name="objects.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_text(text, encoding=encoding)
    return path


def problems(path, **more):
    with pytest.raises(ConfigError) as error:
        read_inventory(path, **more)
    return list(error.value.problems)


def numbers(objects):
    """Return everything of objects but the place of their rows."""
    return [(one.name, one.column, one.model, one.friction_coefficient, one.spreads, one.carried) for one in objects]


def test_numbers_units_and_spreads_of_a_table(tmp_path):
    amphora, jug = read_inventory(table(tmp_path, PLAIN))
    assert amphora.column == {"radius": 0.0625, "height": 0.55, "density": 2100.0}
    assert amphora.model == {"damping": "housner"}
    assert amphora.spreads == {"radius": NormalSpread(0.0005), "height": LognormalSpread(0.02)}
    assert (jug.name, jug.friction_coefficient, jug.spreads) == ("jug, large", 0.45, {})
    assert (amphora.carried, jug.carried) == ({"room": "12"}, {"room": ""})
    assert amphora.prepared("wobbling").model.damping == amphora.prepared("wobbling").model.column.housner_damping()


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_a_table_as_a_german_excel_writes_it_holds_the_same_objects(tmp_path, encoding):
    german = read_inventory(table(tmp_path, GERMAN.replace("\n", "\r\n"), "german.csv", encoding))
    assert numbers(german) == numbers(read_inventory(table(tmp_path, PLAIN)))


def test_a_workbook_holds_the_same_objects(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.title = "store"
    rows = [
        HEAD.split(","),
        ["amphora", 62.5, 0.5, 55, "2 %", 2100, "housner", 0.6, 12],
        ["jug, large", 80, None, 40, None, 2100, 0.05, 0.45, None],
    ]
    for row in rows:
        book.active.append(row)
    other = book.create_sheet("other")
    other.append(["name", "radius"])
    book.save(tmp_path / "objects.xlsx")
    plain = numbers(read_inventory(table(tmp_path, PLAIN)))
    with pytest.warns(UnlikelyInputWarning, match=r"only its first sheet is read \(others are 'other'\)"):
        assert numbers(read_inventory(tmp_path / "objects.xlsx")) == plain
    assert numbers(read_inventory(tmp_path / "objects.xlsx" / "store")) == plain
    with pytest.raises(FileError, match=r"no such sheet. Choose from store, other"):
        read_inventory(tmp_path / "objects.xlsx" / "stroe")


def test_diameters_are_halved_with_their_spread(tmp_path):
    text = (
        "name,diameter [mm],diameter_spread [mm],height,density,damping,friction_coefficient\na,200,4,1,2000,0.05,0.5\n"
    )
    (one,) = read_inventory(table(tmp_path, text))
    assert one.spreads == {"radius": NormalSpread(0.002)}
    prepared = one.prepared("wobbling")
    assert prepared.numbers["radius"] == 0.1
    assert prepared.draws(4000, 0)["radius"].std() == pytest.approx(0.002, rel=0.05)  # 4.5 standard errors


def test_bad_rows_are_all_listed_with_row_column_value_and_remedy(tmp_path):
    rows = [
        HEAD,
        "a,-62.5,0.5,55,2 %,2100,housner,0.6,12",
        "b,80,,x,,2100,0.05,0.45,",
        "",
        "c,80,,40,,2100,hausner,0.45,",
        "d,80,1 kg,40,,2100,0.05,0.45,",
        "e,80,,40,30,2100,0.05,0.45,",
        "f,80,,40,,2100,0.05,,",
        "g,62,5,,55,,2100,0.05,0.6,12,0",
        "h,80,,,,2100,0.05,0.45,",
    ]
    found = problems(table(tmp_path, "\n".join(rows)))
    expected = [
        "objects.csv, row 2, radius [mm]: radius must be positive, got -0.0625 m. Correct the cell.",
        "objects.csv, row 3, height [cm]: must be a number, with or without a unit, got 'x'. Correct the cell.",
        "objects.csv, row 5, damping: must be a number or 'housner', got 'hausner'. Correct the cell.",
        "objects.csv, row 6, radius_spread [mm]: must be in mm, cm, m, in or ft, got 1 kg",
        "objects.csv, row 7, height_spread: height_spread is relative and must be below 2, got '30'",
        "objects.csv, row 8, friction_coefficient: the cell is empty. Fill it, or state friction_coefficient",
        "objects.csv, row 9: 11 cells, but 9 headings. Write decimal points",
        "objects.csv, row 10, height [cm]: the cell is empty. Fill it, or state height in defaults",
    ]
    assert len(found) == len(expected), found
    for line, begin in zip(found, expected, strict=True):
        assert line.startswith(begin), (line, begin)


def test_a_model_that_slides_or_is_planar_is_refused(tmp_path):
    for kind in ("sliding", "planar_rocking", "wobling"):
        with pytest.raises(ParameterError, match="model: must be three-dimensional with permanent contact"):
            read_inventory(table(tmp_path, PLAIN), model=kind)


def test_a_heading_like_a_known_name_is_refused_and_carried_on_request(tmp_path):
    path = table(tmp_path, PLAIN.replace("room", "hieght"))
    (line,) = problems(path)
    assert line.startswith("objects.csv, heading 'hieght': unknown column; did you mean height? Rename it")
    assert read_inventory(path, carry=["hieght"])[0].carried == {"hieght": "12"}


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (
            ("radius [mm]", "radius [kg]"),
            "objects.csv, heading 'radius [kg]': must be in mm, cm, m, in or ft, got 1 kg",
        ),
        (("name", "name [m]"), "objects.csv, heading 'name [m]': holds words, which have no unit."),
        (
            ("room", "Radius (cm)"),
            "objects.csv: two columns hold radius (got 'radius [mm]', 'Radius (cm)'). Remove one, or name it in carry",
        ),
        (
            ("friction_coefficient", "comment"),
            "objects.csv: the column friction_coefficient is missing. Add it, or state",
        ),
        (
            ("damping,", "comment,"),
            "objects.csv: the column damping is missing. Write the word housner or a measured value, or state damping",
        ),
    ],
)
def test_wrong_headings_are_named(tmp_path, change, line):
    assert any(one.startswith(line) for one in problems(table(tmp_path, PLAIN.replace(*change, 1))))


def test_defaults_fill_missing_columns_and_empty_cells(tmp_path):
    path = table(tmp_path, PLAIN.replace("damping", "comment", 1).replace(",0.45,", ",,"))
    amphora, jug = read_inventory(path, defaults={"damping": "housner", "friction_coefficient": 0.3})
    assert amphora.model == jug.model == {"damping": "housner"}
    assert (amphora.friction_coefficient, jug.friction_coefficient) == (0.6, 0.3)
    assert any(
        "unknown (got 'dampin'); did you mean damping?" in one for one in problems(path, defaults={"dampin": 1.0})
    )


def test_a_decimal_comma_beside_points_is_refused(tmp_path):
    (line,) = problems(table(tmp_path, GERMAN.replace("80;", "80.5;")))
    assert "objects.csv, row 2, Radius [mm]: a decimal comma beside decimal points in other cells (got '62,5')" in line


def test_commas_of_a_column_are_decimal_beside_points_in_other_columns_unless_they_may_separate_thousands(tmp_path):
    mixed = read_inventory(
        table(tmp_path, GERMAN.replace("0,05", "0.05").replace("0,45", "0.45").replace("0,6", "0.6"))
    )
    assert numbers(mixed) == numbers(read_inventory(table(tmp_path, GERMAN)))
    (line,) = problems(table(tmp_path, GERMAN.replace("2100", "2,100").replace("0,05", "0.05")))
    assert "rows 2, 3, Density: a comma that is decimal or separates thousands (got '2,100')" in line


@pytest.mark.parametrize(
    ("text", "line"),
    [("", "the file is empty"), (HEAD, "the table has no rows"), ("# a remark\n", "no headings")],
)
def test_a_file_without_objects_is_refused(tmp_path, text, line):
    with pytest.raises(FileError, match=line):
        read_inventory(table(tmp_path, text))


def test_the_ranking_repeats_the_cells_of_the_table(tmp_path):
    found = inventory(read_inventory(table(tmp_path, PLAIN)), sample_record(), samples=2, progress=False)
    path = export_inventory(found, tmp_path / "ranking.csv")
    header, *rows = [line.split(",") for line in path.read_text("utf-8").splitlines()]
    assert header[:2] == ["rank", "name"]
    assert header[-1] == "room"
    assert {row[1].strip('"') for row in rows} == {"amphora", "jug"}
    assert next(row for row in rows if row[1] == "amphora")[-1] == "12"
    openpyxl = pytest.importorskip("openpyxl")
    export_inventory(found, tmp_path / "ranking.xlsx")
    book = openpyxl.load_workbook(tmp_path / "ranking.xlsx")
    assert book.sheetnames == ["ranking", "settings"]
    assert [cell.value for cell in book["ranking"][1]][:3] == ["rank", "name", "site"]


def test_a_ranking_is_written_in_known_formats_only(tmp_path):
    found = inventory(read_inventory(table(tmp_path, PLAIN)), sample_record(), samples=1, progress=False)
    with pytest.raises(ParameterError, match=r"path: must end with \.csv, \.xlsx, \.gpkg"):
        export_inventory(found, tmp_path / "ranking.pdf")
    with pytest.raises(ParameterError, match="found: must come from inventory"):
        export_inventory({}, tmp_path / "ranking.csv")


POINTS = [b"\x01\x01\x00\x00\x00" + np.array([22.0 + place, 38.0]).tobytes() for place in range(2)]


def geopackage(path):
    """Write two objects with GDAL, which is skipped without it."""
    raw = pytest.importorskip("pyogrio.raw")
    fields = {
        "name": np.array(["amphora", "jug"], dtype=object),
        "radius": np.array([0.0625, 0.08]),
        "height": np.array([0.55, 0.4]),
        "density": np.array([2100.0, 2100.0]),
        "damping": np.array([0.05, 0.05]),
        "friction_coefficient": np.array([0.6, 0.45]),
        "room": np.array([12, 7]),
    }
    raw.write(
        path,
        geometry=np.array(POINTS, dtype=object),
        field_data=list(fields.values()),
        fields=np.array(list(fields), dtype=object),
        geometry_type="Point",
        crs="EPSG:4326",
        driver="GPKG",
    )
    return raw


def test_a_geopackage_carries_its_geometry_through(tmp_path):
    path = tmp_path / "objects.gpkg"
    raw, points = geopackage(path), POINTS
    objects = read_inventory(path)
    assert [(one.column["radius"], one.carried) for one in objects] == [(0.0625, {"room": "12"}), (0.08, {"room": "7"})]
    assert [one.geometry for one in objects] == points
    found = inventory(objects, sample_record(), progress=False)
    export_inventory(found, tmp_path / "ranking.gpkg")
    meta, _, geometry, columns = raw.read(tmp_path / "ranking.gpkg")
    assert meta["crs"] == "EPSG:4326"
    own = dict(zip(meta["fields"], columns, strict=True))
    assert own["tilt median"].dtype == np.float64
    assert (
        own["probability of overturning"].tolist()
        == found["probability"].sel(limit_state="overturning", scale=1.0).to_numpy().tolist()
    )
    assert set(own["room"]) == {"12", "7"}
    by_name = dict(zip(columns[list(meta["fields"]).index("name")], geometry, strict=True))
    assert by_name == {"amphora": points[0], "jug": points[1]}


def test_without_its_package_a_geopackage_is_read_and_its_writing_refused_in_one_line(tmp_path, monkeypatch):
    path = tmp_path / "objects.gpkg"
    geopackage(path)
    monkeypatch.setitem(sys.modules, "pyogrio", None)
    monkeypatch.setitem(sys.modules, "pyogrio.raw", None)
    objects = read_inventory(path)
    assert len(objects) == 2
    found = inventory(objects, sample_record(), samples=1, progress=False)
    with pytest.raises(UnsupportedError, match=r"a GeoPackage is written by pyogrio: pip install .stylobate\[geo\]."):
        export_inventory(found, tmp_path / "ranking.gpkg")


def test_the_rows_of_a_geopackage_are_those_that_gdal_reads(tmp_path):
    raw = pytest.importorskip("pyogrio.raw")
    path = tmp_path / "objects.gpkg"
    geopackage(path)
    meta, _, geometry, columns = raw.read(path)
    layer = read_layer(path)
    assert (layer.crs, list(layer.headings)) == (meta["crs"], list(meta["fields"]))
    assert [shape for shape, _ in layer.rows] == list(geometry)
    by_gdal = [tuple(str(cell) for cell in row) for row in zip(*(column.tolist() for column in columns), strict=True)]
    assert [cells for _, cells in layer.rows] == by_gdal
    assert read_layer(path / "objects") == layer
    with pytest.raises(FileError, match=r"objects\.gpkg.other: no such layer\. Choose from objects\."):
        read_layer(path / "other")


def test_what_is_no_geopackage_or_is_open_elsewhere_is_refused_in_one_line(tmp_path):
    path = tmp_path / "objects.gpkg"
    geopackage(path)
    content = path.read_bytes()
    for other in (b"", b"anything else", b"<also>this</also>", content[:68] + b"\0\0\0\0" + content[72:]):
        path.write_bytes(other)
        with pytest.raises(FileError, match=r"objects\.gpkg: no GeoPackage: it begins otherwise\."):
            read_layer(path)
    path.write_bytes(content[:3000])
    with pytest.raises(FileError, match=r"objects\.gpkg: cannot be read \(database disk image is malformed\)"):
        read_layer(path)
    path.write_bytes(content)
    (tmp_path / "objects.gpkg-wal").write_bytes(b"changes")
    with pytest.raises(FileError, match=r"objects\.gpkg: open in another program, which keeps changes in objects"):
        read_layer(path)
