"""Files that belong to one event are joined; files of different events never are."""

from itertools import permutations

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import RecordsConfig
from stylobate.config.parts import describe_motion
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning
from stylobate.records.directions import Direction

COUNT = 50
WAVES = np.random.default_rng(11).normal(scale=0.2, size=(4, COUNT))

# Names as databases and people write them: two horizontal components, and perhaps a vertical one.
SETS = [
    ("RSN753_LOMAP_CLS000.AT2", "RSN753_LOMAP_CLS090.AT2", "RSN753_LOMAP_CLS-UP.AT2"),
    ("RSN786_LOMAP_PAE055.AT2", "RSN786_LOMAP_PAE325.AT2", "RSN786_LOMAP_PAE-UP.AT2"),
    ("RSN143_TABAS_TAB-L1.AT2", "RSN143_TABAS_TAB-T1.AT2", "RSN143_TABAS_TAB-UP.AT2"),
    ("RSN4040_BAM_BAM-L.AT2", "RSN4040_BAM_BAM-T.AT2", "RSN4040_BAM_BAM-V.AT2"),
    ("RSN4863_CHUETSU_65036EW.AT2", "RSN4863_CHUETSU_65036NS.AT2", "RSN4863_CHUETSU_65036UD.AT2"),
    ("RSN4209_NIIGATA_NIG017EW.AT2", "RSN4209_NIIGATA_NIG017NS.AT2", "RSN4209_NIIGATA_NIG017UD.AT2"),
    ("RSN5618_IWATE_IWT010EW.AT2", "RSN5618_IWATE_IWT010NS.AT2", "RSN5618_IWATE_IWT010UD.AT2"),
    ("RSN6962_DARFIELD_ROLCS29E.AT2", "RSN6962_DARFIELD_ROLCS61W.AT2", "RSN6962_DARFIELD_ROLCUP.AT2"),
    ("RSN8063_CCHURCH_CMHSN10E.AT2", "RSN8063_CCHURCH_CMHSS80E.AT2", "RSN8063_CCHURCH_CMHSUP.AT2"),
    ("RSN6953_DARFIELD_PRPCS.AT2", "RSN6953_DARFIELD_PRPCW.AT2", "RSN6953_DARFIELD_PRPCUP.AT2"),
    ("RSN4480_L-AQUILA_CU104XTE.AT2", "RSN4480_L-AQUILA_CU104YLN.AT2", "RSN4480_L-AQUILA_CU104ZUP.AT2"),
    ("RSN88_SFERN_FSD172.AT2", "RSN88_SFERN_FSD262.AT2", "RSN88_SFERN_FSDDWN.AT2"),
    ("RSN3548_LOMAP_BSO000.AT2", "RSN3548_LOMAP_BSO090.AT2", "RSN3548_LOMAP_BSOUP.AT2"),
    ("RSN57_SFERN_PUL164.AT2", "RSN57_SFERN_PUL254.AT2", "RSN57_SFERN_PULDWN.AT2"),
    ("RSN1193_CHICHI_CHY024-E.AT2", "RSN1193_CHICHI_CHY024-N.AT2", "RSN1193_CHICHI_CHY024-V.AT2"),
    ("RSN1492_CHICHI_TCU052-E.AT2", "RSN1492_CHICHI_TCU052-N.AT2", "RSN1492_CHICHI_TCU052-V.AT2"),
    ("RSN180_IMPVALL.H_H-E05140.AT2", "RSN180_IMPVALL.H_H-E05230.AT2", "RSN180_IMPVALL.H_H-E05-UP.AT2"),
    ("RSN4107_PARK2004_COW090.AT2", "RSN4107_PARK2004_COW360.AT2", "RSN4107_PARK2004_COW-UP.AT2"),
    ("RSN779_LOMAP_LGP000_scaled.AT2", "RSN779_LOMAP_LGP090_scaled.AT2"),
    ("NGA_no_1106_KJM000.AT2", "NGA_no_1106_KJM090.AT2", "NGA_no_1106_KJM-UP.AT2"),
    ("BSO000.txt", "BSO090.txt", "BSOUP.txt"),
    ("PUL164.dat", "PUL254.dat", "PULDWN.dat"),
    ("TAB-L1.txt", "TAB-T1.txt", "TAB-UP.txt"),
    ("NIG017EW.txt", "NIG017NS.txt", "NIG017UD.txt"),
    ("nig017ew.txt", "nig017ns.txt", "nig017ud.txt"),
    ("ROLCS29E.txt", "ROLCS61W.txt", "ROLCUP.txt"),
    ("CMHSN10E.csv", "CMHSS80E.csv"),
    ("CU104XTE.txt", "CU104YLN.txt", "CU104ZUP.txt"),
    ("PAE055.AT2.txt", "PAE325.AT2.txt"),
    ("PAE055_scaled.txt", "PAE325_scaled.txt"),
    ("quake_H1.txt", "quake_H2.txt", "quake_V.txt"),
    ("quake_x.txt", "quake_y.txt", "quake_z.txt"),
    ("quake_L.txt", "quake_T.txt", "quake_V.txt"),
    ("quake_R.txt", "quake_T.txt", "quake_Z.txt"),
    ("RSN1_A-FN.AT2", "RSN1_A-FP.AT2", "RSN1_A-UP.AT2"),
    ("quake-FN.txt", "quake-FP.txt"),
    ("quake6_HNE.txt", "quake6_HNN.txt", "quake6_HNZ.txt"),
    ("CI.PAS.00.HN1.txt", "CI.PAS.00.HN2.txt", "CI.PAS.00.HNZ.txt"),
    ("IT.ACC..HGE.D.20160824.X.MP.ASC", "IT.ACC..HGN.D.20160824.X.MP.ASC", "IT.ACC..HGZ.D.20160824.X.MP.ASC"),
    ("NS_quake.txt", "EW_quake.txt", "UD_quake.txt"),
    ("elcentro_1940_NS.dat", "elcentro_1940_EW.dat", "elcentro_1940_UP.dat"),
    ("pacoima_S16E.txt", "pacoima_S74W.txt", "pacoima_DOWN.txt"),
    ("site N-S.txt", "site E-W.txt", "site U-D.txt"),
    ("AKT0239608110312.EW", "AKT0239608110312.NS", "AKT0239608110312.UD"),
    ("IWTH011805180312.EW2", "IWTH011805180312.NS2", "IWTH011805180312.UD2"),
    ("E.txt", "N.txt", "Z.txt"),
]
APART = [
    ("RSN1_A000.AT2", "RSN2_A090.AT2"),
    ("a_NS.txt", "b_EW.txt"),
    ("CHY024-E.txt", "CHY025-N.txt"),
    ("TCU052-E.txt", "TCU052b-N.txt"),
    ("quake_20160117.txt", "quake_20160207.txt"),
    ("AKT0239608110312.EW", "AKT0239608110745.NS"),
    ("IWTH011805180312.EW1", "IWTH011805180312.NS2"),
    ("stationE.txt", "stationN.txt"),
    ("pulse.txt", "pulsn.txt"),
    ("group.txt", "grons.txt"),
    ("PAE055.txt", "PAE325_scaled.txt"),
    ("quake_1.txt", "quake_2.txt"),
    ("HNE_1.txt", "HNN_2.txt"),
    ("IT.ACC..HGE.D.20160824.txt", "IT.ACC..HGN.D.20161030.txt"),
    ("TAB-L1.txt", "TAC-T1.txt"),
    ("quake_050.txt", "quake_100.txt"),
    ("P100.txt", "P200.txt"),
    ("quake001.txt", "quake010.txt"),
    ("RSN753_LOMAP_CLS000.AT2", "RSN753_LOMAP_CLS090_scaled.AT2"),
    ("RSN753_LOMAP_CLS000_raw.AT2", "RSN753_LOMAP_CLS090_SCALED.AT2"),
]


