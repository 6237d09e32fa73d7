"""Files of strong-motion agencies with several components: COSMOS, CSMIP, GeoNet."""

import re
from pathlib import Path

import numpy as np
import pytest

from stylobate.errors import FileError, StylobateError
from stylobate.records.agencies import (
    is_cosmos,
    is_csmip,
    is_geonet,
    read_cosmos,
    read_csmip,
    read_geonet,
)
from stylobate.records.contents import NoRecordError
from stylobate.records.directions import Direction
from stylobate.records.text_files import Text

PATH = Path("some.file")
AGAIN = "Download the file again"
UP, DOWN = Direction(vertical=1), Direction(vertical=-1)


def at(azimuth):
    return Direction(azimuth=azimuth)


def samples(seed, digits, scale=1.0, count=83):
    return np.round(np.random.default_rng(seed).normal(scale=scale, size=count), digits)


def fixed(values, form):
    """Write numbers in a Fortran format such as (8F10.5): right-aligned, without the zero before the point."""
    on_a_line, kind, width, digits = re.fullmatch(r"\((\d*)([EFIefi])(\d+)(?:\.(\d+))?\)", form).groups()
    form = "d" if kind in "Ii" else f".{digits}{kind}"
    tokens = [f"{value:{form}}".replace("0.", ".", 1 if abs(value) < 1.0 else 0) for value in values]
    tokens = [token.rjust(int(width)) for token in tokens]
    assert all(len(token) == int(width) for token in tokens)
    on_a_line = int(on_a_line or 1)
    return ["".join(tokens[i : i + on_a_line]) for i in range(0, len(tokens), on_a_line)]


def text_of(content):
    return Text.of(PATH, content.encode())


def assert_read(channels, values, directions, step, unit):
    assert [one.component.direction for one in channels] == list(directions)
    for one, expected in zip(channels, values, strict=True):
        np.testing.assert_array_equal(one.component.samples, expected)
        assert one.component.step == step
        assert one.component.unit == unit


def assert_refused(read, content, line, what, kind=FileError):
    with pytest.raises(FileError) as raised:
        read(text_of(content))
    assert str(raised.value) == f"{PATH}, line {line}: {what}"
    assert type(raised.value) is kind


# COSMOS


def cosmos(
    values,
    azimuth=-999,
    words="Other",
    number=1,
    code="HNE",
    kind="acceleration",
    unit="cm/sec2(04)",
    form="(8F10.5)",
    step=5.0,
    end="End-of-data for Chan",
    version="01.20",
):
    integers, reals = [-999] * 100, [-999.0] * 100
    integers[53], reals[61], reals[72] = azimuth, step, 980.665
    comments = [f"<SCNL>ABC.{code}.XY.--    <AUTH> 2020/02/01 21:38:15.000"] if code else []
    comments = ["|" + line for line in ("RcrdId: (none)", *comments)]
    lines = [
        f"Corrected {kind}    (Format v{version} with 13 text lines)",
        "Record of Some Place Earthquake of Fri Nov 30, 2018 17:29 UTC",
        "Hypocenter: 61.34640 -149.95520 H= 46km Mw=7.0",
        "Origin: 2018/11/30 17:29:29    UTC",
        "Statn No: 37-000011 Code:XY-ABC     Some Institute  Some Site, USA",
        "Coords: 60.9677 -144.6051  Site geology:",
        "Recorder: (see cmnt)      ( ? Chns of   3 at Sta) Sensor: (see comment)    ",
        "Rcrd start time: 2018/11/30 17:29:39.137 UTC (Q=5) RcrdId: (see comment)",
        f"Sta Chan {number:>3}:{words}   (Rcrdr Chan  ?) Location:",
        "Raw record length = 210.000 sec, Uncor max =    101730, at  82.680 sec.",
        "Processed:2019-03-03 05:46:55 GMT, UNKN, Max =   -6.852 cm/sec2 at   76.215 sec",
        "Record filtered below  0.03 Hz (periods over 33.33 secs), and above 20.0 Hz",
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.00",
        " 100 Integer-header values follow on  10 lines, Format= (10I8)",
        *fixed(integers, "(10I8)"),
        " 100 Real-header values follow on  20 lines, Format= (5F15.6)",
        *fixed(reals, "(5F15.6)"),
        f'{len(comments):4d} Comment line(s) follow, each starting with a "|":',
        *comments,
        f"{len(values):8d} {kind} pts, approx  210 secs, units={unit},Format={form}",
        *fixed(values, form),
        *([f"{end}{code} {kind}"] if end else []),
    ]
    return "\n".join(lines) + "\n"


