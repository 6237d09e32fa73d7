"""Fragility curves for other programs: NRML of OpenQuake, tables of pelicun, JSON of IN-CORE, and workbooks.

A lognormal curve has the median m and the dispersion β. NRML states mean and standard deviation of the intensity::

    mean = m exp(β²/2),    deviation = mean √(exp(β²) − 1)                                                 (1)

Formats: OpenQuake Engine Manual, "Fragility Models" (NRML 0.5); pelicun 3, damage model parameters; IN-CORE, DFR3
curves.
"""

import hashlib
import json
import math
import re
import unicodedata
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as ET

import numpy as np
import xarray as xr

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes.fragility.likelihood import FitStatus
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.intensities import Intensity, SpectralAcceleration, quantity_named
from stylobate.errors import ParameterError, require_name
from stylobate.files import csv_text, write_whole, write_workbook

_NRML = "http://openquake.org/xmlns/nrml/0.5"
_DAMPING = 0.05
# OpenQuake allows ASCII letters, digits and _ - : in names of limit states; pelicun separates parts of a name by "-".
_NRML_MARK, _PELICUN_MARK = "-", "."


class _Measure(NamedTuple):
    """An intensity as other programs name it; `factor` converts SI to their unit."""

    factor: float
    nrml: str
    pelicun: tuple[str, str]
    in_core: tuple[str, str]


class _State(NamedTuple):
    name: str
    median: float
    dispersion: float