def at2(path, values, title):
    lines = [
        "PEER",
        title,
        "ACCELERATION IN UNITS OF G",
        f"NPTS= {len(values)}, DT= 0.01 SEC",
        *map(repr, values.tolist()),
    ]
    path.write_text("\n".join(lines))


def table(path, values):
    path.write_text("\n".join(map(repr, values.tolist())))


def written(folder, names, waves=WAVES):
    for name, values in zip(names, waves, strict=False):
        table(folder / name, values)
    return [folder / name for name in names]


def read(source, **options):
    return sb.read_records(source, "m/s2", step=0.01, **options)


by_digits_alone = pytest.mark.filterwarnings(
    "ignore:.*numbers in their names look like:stylobate.errors.UnlikelyInputWarning"
)


@by_digits_alone
@pytest.mark.parametrize("names", SETS, ids=lambda names: names[0])
def test_components_of_one_event_are_one_record_of_two_horizontal_axes_and_a_vertical_one(tmp_path, names):
    written(tmp_path, names)
    (record,) = read(tmp_path)
    assert record.axes == ("x", "y", "z")[: len(names)]
    # the component of a vertical name is the vertical component, turned where it points down
    if len(names) > 2:
        sign = -1.0 if any(word in names[2] for word in ("DWN", "DOWN")) else 1.0
        np.testing.assert_array_equal(record.samples[:, 2], sign * WAVES[2])
    # perpendicular components keep the horizontal energy, whatever the axes are called
    np.testing.assert_allclose(
        np.hypot(*record.samples[:, :2].T), np.hypot(*WAVES[:2]), rtol=1e-12, err_msg=record.provenance[-1]
    )