FIRST_ROW = 50
"""Line of the first samples in a file of `cosmos`."""


def test_the_components_of_a_cosmos_file_are_read_with_names_directions_and_titles():
    values = [samples(seed, 5) for seed in range(3)]
    azimuths = ((90, "HNE"), (400, "HNZ"), (360, "HNN"))
    content = "".join(cosmos(some, azimuth, code=code) for some, (azimuth, code) in zip(values, azimuths, strict=True))
    channels = read_cosmos(text_of(content))
    assert_read(channels, values, (at(90.0), UP, at(0.0)), 0.005, "cm/s²")
    assert [(one.station, one.name) for one in channels] == [("XY-ABC", "HNE"), ("XY-ABC", "HNZ"), ("XY-ABC", "HNN")]
    assert channels[1].component.title == "Some Place, 2018-11-30, XY-ABC, HNZ"


@pytest.mark.parametrize(
    ("azimuth", "words", "code", "direction"),
    [
        (1, "Up", "HNZ", at(1.0)),
        (360, "90 Deg", "HNE", at(0.0)),
        (400, "90 Deg", "HNE", UP),
        (401, "90 Deg", "HNE", DOWN),
        (-999, " 90 Deg", "HNZ", at(90.0)),
        (0, " Up", "HNE", UP),
        (-999, " S16W", "HNE", at(196.0)),
        (0, "Other", "BNZ", UP),
        (402, "Other", "HN1", Direction(axis="x")),
        (-999, "Other", "HN3", None),
        (-999, "Other", "", None),
    ],
)
def test_the_azimuth_of_a_cosmos_channel_comes_from_its_header_its_text_or_its_code(azimuth, words, code, direction):
    (channel,) = read_cosmos(text_of(cosmos(samples(1, 5), azimuth, words, code=code)))
    assert channel.component.direction == direction
    assert channel.name == (code or "Chan 1")


def test_velocities_and_displacements_of_a_cosmos_file_are_left_out():
    values, others = samples(1, 5), {"velocity": "cm/sec(05)", "displacement": "cm(06)"}
    skipped = [cosmos(samples(2, 6), kind=kind, unit=unit, form="(1E15.6)") for kind, unit in others.items()]
    (channel,) = read_cosmos(text_of(skipped[0] + "\n" + cosmos(values, 90, end="/&") + skipped[1]))
    np.testing.assert_array_equal(channel.component.samples, values)
    what = "the file holds velocity and displacement, no accelerations. Read the file with the accelerations of this"
    assert_refused(read_cosmos, "".join(skipped), 1, f"{what} station", NoRecordError)


def test_channels_of_one_name_are_numbered():
    channels = read_cosmos(text_of(cosmos(samples(1, 5), 90) * 3))
    assert [one.name for one in channels] == ["HNE", "HNE 2", "HNE 3"]


@pytest.mark.parametrize("form", ["(1E15.6)", "(5E15.6)", "(8F10.5)", "(10F9.4)"])
def test_each_format_of_a_cosmos_file_restores_the_printed_digits(form):
    values = samples(5, 4, scale=200.0)
    values = np.array([float(f"{value:.6E}") for value in values])
    (channel,) = read_cosmos(text_of(cosmos(values, 90, form=form, unit="g(02)")))
    assert_read([channel], [values], [at(90.0)], 0.005, "g")


