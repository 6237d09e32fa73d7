"""`stylobate simulate` states the verdict on its case beside the run, and no bare outcome of an undecided case."""

import json

import pytest

import stylobate as sb
from stylobate.cli.main import run
from stylobate.cli.simulate import VerdictOfCase
from stylobate.config.simulation import Setup

COLUMN = ["--radius", "0.3", "--height", "3", "--density", "2700", "--model", "wobbling", "--damping", "0.08"]
PULSE = ["--motion", "one-sine", "--angular-frequency", "4", "--acceleration"]
FEW = ["--verdict-runs", "60"]
MODEL = sb.Wobbling(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.08)


def pulse(acceleration):
    return sb.Pulse.one_sine(acceleration=acceleration, angular_frequency=4.0)


def rows_of(capsys, *arguments):
    """Return the rows of the printed table by label; a label without text continues the row above."""
    assert run(["simulate", *COLUMN, *arguments]) == 0
    rows, label = {}, ""
    for line in capsys.readouterr().out.splitlines():
        cells = [cell.strip() for cell in line.strip("│┃").split("│")]
        if len(cells) == 2 and cells[0] + cells[1]:
            label = cells[0] or label
            rows[label] = f"{rows.get(label, '')} {cells[1]}".strip()
    return rows


@pytest.mark.parametrize("acceleration", [1.0, 2.35, 6.0])
def test_the_table_has_the_verdict_the_model_and_the_yardstick_of_its_damping(capsys, acceleration):
    rows = rows_of(capsys, *PULSE, str(acceleration), *FEW)
    found = sb.verdict(MODEL, pulse(acceleration), runs=60)
    assert rows["verdict"] == str(found)
    assert rows["model"] == "wobbling, damping 0.08"
    assert rows["damping of Housner's impacts"].startswith("η = 0.12, 0.08, 0.064")
    assert ("decided most by" in rows) == bool(found.deciding)
    undecided = found.word is sb.results.VerdictWord.UNDECIDED
    assert undecided == (acceleration == 2.35)
    assert ("in this run alone; small variations leave it undecided" in rows["outcome"]) == undecided


@pytest.mark.parametrize(
    ("run_at", "verdict_at", "remark"),
    [
        (6.0, 1.0, "nearly all small variations do not overturn it"),
        (1.0, 6.0, "nearly all small variations overturn it"),
        (6.0, 2.35, "small variations leave it undecided"),
        (6.0, 6.0, ""),
        (1.0, 1.0, ""),
    ],
)
def test_a_run_that_does_not_state_the_verdict_says_so_in_table_and_titles(run_at, verdict_at, remark):
    case = VerdictOfCase(Setup(MODEL, pulse(run_at), {}), {}, "", None, None, None)
    alone, found = sb.simulate(MODEL, pulse(run_at)), sb.verdict(MODEL, pulse(verdict_at), runs=60)
    expected = f"{alone.outcome.label} in this run alone; {remark}" if remark else alone.outcome.label
    assert dict(case.rows(alone, found))["outcome"] == expected
    assert case.title(alone, found) == (expected if remark else None)


def test_the_figure_of_an_undecided_run_is_titled_so(tmp_path, capsys):
    page = tmp_path / "run.html"
    assert run(["simulate", *COLUMN, *PULSE, "2.35", *FEW, "--figure", str(page)]) == 0
    capsys.readouterr()
    assert "in this run alone; small variations leave it undecided" in page.read_text(encoding="utf-8")


def test_a_column_without_losses_has_the_warning_in_the_table(capsys):
    lossless = [*COLUMN[:-2], "--damping", "0"]
    assert run(["simulate", *lossless, *PULSE, "6", "--verdict-runs", "4"]) == 0
    printed = capsys.readouterr()
    assert "loses no energy while it rocks" in " ".join(printed.out.replace("│", " ").split())
    assert "loses no energy" not in printed.err


def test_a_single_run_says_that_variations_were_not_tried(capsys):
    rows = rows_of(capsys, *PULSE, "6", "--single")
    assert "verdict" not in rows
    assert rows["outcome"] == "overturned in this run; small variations were not tried (--single)"