@by_digits_alone
@pytest.mark.parametrize("names", SETS, ids=lambda names: names[0])
def test_copies_in_two_folders_are_two_records(tmp_path, names):
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        written(tmp_path / folder, names)
    both = [tmp_path / "first" / name for name in names] + [tmp_path / "second" / name for name in names]
    assert [len(record.axes) for record in read(both)] == [len(names)] * 2


def test_every_event_of_a_full_folder_is_found(tmp_path):
    numbered = [names for names in SETS if names[0].startswith(("RSN", "NGA"))]
    plain = [names for names in SETS if names[0].split(".")[0] in ("CMHSN10E", "TAB-L1", "quake6_HNE", "NS_quake")]
    for names in numbered + plain:
        written(tmp_path, names)
    found = read(tmp_path)
    assert len(found) == len(numbered) + len(plain)
    assert sorted(len(record.axes) for record in found) == sorted(map(len, numbered + plain))


@by_digits_alone
@pytest.mark.parametrize("names", SETS, ids=lambda names: names[0])
def test_a_described_event_is_built_again_from_its_files(tmp_path, names):
    written(tmp_path, names)
    (described,) = RecordsConfig(source=str(tmp_path), units="m/s2", step=0.01).build().values()
    (record,) = read(tmp_path)
    assert described == record
    for one in (described, record):
        again = describe_motion(one).build()
        assert (again, again.name, again.provenance) == (record, record.name, record.provenance)


@pytest.mark.parametrize("names", APART, ids=lambda names: names[0])
def test_names_of_different_events_are_not_joined(tmp_path, names):
    written(tmp_path, names)
    with pytest.warns(UnlikelyInputWarning):
        assert len(read(tmp_path)) == 2
    found = read(tmp_path, one_component=True)
    assert len({record.name for record in found}) == 2
    described = RecordsConfig(source=str(tmp_path), units="m/s2", step=0.01, one_component=True).build().values()
    for records in (found, described):
        assert [(one.name, one.provenance) for one in (describe_motion(record).build() for record in records)] == [
            (record.name, record.provenance) for record in found
        ]


