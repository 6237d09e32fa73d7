"""What is read of a file: first bytes decide, no library is asked for others; limits for all that unpacks."""

import gzip
import importlib.metadata
import io
import re
import socket
import tarfile
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import read_inventory
from stylobate.errors import FileError, UnsupportedError, require_extra
from stylobate.records import containers, contents, reading
from stylobate.records.containers import members
from stylobate.records.contents import Allowance, read_bytes
from stylobate.records.waveforms import FORMATS

pytestmark = pytest.mark.filterwarnings("ignore:.*one horizontal component")

# Made-up contents of kinds that no reader is for, behind first bytes of several lengths.
OTHERS = (
    bytes(range(64)),
    b"\x7fMADE UP\0\1\2\3" + bytes(700),
    b"\xc0\xde\xca\xfe" * 300,
    b"any text without a number\nand another line\n",
    b"<made><up/></made>\n",
    b'{"made": "up"}\n',
    b"\x01" + b"text behind a byte of another kind\n" * 90,
    np.random.default_rng(8).bytes(4000),
)


def zipped(files):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return packed.getvalue()


def plugins():
    """Yield the modules and functions by which ObsPy recognizes and reads waveforms and stations."""
    for kind in ("waveform", "inventory"):
        for one in importlib.metadata.entry_points(group=f"obspy.plugin.{kind}"):
            for entry in importlib.metadata.entry_points(group=f"obspy.plugin.{kind}.{one.name}"):
                if entry.name in ("isFormat", "readFormat"):
                    yield entry.module, entry.attr


@pytest.fixture
def called(monkeypatch):
    """Return the list of calls of libraries that read files, each of which is refused."""
    calls = []

    def watch(module, name):
        def spy(*_, **__):
            calls.append(f"{module}.{name}")
            raise RuntimeError("a library was asked")

        try:
            monkeypatch.setattr(require_extra(module, ""), name, spy)
        except UnsupportedError:  # an extra, or a library of one of ObsPy's plugins, that is not installed
            return

    for module, name in plugins():
        watch(module, name)
    for place in (
        *("obspy.read", "obspy.read_inventory", "obspy.core.stream.read", "obspy.core.util.base._read_from_plugin"),
        *("openpyxl.load_workbook", "pyogrio.raw.read", "pyogrio.raw.ogr_read", "h5py.File", "numpy.load"),
        *("pickle.load", "pickle.loads", "sqlite3.connect", "tarfile.open", "lxml.etree.parse"),
    ):
        watch(*place.rsplit(".", maxsplit=1))
    monkeypatch.setattr(socket.socket, "connect", lambda *_: calls.append("connect"))
    return calls


def test_content_of_an_unlisted_kind_reaches_no_library(tmp_path, called):
    pytest.importorskip("obspy")
    counts = tmp_path / "counts.mseed"
    counts.write_bytes(b"000001D " + bytes(100))
    for place, content in enumerate(OTHERS):
        for name in ("a.mseed", "a.gpkg", "a.csv", "a.nc", "a.dat", "a.xlsx"):
            path = tmp_path / f"{place}{name}"
            path.write_bytes(content)
            for packed in (content, gzip.compress(content), zipped({"b.sac": content})):
                path.write_bytes(packed)
                for read in (lambda one: sb.read_records(one, "g"), read_inventory, sb.load):
                    with pytest.raises(sb.errors.StylobateError):
                        read(path)
            with pytest.raises(FileError, match="no StationXML"):
                reading.read_waveform(counts, counts.read_bytes(), path)
    assert called == []


def test_content_of_a_listed_kind_reaches_the_one_reader_of_its_format(tmp_path, called):
    pytest.importorskip("obspy")
    version = bytearray(700)
    version[304:308] = (6).to_bytes(4, "little")
    listed = {
        "miniSEED": b"000001D " + bytes(100),
        "SAC": bytes(version),
        "Kinemetrics EVT": b"K\0" + bytes(100),
        "K-NET": b"Origin Time 2020/01/01\n",
        "GSE2": b"WID2 2020/01/01\n",
        "GSE1": b"XW01 2020/01/01\n",
        "SLIST": b"TIMESERIES A_B_C_D_E, 6 samples, 100 sps, 2020-01-01T00:00:00, SLIST, FLOAT, G\n",
        "TSPAIR": b"TIMESERIES A_B_C_D_E, 6 samples, 100 sps, 2020-01-01T00:00:00, TSPAIR, FLOAT, G\n",
    }
    assert list(listed) == [one.name for one in FORMATS]
    for form in FORMATS:
        path = tmp_path / "a.dat"
        path.write_bytes(listed[form.name])
        with pytest.raises(FileError, match=f"ObsPy cannot read it as {form.name}: its content is damaged"):
            sb.read_records(path, "g")
        assert called == [f"{form.module}.{form.function}"]
        called.clear()


# Limits


class Endless(io.RawIOBase):
    """A stream of one byte without end, which counts what was taken of it."""

    def __init__(self, byte):
        self.byte, self.taken = byte, 0

    def read(self, size):
        self.taken += size
        return self.byte * size