@pytest.mark.parametrize(("unit", "name"), [(" counts(50)", "counts"), ("volts(51)", "volts"), ("mV(23)", "mV")])
def test_readings_of_a_digitizer_are_refused(unit, name):
    content = cosmos(np.arange(83), unit=unit, kind="raw accel.  ", form="(1I8)")
    what = f"raw {name} of a digitizer, no accelerations. Read the V1 or V2 file of this record"
    assert_refused(read_cosmos, content, FIRST_ROW - 1, what)


LINES = cosmos(samples(1, 5), 90).splitlines()
STEP_ROW = 38


@pytest.mark.parametrize(
    ("line", "old", "new", "what"),
    [
        (
            1,
            "v01.20",
            "v02.00",
            "the version of the format must be 01.20, got 02.00. Download the file in that version",
        ),
        (14, "100 Integer", "100 integral", f"the line of the integer header is missing. {AGAIN}"),
        (14, "(10I8)", "", f"the line must end with a format of numbers such as (8F10.5). {AGAIN}"),
        (25, "100 Real", "100 other", f"the line of the real header is missing. {AGAIN}"),
        (STEP_ROW, " 5.000000", " 0.000000", "the time step must be positive, got 0.0. Correct the header"),
        (STEP_ROW, "    5.000000", " -999.000000", "the time step, real no. 62, is unknown. Correct the header"),
        (STEP_ROW, "5.000000", "5.00ab00", "not a number: '5.00ab00'. Correct or remove it"),
        (46, "Comment", "Remark", f"the line with the number of comments is missing. {AGAIN}"),
        (47, "|", "?", f'a comment, which begins with "|", is missing. {AGAIN}'),
        (49, "pts", "?", f"the line with number, kind, unit and format of the samples is missing. {AGAIN}"),
        (
            49,
            "cm/sec2(04)",
            "in/sec2(07)",
            'unknown unit \'in/sec2\'. Give accelerations in "g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²", '
            "and state that unit",
        ),
        (49, " 83 ", "  1 ", "the number of samples must be at least 2 samples, got 1. Correct the header"),
    ],
)
def test_a_cosmos_file_with_a_wrong_header_is_refused(line, old, new, what):
    lines = list(LINES)
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new)
    assert_refused(read_cosmos, "\n".join(lines), line, what)


def test_samples_that_are_unknown_or_no_numbers_are_refused():
    values = samples(1, 5)
    values[9] = -999.0
    remedy = "Fill the gap, or trim the file to the samples without gaps"
    assert_refused(read_cosmos, cosmos(values, 90), FIRST_ROW + 1, f"an unknown sample, -999.00000. {remedy}")
    starred = cosmos(values, 90).replace("-999.00000\n", "**********\n").replace("-999.00000", "*" * 10)
    assert_refused(read_cosmos, starred, FIRST_ROW + 1, "not a number: '**********'. Correct or remove it")


def test_more_or_fewer_samples_than_stated_are_refused():
    lines = list(LINES)
    form = "the header states 83 numbers, 8 a line, 10 characters each"
    row = FIRST_ROW + 5
    short = [*lines[: row - 1], lines[row - 1][:-3], *lines[row:]]
    cut = f"{form}; 40 of them precede this line, which is cut or too long. {AGAIN}"
    assert_refused(read_cosmos, "\n".join(short), row, cut)
    missing = f"{form}; 40 of them precede this line, which is missing. {AGAIN}"
    assert_refused(read_cosmos, "\n".join(lines[: row - 1]), row - 1, missing)
    many = [*lines[:-1], lines[FIRST_ROW], lines[-1]]
    what = f"the first line of a block, with its format v01.20, is missing. {AGAIN}"
    assert_refused(read_cosmos, "\n".join(many), len(many) - 1, what)


