"""What `import stylobate` offers."""

import inspect
import subprocess
import sys
from importlib.metadata import version

import pytest

import stylobate


@pytest.mark.parametrize("name", stylobate.__all__)
def test_every_public_name_resolves_and_is_explained(name):
    value = getattr(stylobate, name)
    if name == "__version__":
        assert value == version("stylobate")
    else:
        assert len(inspect.getdoc(value) or "") > 10


def public_members(cls):
    # `rates` is the equations, described by its class.
    return [name for name in vars(cls) if name[0] != "_" and name != "rates" and callable(getattr(cls, name, None))]


@pytest.mark.parametrize("name", ["BaseMotion", "Column", "Harmonic", "Model", "Pulse", "Run", "SineSweep", "Slender"])
def test_every_public_method_is_explained(name):
    cls = getattr(stylobate, name)
    for member in public_members(cls):
        assert inspect.getdoc(getattr(cls, member)), f"{name}.{member}"


def fresh(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def test_importing_takes_no_numpy_and_little_time():
    code = (
        "import sys, time; start = time.process_time(); import stylobate; took = time.process_time() - start; "
        "heavy = {'numpy', 'scipy', 'xarray', 'matplotlib', 'pydantic', 'click'} & set(sys.modules); "
        "print(sorted(heavy), took < 0.3)"
    )
    assert fresh(code) == "[] True"


def test_theory_needs_no_scipy_and_no_xarray():
    code = (
        "import sys, stylobate; stylobate.theory; print(sorted({'scipy', 'xarray', 'matplotlib'} & set(sys.modules)))"
    )
    assert fresh(code) == "[]"


def test_rules_of_practice_need_no_scipy_and_no_xarray_before_they_see_a_base_motion():
    code = (
        "import sys, stylobate; stylobate.practice.west; stylobate.practice.Shaking; "
        "print(sorted({'scipy', 'xarray', 'pydantic', 'matplotlib'} & set(sys.modules)))"
    )
    assert fresh(code) == "[]"


def test_an_ensemble_imports_neither_dask_nor_scipy():
    code = (
        "import sys, stylobate as sb; model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1); "
        "sb.simulate_ensemble(model, tilt=[(0.05, 0.0)], duration=1.0, parameters={'damping': [0.1]}); "
        "print(sorted({'dask', 'scipy', 'pint', 'matplotlib'} & set(sys.modules)))"
    )
    assert fresh(code) == "[]"


def test_of_all_models_only_the_defaults_are_built_as_descriptions():
    code = (
        "import stylobate.config.simulation; from stylobate.config.parts import DESCRIBED_MODELS; "
        "print(*(one.__name__ for one in DESCRIBED_MODELS if one.__pydantic_complete__))"
    )
    assert fresh(code) == "SlenderModel WobblingModel"


def test_dir_lists_the_public_names():
    assert dir(stylobate) == sorted(stylobate.__all__)
    assert len(set(stylobate.__all__)) == len(stylobate.__all__)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match=r"no attribute 'colum'; did you mean Column\?"):
        stylobate.colum  # noqa: B018


def test_names_are_the_same_objects_wherever_they_are_reached():
    from stylobate.column import Column
    from stylobate.engine import simulate

    assert stylobate.Column is Column
    assert stylobate.simulate is simulate