@pytest.mark.parametrize(
    "names", [("quake001.txt", "quake091.txt"), ("TH001.txt", "TH090.txt"), ("PAE055_scaled.txt", "PAE325_scaled.txt")]
)
def test_digits_of_names_alone_join_perpendicular_pairs_only_and_not_in_silence(tmp_path, names):
    paths = written(tmp_path, names)
    with pytest.warns(
        UnlikelyInputWarning, match=r"numbers in their names look like .*State their directions, or list the"
    ):
        (record,) = read(tmp_path, one_component=True)
    assert record.axes == ("x", "y")
    # directions and lists say so, and are not remarked on; so does a third file that more than digits name
    assert read([paths]) == (record,)
    assert read(tmp_path, directions={names[0]: int(names[0][-7:-4]) if "_" not in names[0] else 55.0}) == (record,)
    assert [one.axes for one in read([[path] for path in paths], one_component=True)] == [("x",)] * 2
    written(tmp_path, [names[0].replace("001", "UP").replace("055", "UP")], WAVES[2:])
    assert [one.axes for one in read(tmp_path)] == [("x", "y", "z")]
    written(tmp_path, [names[0].replace("001", "002").replace("055", "054")])
    with pytest.raises(FileError, match="two horizontal components and a vertical one at most"):
        read(tmp_path)


def test_shocks_of_one_day_at_one_station_are_apart_by_what_their_names_say_before_the_direction(tmp_path):
    for name, way, values in zip(("A-CVK090", "B-CVK180"), ("90", "180"), WAVES, strict=False):
        at2(tmp_path / f"{name}.AT2", values, f"Chalfant, 7/21/1986, Convict Creek, {way}")
    assert [(one.name, one.axes) for one in sb.read_records(tmp_path, one_component=True)] == [
        ("A-CVK", ("x",)),
        ("B-CVK", ("x",)),
    ]


def test_one_number_in_two_folders_joins_only_what_one_title_joins(tmp_path):
    paths = [tmp_path / folder / f"RSN1_A{way}.AT2" for folder, way in (("east", "090"), ("north", "000"))]
    for title, axes in (("Quake", ("x",)), ("Some Quake, 1/2/1990, Site, {}", ("x", "y"))):
        for path in paths:
            path.parent.mkdir(exist_ok=True)
            at2(path, WAVES[0], title.format(path.stem[-3:]))
        assert {one.axes for one in sb.read_records(paths, one_component=True)} == {axes}


@pytest.mark.parametrize(("names", "azimuths"), [
    (("q_N10E.txt", "q_S80E.txt"), (10.0, 100.0)),
    (("ROLCS29E.txt", "ROLCS61W.txt"), (151.0, 241.0)),
    (("q_N20W.txt", "q_N70E.txt"), (340.0, 70.0)),
    (("NIG017EW.txt", "NIG017NS.txt"), (90.0, 0.0)),
    (("q_HNE.txt", "q_HNN.txt"), (90.0, 0.0)),
])  # fmt: skip
def test_a_name_is_the_azimuth_it_spells(tmp_path, names, azimuths):
    paths = written(tmp_path, names)
    directions = {path.name: azimuth for path, azimuth in zip(paths, azimuths, strict=True)}
    assert read(tmp_path) == read(paths, directions=directions)


def test_order_of_files_changes_no_record(tmp_path):
    paths = written(tmp_path, ("TAB-L1.txt", "TAB-T1.txt", "TAB-UP.txt"))
    (expected,) = read(paths)
    for some in permutations(paths):
        assert read(some) == (expected,)
    np.testing.assert_array_equal(expected.samples, WAVES[:3].T)
    assert "y from TAB-T1.txt (second of two perpendicular axes, azimuth unknown)" in expected.provenance[-1]


def test_a_header_joins_files_of_one_name_and_its_date_and_station_keep_others_apart(tmp_path):
    title = "Some Quake, 1/2/1990, {}, {}"
    for name, values, station, way in (
        ("oneX", WAVES[0], "Site A", "N10E"),
        ("oneY", WAVES[1], "Site A", "S80E"),
        ("oneZ", WAVES[2], "Site A", "DOWN"),
        ("q000", WAVES[0], "Site B", "0"),
        ("q090", WAVES[1], "Site C", "90"),
    ):
        at2(tmp_path / f"{name}.AT2", values, title.format(station, way))
    pair, first, second = sorted(sb.read_records(tmp_path, one_component=True), key=lambda record: -len(record.axes))
    assert (pair.axes, first.axes, second.axes) == (("x", "y", "z"), ("x",), ("x",))
    np.testing.assert_allclose(pair.samples, WAVES[:3].T * [1, -1, -1] * 9.80665, rtol=1e-12)