def test_a_short_header_is_refused():
    lines = list(LINES)
    lines[24] = lines[24].replace("100", " 60")
    lines[37:45] = []
    what = f"the header must have at least 62 numbers, got 60. {AGAIN}"
    assert_refused(read_cosmos, "\n".join(lines), 37, what)


def test_a_header_edited_by_hand_is_read_between_blanks():
    lines = list(LINES)
    lines[19] = lines[19].replace("      90", " 90")
    (channel,) = read_cosmos(text_of("\n".join(lines)))
    assert channel.component.direction == at(90.0)


def test_spectra_hold_no_record():
    what = "the file holds spectra, no accelerations. Read the V2 file of this record"
    spectra = cosmos(samples(1, 5)).replace("Corrected acceleration", "Response spectra")
    assert_refused(read_cosmos, spectra, 1, what, NoRecordError)
    csmip = "Response and Fourier amplitude spectra (78 periods)   for\n" + volume_2([("360 Deg", samples(1, 6))])
    assert is_csmip(text_of(csmip))
    assert_refused(read_csmip, csmip, 1, what, NoRecordError)


# CSMIP

EVENT = "Record of Mon Feb 13, 2012 13:06:45.0 PST             (Avol1 v9.2,12/11 CSMIP)"


def volume_1(channels, unit="g .     ", form="(8f9.6)", event=EVENT):
    return "".join(map("\n".join, _volume_1_sections(channels, unit, form, event)))


def _volume_1_sections(channels, unit, form, event):
    for number, (direction, values) in enumerate(channels, start=1):
        yield [
            *_volume_1_lines(number, direction, event),
            f"No. of Points = {len(values):6d}  Record Length = 66.000 sec   at 200 Samples/sec",
            "Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.",
            "RMS calc for complete record =        .   Chn. metadata effective date: 08/10/05",
            *fixed([number] * 100, "(16I5)"),
            *fixed([0.5 * number] * 50, "(8f10.6)"),
            f" {len(values)} Accelerogram points at 200 pts/sec in units of {unit} Format: {form}  ",
            *fixed(values, form),
            f"/&  ----------  End of Data for Channel  {number}  ----------",
            "",
        ]


def _volume_1_lines(number, direction, event):
    return [
        "Uncorrected Accelerogram Data             Processed: 02/13/12, CGS  146be002    ",
        event,
        "CSMIP Preliminary Processing            (Origin:  To be determined)             ",
        "12345-L2500-12044.02                 Start time:  2/13/12, 21:06:45.0 UTC (GPS) ",
        "Station No. 12345   40.941N, 123.633W      Etna  s/n 2500  (3 Chns of  3 at Sta)",
        "Some Creek                                CGS                                   ",
        f"Chan {number:2d}: {direction}   ",
        "SOME EARTHQUAKE     MAY 2, 1983 16:42 PDT",
        "Hypocenter:  To be determined.               ML:  To be determined.             ",
        "Instr Period =  .0109 sec,  Damping =  .670,  Sensitivity =  .63  v/g           ",
    ]


SERIES = (("accel", "cm/sec2"), ("veloc", "cm/sec"), ("displ", "cm"))


