"""Whatever stands on a command line or in a TOML file: a result, or one line for each mistake and status 2."""

import subprocess
import sys

import pytest
from tests.cli.fuzzing import SILENT, Case, Report, case

pytestmark = pytest.mark.posix  # a timer of processor time ends cases that say nothing

QUICK = ("simulate", "response", "map", "basin", "records", "spectrum", "fragility")


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)


def test_hostile_input_is_refused_or_computed(capsys):
    report = Report(processor_time=1.0)
    for seed in range(100):
        report.add(case(seed, QUICK), capsys)
    assert not [fault for fault in report.faults if fault[1] != SILENT]  # silence is measured with the full time
    assert report.counts["refused"] > 50
    assert report.counts["computed"] > 2


@pytest.mark.slow
def test_much_hostile_input_is_refused_or_computed(capsys):
    report = Report()
    for seed in range(10_000):
        report.add(case(seed), capsys)
    assert not report.faults, (dict(report.counts), report.longest)


def outcome_in_a_process(one):
    ended = subprocess.run(
        [sys.executable, "-m", "stylobate", *one.arguments], capture_output=True, text=True, check=False, timeout=300
    )
    return ended.returncode, ended.stderr.splitlines()


@pytest.mark.slow
def test_hostile_input_ends_a_process_as_it_ends_a_call(tmp_path):
    for seed in range(40):
        one = case(seed, QUICK)
        if any("\0" in argument for argument in one.arguments):
            continue
        if one.toml is not None:
            (tmp_path / "study.toml").write_text(one.toml, encoding="utf-8", errors="surrogatepass")
        status, lines = outcome_in_a_process(one)
        assert status in (0, 2)
        assert all(line.startswith("stylobate: ") for line in lines) or status == 0, lines


BASE = "--slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.06 --angular-frequency 1.8"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (f"map {BASE} --x damping 0 1 2000000000 --y delay 0 1 2 --periods 3", "map.x: number: too large"),
        (f"map {BASE} --x damping 0 1 900000 --y delay 0 1 900000 --periods 3", "the results of 8.1e+11 runs take"),
        (f"basin {BASE} --random 2000000000000 --over tilt-x 0 0.1 --periods 9", "basin: random: too large"),
        (f"simulate {BASE} --duration 3 --samples 2000000000", "samples: too large"),
        (f"map {BASE} --x damping 0 1 3 --y delay 0 1 2 --periods 3 --threads 2147483648", "threads: too large"),
        (f"simulate {BASE} --duration 3 --angular-frequency 5e-324", "motion: angular_frequency: too small"),
        ("simulate --radius 1e-200 --height 1 --density 2000 --duration 3", "column: radius: too small"),
        (f"simulate {BASE} --duration 3 --start-phase 1e300", "motion: start_phase: too large"),
        ("simulate study\0.toml", "the command line: an argument holds a NUL character"),
        (
            "boundary --slenderness 0.1 --motion straight --acceleration 1 --angular-frequency-range 1 2",
            "--bounds: missing",
        ),
        (f"response {BASE[:67]} --angular-frequency-range 1 2 --points 2000000000", "points: points: too large"),
    ],
)
def test_numbers_beyond_what_can_be_are_named_with_a_remedy(arguments, line, capsys):
    report = Report()
    report.add(Case(tuple(arguments.split(" "))), capsys)
    assert not report.faults
    assert report.counts["refused"] == 1
    assert line in report.told[0]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a = " + "[" * 10_000 + "]" * 10_000, "nested too deeply"),
        ("a" + ".b" * 1000 + " = 1", "nested too deeply"),
        ("[motion]\nkind = []", "motion.kind: must be a word (got a list). Write it in quotation marks."),
        ("[model]\nkind = {a = 1}", "model.kind: must be a word (got a table). Write it in quotation marks."),
        ('[motion]\nkind = "record"\npath = "a\\u0000b"', "motion.path: holds a NUL character"),
    ],
)
@pytest.mark.parametrize("command", ["simulate", "response", "map", "fragility", "assess"])
def test_values_of_files_that_no_description_can_have_are_named(command, text, line, capsys):
    report = Report()
    report.add(Case((command, "study.toml"), text), capsys)
    assert not report.faults
    assert line in report.told[0]
