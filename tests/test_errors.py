"""The exception tree, and the checks that raise it."""

import ast
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate import errors
from stylobate.conveying.slip_limits import RollingRegime
from stylobate.errors import (
    LARGEST_SEED,
    ConfigError,
    FileError,
    Outcome,
    ParameterError,
    StylobateError,
    UnknownNameError,
    UnlikelyInputWarning,
    UnsupportedError,
    require_extra,
    require_finite,
    require_not_negative,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.results.findings import ClaimStatus


def test_every_exception_is_a_stylobate_error_and_bad_input_a_value_error():
    assert issubclass(ParameterError, StylobateError)
    assert issubclass(ParameterError, ValueError)
    assert issubclass(ConfigError, ParameterError)
    assert issubclass(UnsupportedError, StylobateError)
    assert issubclass(FileError, StylobateError)
    assert not issubclass(FileError, ValueError)


@pytest.mark.parametrize(
    ("make", "question"),
    [
        (lambda: sb.Column.solid(radius=0.1, hight=1.0, density=1.0), "'hight'; did you mean height?"),
        (lambda: sb.Harmonic.circular(aceleration=1.0, angular_frequency=1.0), "did you mean acceleration?"),
        (lambda: sb.simulate(None, tlit=(0.1, 0.0)), r"^simulate\(\) got an unexpected keyword argument 'tlit'"),
        (lambda: sb.simulate_ensemble(None, parametres={}), "did you mean parameters?"),
    ],
)
def test_an_unknown_argument_is_a_type_error_with_a_suggestion(make, question):
    with pytest.raises(TypeError, match=question.replace("?", r"\?")):
        make()


def test_an_unknown_public_name_has_a_suggestion():
    with pytest.raises(AttributeError, match=r"has no attribute 'Wobling'; did you mean Wobbling\?$"):
        _ = sb.Wobling
    with pytest.raises(AttributeError, match=r"has no attribute 'nothing_like_it'$"):
        _ = sb.nothing_like_it
    with pytest.raises(ParameterError, match=r"did you mean el centro 1940\?$"):
        sb.sample_record("elcentro")


def test_a_description_error_has_one_line_for_each_problem():
    error = ConfigError(["column.radius is missing", "duration is missing"])
    assert error.problems == ("column.radius is missing", "duration is missing")
    assert str(error).splitlines() == list(error.problems)


@pytest.mark.parametrize(
    ("check", "accepted", "refused", "demand"),
    [
        (require_finite, [-1.0, 0, 5], [math.nan, math.inf, -math.inf], "must be finite"),
        (require_positive, [1e-30, 1e15, 5], [0.0, -1.0, math.nan, math.inf], "must be positive"),
        (require_not_negative, [0.0, -0.0, 5], [-1e-300, math.nan, math.inf], "must be zero or positive"),
    ],
)
def test_checks_return_floats_or_name_argument_value_and_unit(check, accepted, refused, demand):
    for value in accepted:
        assert type(check("width", value, "m")) is float
        assert check("width", value, "m") == value
    for value in refused:
        with pytest.raises(ParameterError) as caught:
            check("width", value, "m")
        assert str(caught.value) == f"width {demand}, got {value!r} m"
    with pytest.raises(ParameterError, match=r"^width must be a real number, got \[1\]$"):
        check("width", [1], "m")


@pytest.mark.parametrize("value", ["5", "x", None, 1j, [1.0], {}, pytest.param(10**400, id="beyond floats")])
def test_what_is_no_real_number_is_refused(value):
    with pytest.raises(ParameterError, match=r"^width must be"):
        require_finite("width", value)


@pytest.mark.parametrize("value", [np.float32(0.5), np.int64(3), np.array(2.0), True])
def test_numbers_of_other_kinds_are_taken(value):
    assert require_finite("width", value) == float(value)


def test_vectors_are_checked_element_by_element():
    assert require_vector("tilt", np.array([1, 2]), 2) == (1.0, 2.0)
    assert require_vector("tilt", (number for number in (1, 2)), 2) == (1.0, 2.0)
    for value in ((1.0,), (1.0, 2.0, 3.0), 1.0, None):
        with pytest.raises(ParameterError, match=r"^tilt must have 2 numbers, got"):
            require_vector("tilt", value, 2)
    with pytest.raises(ParameterError, match=r"^tilt\[1\] must be finite, got nan rad$"):
        require_vector("tilt", (0.0, math.nan), 2, "rad")


def test_outcomes_have_codes_that_files_hold():
    names = [
        "AT_REST",
        "ROCKING",
        "ROLLING",
        "MODULATED",
        "OVERTURNED",
        "STILL_MOVING",
        "LIMIT_REACHED",
        "LIFTED_OFF",
        "FAILED",
        "SLID",
        "SURVIVED",
        "STOPPED",
        "PERIODIC",
        "APERIODIC",
    ]
    assert [Outcome[name].value for name in names] == list(range(len(names)))
    assert len(Outcome) == len(names)
    assert "StylobateError" in errors.__doc__


@pytest.mark.parametrize("check", [require_finite, require_positive, require_not_negative])
def test_sizes_whose_products_are_no_numbers_are_refused_with_the_bound(check):
    with pytest.raises(ParameterError) as caught:
        check("width", 2e20, "m")
    assert str(caught.value) == "width: too large to compute with (got 2e+20 m). Give at most 1e+15 m; check the unit."
    if check is not require_positive:
        assert check("width", 1e-300, "m") == 1e-300


def test_what_divides_is_refused_where_it_is_too_small_and_what_grows_with_volume_is_not():
    with pytest.raises(ParameterError) as caught:
        require_positive("width", 1e-31, "m")
    assert str(caught.value) == "width: too small to compute with (got 1e-31 m). Give at least 1e-30 m; check the unit."
    assert require_positive("mass", 1e-100, "kg") == 1e-100


def test_counts_beyond_memory_are_refused_and_large_integers_keep_all_digits():
    assert require_whole("seed", 2**62 + 1, least=0, most=LARGEST_SEED) == 2**62 + 1
    with pytest.raises(ParameterError) as caught:
        require_whole("samples", 2_000_000_000, least=2)
    assert str(caught.value) == (
        "samples: too large (got 2000000000). Give at most 10000000: each number takes memory."
    )


NAMED = [
    Outcome,
    sb.results.VerdictWord,
    ClaimStatus,
    sb.orbits.BifurcationKind,
    sb.orbits.BranchEnd,
    sb.earthquakes.FitStatus,
    sb.theory.BlockPhase,
    sb.theory.FirstMotion,
    sb.theory.SlidingRegime,
    sb.results.ContactClass,
    RollingRegime,
]


@pytest.mark.parametrize("kind", NAMED)
def test_what_is_found_equals_its_name_and_label_and_no_other_text(kind):
    for one in kind:
        assert one == one.name
        assert one == one.label
        assert one.name == one
        assert one in (one.name, None)
        assert not one != one.label  # noqa: SIM202  the other operator
        for other in kind:
            assert (one == other.name) is (one is other)
            assert (one != other.label) is (one is not other)
            assert (one == other) is (one is other)


@pytest.mark.parametrize("kind", NAMED)
def test_a_comparison_with_a_text_that_names_nothing_warns_and_suggests(kind):
    member = next(iter(kind))
    with pytest.warns(UnlikelyInputWarning, match=rf"^{kind.__name__}: .*did you mean {member.name}\?$") as caught:
        assert not member == f"{member.name}_"  # noqa: SIM201  the other operator
    assert caught[0].filename == __file__
    with pytest.warns(UnlikelyInputWarning, match="use one of"):
        assert member != "elephant"


def test_outcomes_stay_codes():
    assert Outcome.ROLLING == 2 == np.int8(2)
    assert hash(Outcome.ROLLING) == hash(2)
    assert Outcome.ROLLING != 3
    assert Outcome.ROLLING != None  # noqa: E711  the operator
    np.testing.assert_array_equal(np.arange(4) == Outcome.ROLLING, [False, False, True, False])
    assert {2: "rolls"}[Outcome.ROLLING] == "rolls"


def test_a_name_that_a_result_does_not_have_suggests_the_nearest():
    run = sb.simulate(sb.Slender(sb.Column.dimensionless(slenderness=0.1)), tilt=(0.01, 0.0), duration=1.0)
    cases = [
        (run.thresholds, "no_retrun_tilt", "did you mean no_return_tilt?"),
        (run.measures, "peaktilt", "did you mean peak_tilt?"),
        (run.provenance["column"], "radus", "did you mean radius?"),
        (run.measures, "colour", f"its names are {', '.join(run.measures)}"),
    ]
    for values, name, remedy in cases:
        with pytest.raises(KeyError) as caught:
            values[name]
        assert isinstance(caught.value, UnknownNameError)
        assert str(caught.value) == f"the result has no such name (got {name!r}); {remedy}"
        assert values.get(name) is None


def test_loaded_results_suggest_names_too(tmp_path):
    run = sb.simulate(sb.Slender(sb.Column.dimensionless(slenderness=0.1)), tilt=(0.01, 0.0), duration=1.0)
    loaded = sb.load(run.save(tmp_path / "run.nc"))
    with pytest.raises(UnknownNameError, match=r"did you mean turns\?"):
        loaded.measures["turn"]


@pytest.mark.parametrize(
    ("text", "lacking"),
    [
        ("import warnings\nwarnings.warn('of its own code', DeprecationWarning)\nVALUE = 3", False),
        ("import no_such_library", True),
        ("raise OSError('cannot load a library of the system')", True),
    ],
)
def test_an_optional_library_is_imported_without_its_warnings_or_named_with_the_remedy(
    tmp_path, monkeypatch, text, lacking
):
    name = f"made_up_{abs(hash(text))}"
    (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    if not lacking:  # the tests turn warnings into errors
        assert require_extra(name, "not installed").VALUE == 3
        return
    with pytest.raises(UnsupportedError, match=r"^it needs made_up: pip install made_up$"):
        require_extra(name, "it needs made_up: pip install made_up")


def test_no_optional_library_is_imported_in_a_second_way():
    root = Path(sb.__file__).parents[2]
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = [one for listed in project["optional-dependencies"].values() for one in listed]
    names = {re.split(r"[\[>=<]", one)[0].replace("-", "_") for one in extras} | {"distributed"}
    mentioned = re.compile(rf"\b(?:import|from) (?:{'|'.join(names)})\b")
    for path in Path(sb.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text) if mentioned.search(text) else ast.Module([], [])
        for node in ast.walk(tree):
            if not isinstance(node, ast.Try):
                continue
            for one in (inner for part in node.body for inner in ast.walk(part)):
                modules = [one.module or ""] if isinstance(one, ast.ImportFrom) else []
                modules += [alias.name for alias in one.names] if isinstance(one, ast.Import) else []
                assert not {module.split(".")[0] for module in modules} & names, path