def volume_2(channels, form="(8f10.6)", old=False, kinds=SERIES, event=EVENT):
    lines = []
    for number, (direction, values) in enumerate(channels, start=1):
        lines += [
            f"Corrected accelerogram   12345-L2500-12044.02       Chan {number:2d}: {direction}     from   ",
            *_volume_1_lines(number, direction, event),
            "                        Record length = 60.000 sec.                             ",
            "                                     Uncor Max  =   .079 g , at  30.590 sec.    ",
            "RMS accel of (uncor) record  =        .   Chn. metadata effective date: 08/10/05",
            "Accelerogram bandpass filtered with 3 dB pts at   .30 and 40.00 cyc/sec         ",
            f" {len(values)} points of instrument- and baseline-corrected accel, veloc and displ data ",
            "At equally-spaced intervals of    .005  sec.                                    ",
            "Peak acceleration =    77.280    cm/sec/sec  at   30.585   sec.                 ",
            "Peak   velocity   =     3.150      cm/sec    at   30.650   sec.                 ",
            "Peak displacement =      .165        cm      at   30.765   sec.                 ",
            "Initial velocity  =      .000   cm/sec;   Initial displacement =     .000   cm  ",
            *("", "", "12345-L2500-12044.02      Some Creek    Chan  1: 360 Deg", ""),
            *fixed([number] * 100, "(16I5)"),
            *fixed([0.5 * number] * 100, "(8f10.6)"),
        ]
        for kind, unit in kinds:
            data = f"{len(values)} points of {kind} data equally spaced at  .005 sec"
            if old:
                spelled = unit.replace("sec2", "sec/sec")
                lines += [f" {data}.  (units: {spelled})", *fixed(values, "(8f10.3)")]
            else:
                lines += [f" {data}, in {unit}. {form}    ", *fixed(values if kind == "accel" else 0 * values, form)]
        lines += [f"/&  ----------  End of data for channel  {number}  ----------"]
    content = "\r\n".join(lines) + "\r\n"
    return content.upper() if old else content


DIRECTIONS = {"360 Deg": at(0.0), " UP": UP, "S16W": at(196.0)}


def channels_of(values):
    return list(zip(DIRECTIONS, values, strict=True))


def test_the_accelerations_of_a_csmip_volume_2_are_read():
    values = [samples(seed, 6) for seed in range(3)]
    channels = read_csmip(text_of(volume_2(channels_of(values))))
    assert_read(channels, values, DIRECTIONS.values(), 0.005, "cm/s²")
    assert [(one.station, one.name) for one in channels] == [("12345", f"Chan {number}") for number in (1, 2, 3)]
    assert channels[0].component.title == "2012-02-13, 12345, Chan 1"


def test_an_old_csmip_volume_2_in_capitals_without_formats_is_read():
    values = [samples(seed, 3, scale=50.0) for seed in range(3)]
    channels = read_csmip(text_of(volume_2(channels_of(values), old=True, event="Some Earthquake")))
    assert_read(channels, values, DIRECTIONS.values(), 0.005, "cm/s²")
    assert channels[0].component.title == "SOME, 1983-05-02, 12345, Chan 1"


def test_the_accelerations_of_a_csmip_volume_1_are_read_in_g_and_tenths_of_g():
    values = [samples(seed, 6, scale=0.1) for seed in range(3)]
    channels = read_csmip(text_of(volume_1(channels_of(values))))
    assert_read(channels, values, DIRECTIONS.values(), 0.005, "g")
    assert channels[0].station == "12345"
    tenths = read_csmip(text_of(volume_1(channels_of(values), unit="g/10.  ")))
    assert_read(tenths, [some / 10.0 for some in values], DIRECTIONS.values(), 0.005, "g")


def test_numbers_of_fixed_width_may_abut():
    values = -np.abs(samples(7, 4, scale=300.0)) - 100.0
    values = np.round(np.clip(values, -999.0, -100.0), 4)
    for read, content in (
        (read_cosmos, cosmos(values, 90, form="(8F9.4)")),
        (read_csmip, volume_1([("90 Deg", values)], form="(8f9.4)")),
        (read_csmip, volume_2([("90 Deg", values)], form="(8f9.4)")),
        (read_geonet, geonet([("N90E", np.round(values, 3))], form="(10F8.3)")),
    ):
        (channel,) = read(text_of(content))
        digits = 3 if read is read_geonet else 4
        np.testing.assert_array_equal(channel.component.samples, np.round(values, digits))


def test_a_csmip_file_without_accelerations_is_refused():
    content = volume_2([("360 Deg", samples(1, 6))], kinds=SERIES[1:])
    what = "the file holds velocity and displacement, no accelerations. Read the file with the accelerations of this"
    assert_refused(read_csmip, content, 1, f"{what} station", NoRecordError)