def test_a_header_without_a_date_joins_nothing(tmp_path):
    for name, values, way in (("one", WAVES[0], "0"), ("two", WAVES[1], "90")):
        at2(tmp_path / f"{name}.AT2", values, f"Synthetic record, {way}")
    assert len(sb.read_records(tmp_path, one_component=True)) == 2


def test_a_header_shows_that_digits_of_a_name_are_no_azimuth(tmp_path):
    for name, way in (("quake117", "N"), ("quake207", "N")):
        at2(tmp_path / f"{name}.AT2", WAVES[0], f"Synthetic record, {way}")
    assert [record.name for record in sb.read_records(tmp_path, one_component=True)] == ["quake117", "quake207"]


def test_copies_of_one_event_are_several_records(tmp_path):
    names = [f"RSN1_A_{way}{copy}.AT2" for copy in ("", "_scaled") for way in ("000", "090")]
    for name, values in zip(names, WAVES, strict=True):
        at2(tmp_path / name, values, f"Some Quake, 1/2/1990, Site, {name[7:10]}")
    assert [(record.name, record.axes) for record in sb.read_records(tmp_path)] == [
        ("RSN1_A", ("x", "y")),
        ("RSN1_A_scaled", ("x", "y")),
    ]


@pytest.mark.parametrize(
    "names", [("a_000.txt", "a_045.txt", "a_NS.txt"), ("RSN1_A000.txt", "RSN1_A090.txt", "RSN1_B045.txt")]
)
def test_three_horizontal_components_of_one_event_are_an_error_of_one_line(tmp_path, names):
    written(tmp_path, names)
    with pytest.raises(
        FileError, match=r"two horizontal components and a vertical one at most, got .*list the files"
    ) as caught:
        read(tmp_path)
    assert "\n" not in str(caught.value)


def test_one_number_of_several_stations_is_an_error(tmp_path):
    for way, station in (("000", "A"), ("090", "B")):
        at2(tmp_path / f"RSN1_A{way}.AT2", WAVES[0], f"Some Quake, 1/2/1990, {station}, {way}")
    with pytest.raises(FileError, match="the headers name different events or stations"):
        sb.read_records(tmp_path)
    with pytest.warns(UnlikelyInputWarning, match="the headers name different events or stations"):
        assert len(sb.read_records([list(tmp_path.glob("*.AT2"))])) == 1


def test_what_the_user_lists_as_one_event_is_one(tmp_path):
    first, second, other = written(tmp_path, ("first_000.txt", "second_090.txt", "other_NS.txt"))
    (expected, alone) = read([[first, second], other], one_component=True)
    assert (expected.axes, alone.name) == (("x", "y"), "other")
    assert read({"mine": [first, second]}) == (expected,)
    assert read({"mine": [first, second]})[0].name == "mine"
    assert read([tmp_path, [first, second]], one_component=True) == (expected, alone)
    renamed = written(tmp_path, ("left.txt", "right.txt"))
    directions = {"left.txt": 0, "right.txt": "E"}
    assert read(renamed, directions=directions) == (expected,)
    assert read([renamed], directions=directions) == (expected,)
    # four files are of two events: their names tell which
    pairs = [*renamed, *written(tmp_path, ("q_NS.txt", "q_EW.txt"))]
    assert len(read(pairs, directions={**directions, "q_NS.txt": 0, "q_EW.txt": 90}, one_component=True)) == 3


def test_patterns_and_folders_are_read_alone_and_in_lists(tmp_path):
    written(tmp_path, ("a_NS.txt", "a_EW.txt", "b_NS.txt", "b_EW.txt"))
    expected = read(tmp_path)
    assert len(expected) == 2
    for source in (
        f"{tmp_path}/*.txt",
        [f"{tmp_path}/a*.txt", f"{tmp_path}/b_?[SW].txt"],
        [tmp_path, tmp_path / "a_NS.txt"],
        [[f"{tmp_path}/a*"], f"{tmp_path}/b*"],
    ):
        assert read(source) == expected
    with pytest.raises(FileError, match=r"c\*: no file has such a name"):
        read([f"{tmp_path}/a*", f"{tmp_path}/c*"])