def test_a_stream_is_unpacked_up_to_its_limit_only(tmp_path):
    stream = Endless(b"\0")
    with pytest.raises(FileError, match=r"a\.gz: unpacks to more than 1 GiB, with all that lies in it\. Unpack the f"):
        Allowance(size=3_000_000).read(tmp_path / "a.gz", stream)
    assert stream.taken < 6_000_000


def test_a_text_that_unpacks_to_more_than_a_record_has_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(contents, "LONGEST_TEXT", 3 << 20)
    stream = Endless(b"1")
    message = r"a\.gz: a text of more than 3 MiB\. Cut it to the record, or save it in a binary format such as miniSEED"
    with pytest.raises(FileError, match=message):
        Allowance().read(tmp_path / "a.gz", stream)
    assert stream.taken <= 4 << 20
    packed = gzip.compress(b"0.1\n" * (1 << 20))
    for name, content in {
        "a.gz": packed,
        "a.zip": zipped({"a.txt": b"0.1\n" * (1 << 20)}),
        "b.zip": zipped({"a.gz": packed}),
    }.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(FileError, match="a text of more than 3 MiB"):
            sb.read_record(tmp_path / name, "g", step=0.01)


@pytest.mark.parametrize("pack", [gzip.compress, lambda content: zipped({"inner": content})])
def test_sizes_count_at_each_level_of_nesting(tmp_path, monkeypatch, pack):
    text = b"0.1\n0.2\n" * 500
    nested = zipped({"a.gz": pack(text)})
    (tmp_path / "a.zip").write_bytes(nested)
    inner = len(pack(text)) + len(text)
    for size, fits in ((inner, True), (inner - 1, False)):
        monkeypatch.setattr(reading, "Allowance", lambda size=size: Allowance(size=size))
        if fits:
            sb.read_record(tmp_path / "a.zip", "g", step=0.01)
            continue
        with pytest.raises(FileError, match="unpacks to more than 1 GiB"):
            sb.read_record(tmp_path / "a.zip", "g", step=0.01)


def test_many_files_and_deep_nesting_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(reading, "Allowance", lambda: Allowance(files=20, depth=3))
    path = tmp_path / "a.zip"
    path.write_bytes(zipped({f"{place}.txt": b"" for place in range(21)}))
    with pytest.raises(FileError, match=r"a\.zip: more than 20000 files, with those of archives in it\. Unpack the f"):
        sb.read_records(path, "g")
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as archive:
        for place in range(21):
            archive.addfile(tarfile.TarInfo(f"{place}.txt"))
    path.write_bytes(packed.getvalue())
    with pytest.raises(FileError, match="more than 20000 files"):
        sb.read_records(path, "g")
    content = b"0.1\n0.2\n"
    for _ in range(3):
        content = zipped({"a": content})
    path.write_bytes(content)
    assert len(sb.read_records(path, "g", step=0.01)) == 1
    path.write_bytes(zipped({"a": content}))
    with pytest.raises(FileError, match=r"more than 8 archives in each other\. Unpack the outer ones"):
        sb.read_records(path, "g", step=0.01)