def test_uncorrected_accelerations_at_uneven_times_are_refused():
    lines = volume_1([("90 DEG", samples(1, 6))]).upper().splitlines()
    lines[10:12] = [
        "NO. OF POINTS =  12080  RECORD LENGTH = 59.998 SEC",
        "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  -.055 G, AT  15.992 SEC.",
    ]
    lines = [line for line in lines if "ACCELEROGRAM POINTS" not in line]
    what = "accelerations at uneven times. Read the corrected file (V2) of this record"
    assert_refused(read_csmip, "\n".join(lines), 12, what)


V1, V2 = (text.splitlines() for text in (volume_1([("90 Deg", samples(1, 6))]), volume_2([("90 Deg", samples(1, 6))])))
V1_DATA, V2_DATA = 28, 46


@pytest.mark.parametrize(
    ("lines", "line", "old", "new", "where", "what"),
    [
        (V1, V1_DATA, "200 pts", "0 pts", 28, "the time step must be positive, got 0.0. Correct the header"),
        (
            V1,
            V1_DATA,
            "g .",
            "in/s2 .",
            28,
            'unknown unit \'in/s2\'. Give accelerations in "g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²", '
            "and state that unit",
        ),
        (V1, V1_DATA, "Accelero", "??", 40, f"the line with the number of points of accelerations is missing. {AGAIN}"),
        (
            V1,
            V1_DATA,
            "(8f9.6)",
            "(8x9.6)",
            28,
            f"the line must end with a format of numbers such as (8F10.5). {AGAIN}",
        ),
        (V1, 40, "/&", "??", 41, f"the last line, with the end of data of a channel, is missing. {AGAIN}"),
        (
            V1,
            7,
            "Chan",
            "Bahn",
            28,
            f"the line with number and direction of the channel is missing before this one. {AGAIN}",
        ),
        (V2, V2_DATA, "  .005 sec", " -.005 sec", 46, "the time step must be positive, got -0.005. Correct the header"),
        (V2, V2_DATA, "  .005 sec", " 0,005 sec", 46, "not a number: '0,005'. Write decimal points"),
        (V2, V2_DATA + 12, " veloc ", " accel ", 58, f"the end of data of Chan 1 is missing. {AGAIN}"),
        (V2, V2_DATA + 12, " veloc ", " v. ", 58, f"the header states 83 samples, the file has more. {AGAIN}"),
    ],
)
def test_a_csmip_file_with_a_wrong_line_is_refused(lines, line, old, new, where, what):
    lines = list(lines)
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new)
    assert_refused(read_csmip, "\n".join(lines) + "\n", where, what)


def test_an_old_csmip_file_with_fewer_numbers_is_refused():
    lines = volume_2([("90 Deg", samples(1, 3))], old=True).splitlines()
    del lines[50]
    what = "the header states 83 numbers, separated by blanks; 75 of them precede this line, which is cut or too long."
    assert_refused(read_csmip, "\n".join(lines), 57, f"{what} {AGAIN}")


# GeoNet


def geonet(channels, form="(10F8.1)", corrected=True, step=0.02):
    lines = []
    for direction, values in channels:
        integers, reals = [0] * 40, [0.0] * 60
        integers[:3] = 2018, 2, 12
        integers[30:36] = len(values), 0, 0, len(values), *([len(values)] * 2 if corrected else [0, 0])
        reals[24:26] = 0.005, step
        lines += [
            f"{'C' if corrected else 'Unc'}orrected accelerogram 20180212_211554_ABCD_20 GNS Science",
            "Site ABCD      39 56 38S  176 35 04E     Basalt file:  20180212_211557_ABCD",
            "Some District Council",
            "Instrument Basalt_2413",
            "Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700",
            "Accelerogram 20180212_211554_ABCD_20                 Processed 2018 February 21",
            "6 km south of Some Town",
            "2018 February 12         21:15:54 UT",
            "Epicentre  40 03 27S 176 32 45E  Bearing S15W  Dist   13km  Depth    9km M  4.17",
            f"Number of points  {len(values)}    Duration 115.98 sec",
            "Instrument corrected data at 0.020 sec intervals",
            "Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz",
            f"Component {direction}",
            "Acceleration:  peak    -41.6 mm/s/s at  43.68 sec     rms      2.2 mm/s/s",
            "Velocity:      peak     1.65 mm/s   at  43.56 sec     rms     0.09 mm/s",
            "Displacement:  peak    0.131 mm     at  43.66 sec     rms    0.007 mm",
            *fixed(integers, "(10I8)"),
            *fixed(reals, "(10F8.4)"),
            *fixed(values, form),
            *(fixed(0.0 * values, "(10F8.5)") * 2 if corrected else []),
        ]
    return "\n".join(lines) + "\n"