def test_of_a_peer_download_the_accelerations_are_read(tmp_path):
    for name, values in zip(("RSN1_A000", "RSN1_A090"), WAVES, strict=False):
        at2(tmp_path / f"{name}.AT2", values, "Some Quake, 1/2/1990, Site")
        (tmp_path / f"{name}.VT2").write_text("VELOCITY")
        (tmp_path / f"{name}.DT2").write_text("DISPLACEMENT")
    (tmp_path / "_SearchResults.csv").write_text("Summary of PEER Ground Motion Search Results")
    assert [record.axes for record in sb.read_records(tmp_path)] == [("x", "y")]


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("a_NS.txt", WAVES[0], "a: one horizontal component"),
        ("a_UP.txt", WAVES[0], "a: a vertical component and no horizontal one"),
        ("plain.txt", WAVES[0], "plain: one horizontal component"),
        ("zero.txt", 0.0 * WAVES[0], "zero: all accelerations are zero"),
    ],
)
def test_a_component_alone_is_remarked_on_unless_it_is_asked_for(tmp_path, name, values, told):
    (path,) = written(tmp_path, (name,), [values])
    with pytest.warns(UnlikelyInputWarning, match=told):
        read(path)
    (record,) = read(path, one_component=True)
    assert ("z" in record.axes) == ("UP" in name)


def test_names_that_spell_no_direction_are_none():
    for text in ("Corralitos", "S200E", "361", "NE", "HNX", "", "L3", "quake"):
        assert Direction.parse(text) is None


@pytest.mark.parametrize("header", ["Zeit,{},{},{}", "time [s],acc_{} [m/s²],acc_{} [m/s²],acc_{} [m/s²]"])
@pytest.mark.parametrize(
    "names", [("NS", "EW", "UD"), ("N10E", "S80E", "DOWN"), ("H1", "H2", "V"), ("HNN", "HNE", "HNZ")]
)
def test_columns_of_one_table_are_components_as_files_of_these_names_are(tmp_path, header, names):
    lines = [f"{0.01 * i:.2f},{','.join(map(repr, row))}" for i, row in enumerate(WAVES[:3].T.tolist())]
    (tmp_path / "both.csv").write_text("\n".join([header.format(*names), *lines]))
    (tmp_path / "files").mkdir()
    written(tmp_path / "files", [f"both_{name}.txt" for name in names])
    (expected,) = read(tmp_path / "files")
    (found,) = sb.read_records(tmp_path / "both.csv", None if "[" in header else "m/s2")
    np.testing.assert_array_equal(found.samples, expected.samples)
    assert names[0] in found.provenance[0]


def test_a_table_of_a_vertical_column_alone_is_vertical(tmp_path):
    (tmp_path / "both.csv").write_text("time [s],UD [g]\n0.0,0.0\n0.01,0.1\n")
    with pytest.warns(UnlikelyInputWarning, match="a vertical component and no horizontal one"):
        (record,) = sb.read_records(tmp_path)
    assert record.axes == ("z",)


@pytest.mark.parametrize("source", [5, None, {"a": 5}, {"a": [5]}, [5], [[None]]])
def test_a_source_that_is_no_path_is_refused_in_one_line(source):
    with pytest.raises(ParameterError, match=r"^source: must be a path[^\n]* \(got (5|None)\)\. Give [^\n]*$"):
        sb.read_records(source)
    with pytest.raises(ParameterError, match=r"^path: must be a path \(got 5\)\. Give [^\n]*$"):
        sb.read_record(5, "g")


@pytest.mark.parametrize("directions", [{"q.csv": None}, {"q.csv": [90.0]}, {"q.csv": {}}, [90.0], 90.0])
def test_directions_that_are_none_are_refused_in_one_line(tmp_path, directions):
    (tmp_path / "q.csv").write_text("t,a [g]\n0,0.1\n0.01,0.2\n")
    with pytest.raises(ParameterError, match=r"^(a direction must be|directions: must be by name)[^\n]*$"):
        sb.read_records(tmp_path / "q.csv", directions=directions)