@pytest.mark.parametrize("end", [b"\n", b"\r", b"\r\n"])
def test_a_line_longer_than_those_of_tables_is_refused_at_once(tmp_path, end):
    path = tmp_path / "a.txt"
    numbers = b"0.1 " * (contents.LONGEST_LINE // 4 - 1)
    path.write_bytes(end.join([b"0.1", numbers, b"0.1"]))
    with pytest.raises(FileError, match=r"line 2: \d+ columns"):
        sb.read_record(path, "g", step=0.01)
    path.write_bytes(end.join([b"0.1", numbers + b" 0.1 0.1", b"0.1"]))
    message = r"a\.txt: a line of more than 64 KiB\. Write one sample, or a few, on each line"
    with pytest.raises(FileError, match=message):
        sb.read_record(path, "g", step=0.01)


def test_no_line_takes_long(tmp_path):
    path = tmp_path / "a.txt"
    lines = [word * (16000 // len(word)) for word in ("[", ",", ";", '"a",', "NPTS=")]
    for line in (*lines, f"a{' ' * 16000}b,x", f"200{' ' * 16000}b"):
        path.write_text(f"{line}\n0.1 0.2\n0.2 broken\n")
        begin = time.process_time()
        with pytest.raises(FileError) as raised:
            sb.read_records([path], "g")
        with pytest.raises(FileError):
            sb.read_record(path, "g")
        # A search that is quadratic in the length of the line takes two to ten seconds.
        assert time.process_time() - begin < 1.5
        assert len(str(raised.value)) < 700


def test_a_message_quotes_no_more_than_a_part_of_a_line(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text(f"0.1\n{'7x' * 5000}\n0.2\n")
    with pytest.raises(
        FileError, match=r"a\.txt, line 2: not a number: '7x7x.* … .*7x'\. Correct or remove it$"
    ) as raised:
        sb.read_record(path, "g", step=0.01)
    assert len(str(raised.value)) < 600


def test_names_in_an_archive_become_paths_below_it(tmp_path):
    path = tmp_path / "a.zip"
    names = ("../../up", "/rooted/file", "C:\\disk\\file", "a\nb", "long" * 3000, ".", "..", "x/./y")
    found = [place for place, _ in members(path, zipped(dict.fromkeys(names, b"1")), list, Allowance())]
    below = [place.relative_to(path).as_posix() for place in found]
    assert sorted(below) == sorted(["up", "rooted/file", "C:/disk/file", "a_b", ("long" * 3000)[:100], "_", "x/y"])


def test_a_title_of_a_sheet_is_one_harmless_name(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    titles = {"../../x": "_.._x", ".hidden": "hidden", "/etc/name": "_etc_name", "t" * 5000: "t" * 100, "..": "_"}
    for title, name in titles.items():
        book = openpyxl.Workbook()
        book.active._WorkbookChild__title = title  # other programs write what openpyxl refuses
        for row in (["time [s]", "x [g]"], [0.0, 0.1], [0.01, 0.2], [0.02, 0.1]):
            book.active.append(row)
        path = tmp_path / "book.xlsx"
        book.save(path)
        (record,) = sb.read_records(path)
        assert f"book.xlsx/{name}," in record.provenance[0]
        with pytest.raises(FileError, match=rf"book\.xlsx has no such part\. It has {re.escape(name)}"):
            sb.read_record(path / "other")
        assert len(sb.read_record(path / name).samples) == 3


def test_a_workbook_without_end_is_refused(tmp_path, monkeypatch):
    openpyxl = pytest.importorskip("openpyxl")
    monkeypatch.setattr(containers, "MOST_ROWS", 1000)
    book = openpyxl.Workbook()
    book.active.append([0.0, 0.1])
    book.active.cell(77, 1).value = 0.2
    path = tmp_path / "book.xlsx"
    book.save(path)
    parts = dict(zip_contents(path))
    name = "xl/worksheets/sheet1.xml"
    far = parts[name].replace(b'r="77"', b'r="9524288"').replace(b'"A77"', b'"A9524288"')
    path.write_bytes(zipped(parts | {name: far}))
    with pytest.raises(FileError, match=r"more than 1000 rows, or 16777216 cells\. Save the rows that are needed"):
        sb.read_record(path, "g")


def zip_contents(path):
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            yield name, archive.read(name)


def test_a_workbook_states_that_it_is_one_and_declares_no_types(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["time [s]", "x [g]"], [0.0, 0.1], [0.01, 0.2], [0.02, 0.1]):
        book.active.append(row)
    path = tmp_path / "book.xlsx"
    book.save(path)
    parts = dict(zip_contents(path))
    path.write_bytes(zipped(parts | {"[Content_Types].xml": b"<Types/>"}))
    with pytest.raises(FileError, match=r"\[Content_Types\]\.xml"):  # an archive, of which no file is a record
        sb.read_record(path)
    begin, rest = parts["xl/workbook.xml"].partition(b"<workbook")[::2]
    path.write_bytes(zipped(parts | {"xl/workbook.xml": begin + b"<!DOCTYPE workbook>\n<workbook" + rest}))
    with pytest.raises(FileError, match=r"book\.xlsx: 'xl/workbook\.xml' declares types of its own\. Save the workb"):
        sb.read_record(path)


@pytest.mark.parametrize("begin", [b"BZh91AY", b"\xfd7zXZ\x00\x00", b"\x28\xb5\x2f\xfd\x04", b"\x1f\x9d\x90"])
def test_other_ways_of_packing_are_named_with_their_remedy(tmp_path, begin):
    path = tmp_path / "a.tar.other"
    path.write_bytes(begin + bytes(50))
    with pytest.raises(FileError, match=r"a\.tar\.other: packed with \w+\. Unpack it and read the files in it"):
        sb.read_records(path, "g")


@pytest.mark.posix
def test_a_pipe_without_end_is_read_up_to_the_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(contents, "LARGEST", 2 << 20)
    with pytest.raises(FileError, match=r"zero: more than 2 MiB, and no end\. Save it as a file"):
        read_bytes(Path("/dev/zero"))


def test_the_page_on_security_states_the_limits_and_formats():
    page = (Path(sb.__file__).parents[2] / "docs/about/security.md").read_text(encoding="utf-8")
    counts = contents.MOST_FILES, containers.MOST_ROWS, containers.MOST_CELLS
    limits = [f"{number:_}".replace("_", " ") for number in counts]
    limits += [f"{size >> 20} MiB" for size in (contents.LONGEST_TEXT, containers.LARGEST_WORKBOOK)]
    limits += [f"{contents.LARGEST >> 30} GiB", f"{contents.LONGEST_LINE >> 10} KiB", f"| {contents.DEEPEST} |"]
    for one in (*limits, *(form.name for form in FORMATS)):
        assert one in page, one