AXES = ("S16W  Longitudinal Accelerometer Axis", "S74E  Transverse Accelerometer Axis", "Up    Vertical Axis")


@pytest.mark.parametrize("corrected", [True, False], ids=["V2A", "V1A"])
def test_the_accelerations_of_a_geonet_file_are_read(corrected):
    values = [samples(seed, 1, scale=100.0) for seed in range(3)]
    names = AXES if corrected else [axis.split()[0] for axis in AXES]
    channels = read_geonet(text_of(geonet(zip(names, values, strict=True), corrected=corrected)))
    assert_read(channels, values, (at(196.0), at(106.0), UP), 0.02, "mm/s²")
    assert [(one.station, one.name) for one in channels] == [("ABCD", name) for name in ("S16W", "S74E", "Up")]
    assert channels[0].component.title == "6 km south of Some Town, 2018-02-12, ABCD, S16W"


G = geonet([("Up", samples(1, 1, scale=100.0))]).splitlines()


@pytest.mark.parametrize(
    ("line", "old", "new", "what"),
    [
        (2, "Site", "Town", f"the line with the site is missing. {AGAIN}"),
        (13, "Component", "Direction", f"the line with the direction of the component is missing. {AGAIN}"),
        (
            20,
            "      83      83      83",
            "      ab      83      83",
            "the number of accelerations, integer no. 34, must be a whole number, got 'ab'. Correct the header",
        ),
        (20, "83       0", "ab       0", "not a number of samples: 'ab'. Correct the header"),
        (23, ".0200", ".0000", "the time step must be positive, got 0.0. Correct the header"),
    ],
)
def test_a_geonet_file_with_a_wrong_line_is_refused(line, old, new, what):
    lines = list(G)
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new)
    assert_refused(read_geonet, "\n".join(lines), line, what)


def test_a_geonet_file_with_more_or_fewer_numbers_is_refused():
    what = "the header states 83 numbers, 10 a line, 8 characters each; 80 of them precede this line, which is"
    assert_refused(read_geonet, "\n".join([*G[:34], *G[35:]]), 35, f"{what} cut or too long. {AGAIN}")
    assert_refused(read_geonet, "\n".join(G[:-1]), len(G) - 1, f"{what} missing. {AGAIN}")
    assert_refused(
        read_geonet, "\n".join([*G, G[-1]]), len(G) + 1, f"the first line of a component is missing. {AGAIN}"
    )


# all of them

THREE = [samples(seed, 3, scale=0.5, count=19) for seed in range(3)]
SEEDS = {
    "cosmos": (
        is_cosmos,
        read_cosmos,
        "".join(cosmos(values, azimuth) for values, azimuth in zip(THREE, (90, 400, 180), strict=True)),
    ),
    "V1": (is_csmip, read_csmip, volume_1(channels_of(THREE))),
    "V2": (is_csmip, read_csmip, volume_2(channels_of(THREE))),
    "old V2": (is_csmip, read_csmip, volume_2(channels_of(THREE), old=True)),
    "V1A": (is_geonet, read_geonet, geonet(channels_of(THREE), form="(10F8.3)", corrected=False)),
    "V2A": (is_geonet, read_geonet, geonet(channels_of(THREE), form="(10F8.3)")),
}
OTHERS = (
    "PEER NGA DATABASE RECORD\nQuake, 1/2/1990, Site, 90\nACCELERATION IN UNITS OF G\nNPTS= 2, DT= .005 SEC\n.1 .2\n",
    "EVENT_NAME: Quake\nSAMPLING_INTERVAL_S: 0.005\nNDATA: 2\nUNITS: cm/s^2\n1\n2\n",
    "time [s],x [g]\n0.0,1.0\n0.1,2.0\n",
    "Corrected accelerogram\n",
    "2 CORRECTED ACCELEROGRAM\n*\n",
    "1.0",
    "",
)


