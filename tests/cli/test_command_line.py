"""The command line does what the public names do, and tells mistakes one to a line."""

import json
import os
import subprocess
import sys
from io import StringIO
from itertools import chain

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from rich.console import Console
from rich.table import Table

import stylobate as sb
from stylobate.cli.commands import COMMANDS
from stylobate.cli.main import run
from stylobate.cli.output import print_table, table_lines

COLUMN = ["--slenderness", "0.1", "--damping", "0.1"]
MOTION = ["--motion", "circular", "--acceleration", "0.065", "--angular-frequency", "1.8"]
WEAK = ["--motion", "straight", "--acceleration", "0.001"]
START = ["--tilt", "0.04", "0", "--tilt-rate", "0", "0.07", "--duration", "20"]


def stylobate(*arguments, **options):
    command = [sys.executable, "-m", "stylobate", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def test_simulate_prints_what_simulate_finds(capsys):
    assert run(["simulate", *COLUMN, *MOTION, *START, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    model = sb.Wobbling(sb.Column.dimensionless(0.1), damping=0.1)
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    found = sb.simulate(model, motion, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), duration=20.0)
    assert told["outcome"] == found.outcome.name
    assert told["measures"]["peak_tilt"] == found.measures["peak_tilt"]


def test_damping_by_a_word_is_stored_and_printed_as_a_number(capsys):
    column = ["--radius", "0.3", "--height", "3", "--density", "2700"]
    assert run(["simulate", *column, "--damping", "housner", *START, "--json"]) == 0
    stored = json.loads(capsys.readouterr().out)["provenance"]["model"]["damping"]
    assert stored == sb.Column.solid(radius=0.3, height=3.0, density=2700.0).housner_damping()


def test_options_win_over_a_file_of_the_same_names(tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(
        'duration = 50.0\ntilt = [0.05, 0.0]\n[column]\nshape = "dimensionless"\nslenderness = 0.1\n'
        '[model]\ndamping = 0.1\n[motion]\nkind = "straight"\nacceleration = 0.01\nangular_frequency = 2.0\n'
    )
    assert run(["simulate", str(description), "--duration", "5", "--acceleration", "0.02", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["provenance"]["duration"] == 5.0
    assert told["provenance"]["motion"]["acceleration"] == 0.02
    assert told["provenance"]["tilt"] == [0.05, 0.0]


def test_a_saved_run_can_be_repeated(tmp_path, capsys):
    saved = tmp_path / "run.nc"
    assert run(["simulate", *COLUMN, *MOTION, *START, "--output", str(saved), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert run(["simulate", str(saved), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["measures"] == first["measures"]


def test_figures_and_tables_are_made(tmp_path, capsys):
    drawn = tmp_path / "run.png"
    assert run(["simulate", *COLUMN, *MOTION, *START, "--figure", str(drawn)]) == 0
    assert "outcome" in capsys.readouterr().out
    assert drawn.stat().st_size > 10_000
    drawn = tmp_path / "response.svg"
    arguments = [*COLUMN, *MOTION[:4], "--angular-frequency-range", "0.5", "3", "--points", "50"]
    assert run(["response", *arguments, "--figure", str(drawn), "--output", str(tmp_path / "r.nc")]) == 0
    assert "critical frequency 1.397108 rad/s" in capsys.readouterr().out
    assert drawn.stat().st_size > 10_000


def test_response_as_json_has_every_curve(capsys):
    arguments = [*COLUMN, *MOTION[:4], "--angular-frequency-range", "0.5", "3", "--points", "5", "--json"]
    assert run(["response", *arguments]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["branch"] == ["upper", "lower"]
    assert len(told["amplitude"][0][0]) == len(told["angular_frequency"]) == 5


def test_simulate_animates_the_run_it_prints(tmp_path, capsys):
    shown = tmp_path / "run.gif"
    pictures = []
    for speed in ("4", "8"):
        assert run(["simulate", *COLUMN, *MOTION, *START, "--animation", str(shown), "--speed", speed, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["outcome"]
        with Image.open(shown) as animation:
            pictures.append(animation.n_frames)
    assert pictures[0] > 1.5 * pictures[1]
    for options, line in (
        (["--animation", "run.avi"], "path must end with .gif, .mp4 or .html, got 'run.avi'"),
        (["--animation", str(shown), "--speed", "0"], "speed must be positive, got 0.0"),
        (["--speed", "2"], "--speed: simulate does not use it"),
    ):
        assert run(["simulate", *COLUMN, *MOTION, *START, *options]) == 2
        assert line in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "lines"),
    [
        (["simulate"], ["column is missing", "duration is missing"]),
        (["simulate", *COLUMN], ["duration is missing"]),
        (["simulate", *COLUMN], ["length of a run [s], such as 60"]),
        (["simulate", *COLUMN, "--velocity", "1", "2"], ["--velocity must be followed by 3 numbers; got fewer"]),
        (
            ["simulate", *COLUMN, "--velocity", "1", "2", "--duration", "3"],
            ["--velocity must be followed by 3 numbers; one of them is not a number"],
        ),
        (
            ["map", *COLUMN, "--x", "damping", "0.1", "0.2", "2.5"],
            ["--x must be followed by NAME FROM TO NUMBER; NUMBER must be a whole number"],
        ),
        (["simulate", *COLUMN, "--damping", "housnr"], ["--damping must be a number or housner, got 'housnr'"]),
        (["simulate", *COLUMN, "--duration", "-2"], ["duration must be positive, got -2.0 s"]),
        (
            ["simulate", "--slenderness", "-1", *MOTION[:2], "--acceleration", "nan", *MOTION[4:], "--duration", "1"],
            ["column: slenderness must be positive, got -1.0", "motion: acceleration must be finite, got nan m/s²"],
        ),
        (
            ["simulate", "--slenderness", "-1", "--damping", "-2", "--duration", "-3", "--samples", "1"],
            ["column: slenderness", "model: damping", "duration must be positive", "samples must be a whole number"],
        ),
        (
            ["simulate", *COLUMN, "--radius", "1", "--duration", "1"],
            [
                "--radius: column shape 'dimensionless' does not use it (got 1.0). "
                "Remove it, or choose --shape solid, hollow or frustum."
            ],
        ),
        (["simulate", "no such file.toml"], ["cannot read no such file.toml: No such file or directory"]),
        (
            ["response", *COLUMN, *MOTION[:4], "--angular-frequency-range", "3", "1"],
            ["angular_frequency_range must rise"],
        ),
        (["simulate", *COLUMN, "--duration", "1", "--figure", "run.xyz"], ["cannot draw into run.xyz"]),
        (
            ["simulate", *COLUMN, "--duration", "1", "--output", "run.txt"],
            ["--output must end with .nc, .csv or .xlsx, got 'run.txt'"],
        ),
        (
            ["simulate", *COLUMN, "--duration", "1", "--output", "run.zarr"],
            ["--output must end with .nc, .csv or .xlsx, got"],
        ),
        (
            ["response", *COLUMN, *MOTION[:4], "--angular-frequency-range", "1", "3", "--output", "response.txt"],
            ["--output must end with .nc, .csv or .xlsx, got 'response.txt'"],
        ),
        (
            ["response", *COLUMN, *MOTION[:4], "--angular-frequency-range", "-1", "3"],
            ["angular_frequency_range must rise from above zero, got -1.0 to 3.0 rad/s"],
        ),
        (["response", *COLUMN, *MOTION[:4]], ["angular_frequency_range is missing"]),
        (["boundary", *COLUMN, *MOTION[:4], "--bounds", "0.1", "0.2"], ["angular_frequency_range is missing"]),
        (
            ["response", "--exact", *COLUMN, *MOTION[:4], "--angular-frequency-range", "1", "3", "--points", "50"],
            ["--points: --exact chooses its own frequencies (got 50). Remove one of them."],
        ),
        (
            ["response", *COLUMN, *MOTION[:4], "--angular-frequency-range", "1", "3", "--figure", "x.bmp"],
            ["cannot draw into x.bmp: --figure must end with .png, .pdf, .svg or .html"],
        ),
        (
            ["response", "--exact", *COLUMN, *WEAK, "--angular-frequency-range", "1", "2"],
            ["no orbit was found between 1.0 and 2.0 rad/s: theory has no steady rolling"],
        ),
        (["nonsense"], ["No such command"]),
        (["simulate", "--nonsense"], ["No such option"]),
    ],
)
def test_bad_input_is_told_one_mistake_a_line(arguments, lines, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    captured = capsys.readouterr()
    told = captured.err.strip().splitlines()
    assert len(told) == len(lines)
    assert all(line in text for line, text in zip(lines, told, strict=True))
    assert "Traceback" not in captured.err


def test_a_file_that_is_not_toml_is_told(tmp_path, capsys):
    broken = tmp_path / "broken.toml"
    broken.write_bytes(b"\xff\xfe duration = ")
    assert run(["simulate", str(broken)]) == 2
    assert "is not a TOML file" in capsys.readouterr().err


def test_the_program_runs_as_installed_and_helps_quickly():
    before = os.times()
    helped = stylobate("--help")
    after = os.times()
    assert helped.returncode == 0
    assert all(command in helped.stdout for command in ("paper", "simulate", "response"))
    # Processor time, which other processes on the machine change little; Windows counts none.
    used = after.children_user + after.children_system - before.children_user - before.children_system
    assert used < 2.0
    assert stylobate("--version").stdout.split() == ["stylobate", sb.__version__]


def test_help_imports_nothing_heavy():
    code = "import sys; from stylobate.cli.main import run; run(['--help']); print(sorted(sys.modules))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not any(f"'{name}'" in shown for name in ("scipy", "xarray", "matplotlib", "pydantic.main"))


def test_the_table_of_a_run_imports_nothing_that_only_data_and_figures_need(capsys):
    command = ["simulate", *COLUMN, *START]
    run(command)  # the compiled code is kept
    code = (
        "import sys; from stylobate.cli.main import run; run(sys.argv[1:]); "
        "heavy = {'xarray', 'pandas', 'dask', 'zarr', 'h5py', 'scipy', 'sympy', 'matplotlib', 'filelock', 'asyncio', "
        "'rich', 'stylobate.records.directions'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    shown = subprocess.run([sys.executable, "-c", code, *command], capture_output=True, text=True, check=True).stdout
    assert shown.splitlines()[-1] == "[]"
    assert shown.startswith(capsys.readouterr().out)


def test_a_table_shows_texts_as_they_are(capsys):
    print_table("names", [[":boom:.toml", "[red]", "π/2"]])
    shown = capsys.readouterr().out
    assert all(text in shown for text in (":boom:.toml", "[red]", "π/2"))


words = st.text("ab-,µ ", max_size=30).map(str.strip).filter(bool)


@given(st.data(), st.integers(1, 4), st.booleans(), st.sampled_from([24, 60, 120]))
def test_a_table_has_all_words_in_lines_of_one_length_within_the_width(data, count, headed, width):
    cells = st.lists(words, min_size=count, max_size=count)
    header, rows = data.draw(cells) if headed else None, data.draw(st.lists(cells, min_size=1, max_size=3))
    lines = table_lines(rows, header, width)
    assert len({len(line) for line in lines}) == 1
    assert len(lines[0]) <= width
    stated = "".join([*(header or ()), *chain.from_iterable(rows)])
    assert all("".join(lines).count(one) == stated.count(one) for one in "ab-,µ")


@pytest.mark.parametrize("header", [None, ("name", "number")])
def test_a_table_that_fits_is_that_of_rich(header):
    rows = [["mean", "0.1 µm"], ["多い", "b\nc"]]
    table = Table(*(header or ("", "")), show_header=header is not None)
    for row in rows:
        table.add_row(*row)
    drawn = StringIO()
    Console(file=drawn, width=60).print(table)
    assert table_lines(rows, header, 60) == drawn.getvalue().splitlines()


def test_an_interrupt_ends_without_a_traceback(monkeypatch, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("stylobate.engine.simulate", interrupted)
    assert run(["simulate", *COLUMN, *START]) == 130
    assert capsys.readouterr().err == "stylobate: interrupted\n"


def test_another_shape_or_kind_on_the_command_line_replaces_that_of_the_file(tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(
        "duration = 5.0\n[column]\nradius = 0.5\nheight = 10.0\ndensity = 2700.0\n"
        '[motion]\nkind = "straight"\nacceleration = 0.01\nangular_frequency = 2.0\ndirection = 1.0\n'
    )
    assert run(["simulate", str(description), "--slenderness", "0.2"]) == 2
    assert "add --shape dimensionless and all of its numbers" in capsys.readouterr().err
    changed = [
        "--shape",
        "dimensionless",
        "--slenderness",
        "0.2",
        "--motion",
        "stroke",
        "--stroke",
        "0.01",
        "--frequency",
        "2",
    ]
    assert run(["simulate", str(description), *changed, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["provenance"]
    assert told["column"]["radius"] == pytest.approx(0.15)
    assert (told["motion"]["stroke"], told["motion"]["frequency"]) == (0.01, 2.0)


@pytest.mark.parametrize(
    ("column", "radius"),
    [
        ("radius = 0.5\nheight = 4.0\ndensity = 2700.0\n", 0.4),
        ("radius = 0.5\ninner_radius = 0.2\nheight = 4.0\ndensity = 2700.0\n", 0.4),
        ("parts = [{radius = 0.5, height = 4.0, density = 2700.0}]\n", 0.4),
    ],
)
def test_a_number_on_the_command_line_keeps_the_shape_that_the_file_implies(column, radius, tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(f"duration = 1.0\n[column]\n{column}")
    assert run(["simulate", str(description), "--radius", str(radius), "--json"]) == 0
    made = json.loads(capsys.readouterr().out)["provenance"]["column"]
    assert (made["radius"], made["height"]) == (radius, 4.0)


def test_an_empty_boundary_is_told_in_words(capsys):
    arguments = ["--motion", "straight", "--acceleration", "0.1", "--angular-frequency-range", "2", "2.5"]
    assert run(["boundary", *COLUMN, *arguments, "--bounds", "0.1", "0.12", "--at", "0.11"]) == 0
    assert capsys.readouterr().out == (
        "no loss of stability was found: rolling is stable wherever it was found "
        "from 2 to 2.5 rad/s and acceleration 0.1 to 0.12\n"
    )


def test_the_table_of_stable_orbits_begins_and_ends_at_bifurcations(capsys):
    arguments = ["--motion", "straight", "--acceleration", "0.13", "--angular-frequency-range", "1.2", "3"]
    assert run(["response", "--exact", *COLUMN, *arguments]) == 0
    told = capsys.readouterr().out
    for ends in ("1.62045 to 3 rad/s", "1.57112 to 1.62045 rad/s", "1.53333 to 1.53998 rad/s"):
        assert ends in told


def test_without_damping_the_table_says_neutrally_stable(capsys):
    arguments = ["--motion", "straight", "--acceleration", "0.04", "--angular-frequency-range", "2.9", "3.1"]
    assert run(["response", "--exact", "--slenderness", "0.1", *arguments]) == 0
    assert "where orbits are neutrally stable" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["response", "boundary"])
def test_help_offers_the_motions_that_have_their_options(command, capsys):
    assert run([command, "--help"]) == 0
    panel = capsys.readouterr().out.partition("Base motion:")[2].partition("Output:")[0]
    assert "circular, straight or elliptic" in " ".join(panel.split())
    assert not any(kind in panel for kind in ("stroke", "orbit", "vertical"))


@pytest.mark.parametrize("name", COMMANDS)
def test_help_lists_each_argument_once_and_no_bound_that_is_none(name, capsys):
    assert run([name, "--help"]) == 0
    shown = capsys.readouterr().out
    assert "None" not in shown
    assert shown.count("rguments:\n") <= 1


@pytest.mark.parametrize("name", COMMANDS)
def test_the_table_of_commands_has_the_first_line_of_each_help(name):
    summary = COMMANDS[name].summary
    assert COMMANDS[name].load().help.partition("\n")[0] == summary


def test_a_command_that_is_not_known_is_one_line_with_the_most_alike(capsys):
    assert run(["simulat"]) == 2
    assert capsys.readouterr().err == "stylobate: No such command 'simulat'. Did you mean simulate?\n"