def export_fragility(fits: xr.Dataset, path: str | Path, *, name: str, discrete: bool = False) -> Path:
    """Write fragility curves for another program, and return the path.

    Parameters
    ----------
    fits
        From `fit_fragility`, `fragility_of_runs` or `lognormal_fragility`, in peak ground acceleration or velocity or a
        spectral acceleration of 5 % damping. The limit states count as damage states, in the order of their severity.
    path
        The ending chooses the program: `.xml`, NRML 0.5 of OpenQuake; `.csv`, the table of pelicun, with a description
        beside it in a file of the same name that ends with `.json`; `.json`, a fragility of IN-CORE; `.xlsx`, a table
        of all numbers.
    name
        Name of the object: the taxonomy of OpenQuake, the component of pelicun. Their identifiers are in ASCII: see the
        how-to page on fragility. The description in the file states names and identifiers.
    discrete
        Whether NRML has the probabilities at the points of the curves instead of mean and deviation.

    Raises
    ------
    ParameterError
        If the ending is unknown, the intensity is none of these, a limit state has no fit, or a name is empty or holds
        a character that cannot be printed.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    if not isinstance(fits, xr.Dataset) or fits.attrs.get("kind") != "fragility":
        raise ParameterError(f"fits must come from fit_fragility or fragility_of_runs, got {type(fits).__name__}")
    require_name("name", name)
    if LIMIT_STATE not in fits.dims:
        fits = fits.expand_dims(LIMIT_STATE)
    if target.suffix == ".xlsx":
        return write_workbook(target, {"fragility": _table(fits)})
    if target.suffix not in _WRITERS:
        raise ParameterError(f"path must end with {', '.join(_WRITERS)} or .xlsx, got {str(path)!r}")
    if discrete and target.suffix != ".xml":
        raise ParameterError(f"discrete: applies to NRML (.xml) only, got {str(path)!r}. Leave it out")
    measure, states = _measure(fits), _states(fits)
    if discrete:
        return write_whole(target, _nrml_discrete(fits, measure, name))
    return _WRITERS[target.suffix](target, name, measure, states)


def _measure(fits: xr.Dataset) -> _Measure:
    about = fits["median"].attrs
    text = str(about.get("long_name", "")).removeprefix("median ")
    quantity = quantity_named("intensity", text.removesuffix(f", {about.get('component', '')}"))
    match quantity:
        case Intensity.PEAK_ACCELERATION:
            return _Measure(1.0 / STANDARD_GRAVITY, "PGA", ("Peak Ground Acceleration", "g"), ("PGA", "g"))
        case Intensity.PEAK_VELOCITY:
            return _Measure(100.0, "PGV", ("Peak Ground Velocity", "cmps"), ("PGV", "cm/s"))
        case SpectralAcceleration(period=period, damping=damping) if damping == _DAMPING:
            names = (f"Spectral Acceleration|{period:g}", "g"), (f"{period:g} SA", "g")
            return _Measure(1.0 / STANDARD_GRAVITY, f"SA({period:g})", *names)
    raise ParameterError(
        f"intensity: other programs do not know it (got {quantity.value!r}). Fit over PGA, PGV or SA of 5 % damping"
    )


def _states(fits: xr.Dataset) -> list[_State]:
    """Return the limit states; raise ParameterError for one without a fit."""
    states = []
    for place, name in enumerate(fits[LIMIT_STATE].to_numpy().tolist()):
        require_name(LIMIT_STATE, name)
        one = fits.isel({LIMIT_STATE: place})
        median, dispersion = float(one["median"]), float(one["dispersion"])
        if not (math.isfinite(median) and math.isfinite(dispersion) and dispersion > 0.0):
            status = FitStatus(int(one["status"])).name.lower().replace("_", " ") if "status" in one else "no fit"
            raise ParameterError(
                f"fits: {name!r} has no curve ({status}). Choose limit states with a fit by .sel(limit_state=[…])"
            )
        states.append(_State(str(name), median, dispersion))
    return states


_CODES = {" ": "_", "_": "{0}{0}", ".": "{0}dot{0}", ",": "{0}comma{0}", "-": "{0}dash{0}", "α": "{0}alpha{0}"}
_LETTER = re.compile(r"(?P<case>SMALL|CAPITAL)? ?LETTER (?:\w+ )*?(?P<letter>[A-Z]+)(?: WITH .*)?$")
_LONGEST = 75
"""Largest number of characters of an identifier (`MAX_ID_LENGTH` of `openquake.hazardlib.valid`)."""
_DIGEST = 16


def identifier(name: str, mark: str) -> str:
    """Return a name in letters, digits, underscores and `mark`; different names have different identifiers.

    A blank becomes an underscore, and an underscore becomes two marks. A word or the number of the character in
    Unicode stands between two marks in place of any other character; the Latin letter of a letter stands before it. An
    identifier of more than 75 characters is cut, and ends with a mark and 64 bits of the SHA-256 of the name.

    Parameters
    ----------
    name
        The name, not empty.
    mark
        A character that the other program allows in identifiers: "-" for NRML, "." for pelicun.

    Examples
    --------
    >>> identifier("tilt 0.1 α", "-"), identifier("Säule_2", "."), identifier("柱", "-")
    ('tilt_0-dot-1_-alpha-', 'Sa.u00e4.ule..2', '-u67f1-')
    """
    whole = "".join(one if one.isascii() and one.isalnum() else _code(one).format(mark) for one in name)
    if len(whole) <= _LONGEST:
        return whole
    cut = whole[: _LONGEST - len(mark) - _DIGEST]
    while cut.count(mark) % 2:  # a number of marks that is odd at the end is that of no short name
        cut = cut[:-1]
    return f"{cut}{mark}{hashlib.sha256(name.encode('utf-8', 'surrogatepass')).hexdigest()[:_DIGEST]}"


def _code(one: str) -> str:
    """Return the code of a character; {0} stands for the mark."""
    if one in _CODES:
        return _CODES[one]
    found = _LETTER.search(unicodedata.name(one, ""))
    letter = "" if found is None else found["letter"].title() if found["case"] == "CAPITAL" else found["letter"].lower()
    return f"{letter}{{0}}u{ord(one):04x}{{0}}"


def _described(name: str, states: Mapping[str, str]) -> str:
    """Return the description of a file: the name of the object, and the limit states by their identifiers."""
    meanings = "; ".join(f"{word} is {state!r}" for word, state in states.items() if word != state)
    return f"{name}, computed by stylobate" + (f"; {meanings}" if meanings else "")


def _nrml(name: str, states: Mapping[str, str], about: Mapping[str, str], fill: Callable[[ET.Element], None]) -> str:
    root = ET.Element("nrml", {"xmlns": _NRML})
    model = ET.SubElement(
        root, "fragilityModel", {"id": "stylobate", "assetCategory": "contents", "lossCategory": "contents"}
    )
    ET.SubElement(model, "description").text = _described(name, states)
    ET.SubElement(model, "limitStates").text = " ".join(states)
    function = ET.SubElement(model, "fragilityFunction", {"id": identifier(name, _NRML_MARK), **about})
    fill(function)
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _write_nrml(path: Path, name: str, measure: _Measure, states: list[_State]) -> Path:
    medians = [measure.factor * one.median for one in states]
    words = {identifier(one.name, _NRML_MARK): one.name for one in states}
    ends = {
        "minIML": f"{min(medians) * _FAR:.6g}",
        "maxIML": f"{max(medians) / _FAR:.6g}",
    }

    def fill(function: ET.Element) -> None:
        ET.SubElement(function, "imls", {"imt": measure.nrml, "noDamageLimit": "0", **ends})
        for median, one, word in zip(medians, states, words, strict=True):
            mean = median * math.exp(0.5 * one.dispersion**2)
            deviation = mean * math.sqrt(math.expm1(one.dispersion**2))
            ET.SubElement(function, "params", {"ls": word, "mean": repr(mean), "stddev": repr(deviation)})

    looks = {"format": "continuous", "shape": "logncdf"}
    return write_whole(path, _nrml(name, words, looks, fill))


_FAR = 0.05
"""Least intensity of a continuous curve over the least median, and the largest median over the largest intensity."""


def _nrml_discrete(fits: xr.Dataset, measure: _Measure, name: str) -> str:
    levels = measure.factor * fits["curve_intensity"].to_numpy()
    words = {identifier(one, _NRML_MARK): one for one in fits[LIMIT_STATE].to_numpy().tolist()}

    def fill(function: ET.Element) -> None:
        imls = ET.SubElement(function, "imls", {"imt": measure.nrml, "noDamageLimit": repr(float(levels[0]))})
        imls.text = " ".join(map(repr, levels.tolist()))
        for place, state in enumerate(words):
            chances = np.maximum.accumulate(fits["probability"].isel({LIMIT_STATE: place}).to_numpy())
            ET.SubElement(function, "poes", {"ls": state}).text = " ".join(map(repr, chances.tolist()))

    return _nrml(name, words, {"format": "discrete"}, fill)


def _write_pelicun(path: Path, name: str, measure: _Measure, states: list[_State]) -> Path:
    demand, unit = measure.pelicun
    word = identifier(name, _PELICUN_MARK)
    header = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    row: list[object] = [word, 0, demand, unit, 0, 1]  # else pelicun multiplies the demand by 1.2
    described = {}
    for place, one in enumerate(states, start=1):
        header += [f"LS{place}-Family", f"LS{place}-Theta_0", f"LS{place}-Theta_1", f"LS{place}-DamageStateWeights"]
        row += ["lognormal", measure.factor * one.median, one.dispersion, ""]
        described[f"LS{place}"] = {f"DS{place}": {"Description": one.name}}
    about = {word: {"Description": f"{name}, computed by stylobate", "LimitStates": described}}
    write_whole(path.with_suffix(".json"), json.dumps(about, indent=2, ensure_ascii=False) + "\n")
    return write_whole(path, csv_text(header, [row]))


def _write_in_core(path: Path, name: str, measure: _Measure, states: list[_State]) -> Path:
    demand, unit = measure.in_core
    curves = [
        {
            "className": "FragilityCurve",
            "description": one.name,
            "returnType": {"type": "Limit State", "unit": "", "description": f"LS_{place}"},
            "rules": [
                {
                    "condition": ["demand > 0"],
                    "expression": "scipy.stats.norm.cdf(math.log(demand), "
                    f"loc={math.log(measure.factor * one.median)!r}, scale={one.dispersion!r})",
                },
            ],
        }
        for place, one in enumerate(states)
    ]
    whole = {
        "description": f"{name}, computed by stylobate",
        "authors": ["stylobate"],
        "paperReference": None,
        "resultUnit": None,
        "resultType": "Limit State",
        "hazardType": "earthquake",
        "inventoryType": "contents",
        "demandTypes": [demand],
        "demandUnits": [unit],
        "curveParameters": [
            {"name": "demand", "unit": unit, "description": "intensity", "fullName": demand, "expression": None}
        ],
        "fragilityCurves": curves,
    }
    return write_whole(path, json.dumps(whole, indent=2, ensure_ascii=False) + "\n")


_WRITERS: dict[str, Callable[[Path, str, _Measure, list[_State]], Path]] = {
    ".xml": _write_nrml,
    ".csv": _write_pelicun,
    ".json": _write_in_core,
}


def _table(fits: xr.Dataset) -> list[list[object]]:
    names = [name for name in fits.data_vars if fits[name].dims == (LIMIT_STATE,)]
    header: list[object] = ["limit state"]
    for name in names:
        units = str(fits[name].attrs.get("units", "1")).replace("m s-2", "m/s²").replace("m s-1", "m/s")
        header.append(str(name).replace("_", " ") + ("" if units == "1" else f" [{units}]"))
    columns = [fits[name].to_numpy().tolist() for name in names]
    rows = zip(fits[LIMIT_STATE].to_numpy().tolist(), *columns, strict=True)
    return [header, *([*row] for row in rows)]