@pytest.mark.parametrize("name", SEEDS)
def test_each_format_is_detected_by_its_own_first_lines_alone(name):
    detect, _, content = SEEDS[name]
    accepted = {one for one in (is_cosmos, is_csmip, is_geonet) if one(text_of("\n".join(content.splitlines()[:3])))}
    assert accepted == {detect}
    assert not any(map(detect, map(text_of, OTHERS)))


def outcome(read, content):
    """Return the channels of a file or, where the reader refuses it, its message."""
    try:
        channels = read(text_of(content))
    except StylobateError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001  any other is what is looked for
        pytest.fail(f"{type(error).__name__}: {error}, of {content!r}")
    assert channels
    assert len({one.name for one in channels}) == len(channels)
    return channels


@pytest.mark.parametrize("name", SEEDS)
def test_a_cut_file_is_refused_or_ends_with_a_whole_component(name):
    _, read, content = SEEDS[name]
    whole, lines = read(text_of(content)), content.splitlines(keepends=True)
    rng = np.random.default_rng(sum(name.encode()))
    cuts = [sum(map(len, lines[:count])) for count in range(1, len(lines))]
    refused = 0
    for cut in (*cuts, *rng.integers(1, len(content), 300).tolist()):
        found = outcome(read, content[:cut])
        refused += isinstance(found, str)
        if not isinstance(found, str):
            for one, expected in zip(found, whole, strict=False):
                np.testing.assert_array_equal(one.component.samples, expected.component.samples)
                assert one.component.direction == expected.component.direction
    # the few others end after a component
    assert refused > 0.9 * (len(cuts) + 300)


PIECES = (
    *"0123456789.,:;|()/& -+*\n\r\t=aE²१\x00",
    "\n\n",
    "nan",
    "inf",
    "1e999",
    "9" * 20,
    "-999",
    "accel",
    "(1F9.2)",
)


@pytest.mark.parametrize("name", SEEDS)
def test_a_spoilt_file_raises_only_errors_of_the_package_with_one_line(name):
    _, read, content = SEEDS[name]
    rng = np.random.default_rng(sum(name.encode()))
    outcomes = {"read": 0, "refused": 0}
    for _ in range(500):
        spoilt = content
        for _ in range(rng.integers(1, 4)):
            place = int(rng.integers(len(spoilt) + 1))
            length, piece = int(rng.integers(0, 12)), str(rng.choice(PIECES))
            lines = spoilt.split("\n")
            row = int(rng.integers(len(lines)))
            match rng.integers(4):
                case 0:
                    spoilt = spoilt[:place] + spoilt[place + length :]
                case 1:
                    spoilt = spoilt[:place] + piece + spoilt[place + len(piece) :]
                case 2:
                    lines[row] = piece + lines[row][len(piece) :]
                    spoilt = "\n".join(lines)
                case 3:
                    spoilt = "\n".join(lines[:row] + lines[row + int(rng.integers(1, 3)) :])
        found = outcome(read, spoilt)
        outcomes["refused" if isinstance(found, str) else "read"] += 1
        if isinstance(found, str):
            assert "\n" not in found
        else:
            assert all(np.all(np.isfinite(one.component.samples)) for one in found)
            assert all(one.component.step > 0.0 for one in found)
    assert min(outcomes.values()) > 10, outcomes