def test_json_has_the_verdict_or_null(capsys):
    assert run(["simulate", *COLUMN, *PULSE, "2.35", *FEW, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert next(iter(printed)) == "verdict"
    told = printed["verdict"]
    found = sb.verdict(MODEL, pulse(2.35), runs=60)
    assert told["word"] == found.word.value
    assert (told["share"], told["share_low"], told["share_high"]) == (found.share, *found.interval)
    assert told["share_by_model"] == dict(found.share_by_model)
    assert run(["simulate", *COLUMN, *PULSE, "2.35", "--single", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["verdict"] is None


@pytest.mark.slow
def test_a_saved_verdict_is_repeated_and_drawn(capsys, tmp_path):
    saved, figure = tmp_path / "verdict.nc", tmp_path / "verdict.png"
    first = rows_of(capsys, *PULSE, "2.35", *FEW, "--verdict-output", str(saved), "--verdict-figure", str(figure))
    assert figure.stat().st_size > 10_000
    assert run(["simulate", str(saved), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["verdict"]["share"] == sb.load(saved).share
    assert str(sb.load(saved)) == first["verdict"]
    assert told["provenance"]["model"]["kind"] == "wobbling"


def test_a_description_changes_runs_seed_and_variations(capsys, tmp_path):
    study = tmp_path / "run.toml"
    study.write_text(
        """
[column]
shape = "solid"
radius = 0.3
height = 3.0
density = 2700.0
[model]
kind = "wobbling"
damping = 0.08
[motion]
kind = "one_sine"
acceleration = 2.35
angular_frequency = 4.0
[verdict]
runs = 40
seed = 3
[verdict.variations]
damping = { kind = "log_uniform", least = 0.05, most = 0.12 }
lowpass = false
""",
        encoding="utf-8",
    )
    assert run(["simulate", str(study), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["verdict"]
    changes = {"damping": sb.earthquakes.LogUniformSpread(0.05, 0.12), "lowpass": None}
    found = sb.verdict(MODEL, pulse(2.35), runs=40, seed=3, variations=changes)
    assert (told["runs"], told["share"]) == (40, found.share)


HARMONIC = ["--motion", "circular", "--acceleration", "1", "--angular-frequency", "4", "--duration", "3"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([*HARMONIC, *FEW], "--verdict-runs: there is no verdict (got a base motion that does not end)"),
        ([*HARMONIC, "--single"], "--single: there is no verdict (got a base motion that does not end)"),
        ([*PULSE, "2", "--single", *FEW], "--verdict-runs: there is no verdict (got small variations were not tried"),
        ([*PULSE, "2", "--verdict-figure", "x.bmp"], "cannot draw into x.bmp"),
        ([*PULSE, "2", "--verdict-runs", "1"], "runs must be a whole number of at least 2, got 1"),
    ],
)
def test_an_option_of_a_verdict_that_cannot_be_is_refused(capsys, arguments, message):
    assert run(["simulate", *COLUMN, *arguments]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.slow
def test_a_planar_model_and_a_sliding_one_have_no_verdict_by_default(capsys):
    slow = [*COLUMN[:6], "--damping", "0.08", *PULSE, "1.2"]
    for model, reason in (("planar-rocking", "planar model"), ("sliding", "--verdict-runs 300")):
        assert run(["simulate", *slow, "--model", model]) == 0
        assert reason in " ".join(capsys.readouterr().out.replace("│", " ").split())


@pytest.mark.long
def test_the_verdicts_on_the_front_pages_are_those_of_their_program(pytestconfig):
    texts = [(pytestconfig.rootpath / page).read_text(encoding="utf-8") for page in ("README.md", "docs/index.md")]
    printed, same = (text.partition("```text\n")[2].partition("```")[0].splitlines() for text in texts)
    assert same == printed
    column = MODEL.column
    model = sb.Wobbling(column, damping=column.housner_damping())
    quake = sb.sample_record("el centro 1940")
    scales = [float(line.partition(" ")[0]) for line in printed]
    assert all(f"for scale in {tuple(scales)}:" in text for text in texts)
    assert printed == [f"{scale} {sb.verdict(model, quake.scaled(scale), runs=1000)}" for scale in scales]
