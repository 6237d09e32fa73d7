"""Stability boundary of rolling over the frequency of the base motion and a second parameter.

`stylobate boundary` shows it.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate import engine, orbits
from stylobate.base_motions import BaseMotion
from stylobate.config.options import Group, Option
from stylobate.errors import Interrupted, NoOrbitError, ParameterError, UnsupportedError, as_numbers, require_positive
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results.outcomes import LOSSES
from stylobate.results.tables import ResultTable
from stylobate.studies.responses.response_curves import FREQUENCIES, RESPONSE, STEADY_CASE, response_curves
from stylobate.studies.study import analysis
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.orbits import Bifurcation, BifurcationCurve, Branch, StepControl

_THEORY_POINTS = 201
# A bifurcation within this distance from a curve, as a fraction of the widths of the bounds, lies on the curve.
_ON_CURVE = 2e-3
# Maximum deviation of a curve from the chord of two of its points, as a fraction of the chord.
_BENT = 0.05

_BOUNDS = Option(
    "bounds", "lowest and highest value of the second parameter; required", tuple[str, str], metavar="NUMBER NUMBER"
)

_PARAMETER = Option(
    "parameter",
    "second parameter: acceleration (by default), amplitude-y, damping, slenderness",
    str,
    default="acceleration",
)
_AT = Option(
    "at",
    "value of the second parameter at which the search begins; repeat it; five across the bounds by default",
    list[float],
)


def _chosen(options: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the second parameter and its values; the unit of its bounds is that of the parameter."""
    if options["bounds"] is None:
        name = options["parameter"]
        raise ParameterError(f"--bounds: missing. Give the lowest and the highest {name}: --bounds LOW HIGH.")
    parameter = options["parameter"].replace("-", "_")
    bounds = replace(_BOUNDS, type=tuple[float, float], unit=quantity_of(parameter).unit)
    return {"parameter": parameter, "bounds": bounds.read(options["bounds"]), "values": options["at"]}


def _tables(result: "xr.Dataset") -> list[ResultTable]:
    parameter = str(result.attrs["parameter"])
    name = parameter.replace("_", " ")
    if not result.sizes["curve_index"]:
        (low, high), (least, most) = result.attrs["angular_frequency_range"], result.attrs["bounds"]
        none = (
            f"no loss of stability was found: rolling is {result.attrs['rolling']} wherever it was found from "
            f"{low:.6g} to {high:.6g} rad/s and {name} {least:.6g} to {most:.6g}"
        )
        return [ResultTable("", (), (), (none,))]
    unit = str(result[parameter].attrs.get("units", "")).replace(" s-2", "/s²").replace(" s-1", "/s")
    rows = []
    for index, kind in enumerate(result["curve_kind"].to_numpy()):
        part = result.isel(point=np.nonzero(result["curve"].to_numpy() == index)[0])
        for place in np.unique(np.linspace(0, part.sizes["point"] - 1, _ROWS_OF_A_CURVE).round().astype(int)):
            at = part.isel(point=int(place))
            value = f"{float(at[parameter]):.6g} {unit}".strip()
            loss = LOSSES[int(at["supercritical"])]
            rows.append([str(kind), f"{float(at['angular_frequency']):.8g} rad/s", value, loss])
    title = f"{plural(result.sizes['curve_index'], 'curve')}, a few points of each"
    return [ResultTable(title, ("bifurcation", "Ω", name, "loss of stability"), rows)]


_ROWS_OF_A_CURVE = 9


@analysis(
    replace(
        RESPONSE,
        name="boundary",
        help="""Compute the stability boundary of steady rolling over two parameters.

    The parameters are the frequency of the base and a second one. The result holds curves of pitchforks, Neimark–Sacker
    points and folds, and the critical frequency of theory. Example:

    stylobate boundary --slenderness 0.1 --damping 0.1 --motion straight --acceleration 0.1
    --angular-frequency-range 0.5 6 --bounds 0.02 0.4 --figure boundary.png
    """,
        groups=(Group.of("Options", _BOUNDS, _PARAMETER, _AT), FREQUENCIES.without("points"), *STEADY_CASE),
        arguments=lambda config, _: {"angular_frequency": config.angular_frequency_range},
        chosen=_chosen,
        instead=None,
        tables=_tables,
    )
)
@shows_progress("stability boundary")
def stability_boundary(
    model: Model,
    motion: BaseMotion,
    *,
    parameter: str = "acceleration",
    bounds: tuple[float, float],
    angular_frequency: tuple[float, float],
    values: Sequence[float] | None = None,
    sense: int | None = None,
    control: "StepControl | None" = None,
    progress: Progress = None,
) -> "xr.Dataset":
    """Compute the curves on which exact rolling loses stability, with the critical frequency of theory.

    At a few values of the parameter rolling is continued over the frequency. From each bifurcation at which it loses
    stability, a curve is continued in both parameters.

    Parameters
    ----------
    model, motion
        The column and a harmonic base motion.
    parameter, bounds
        Name of the second parameter, see `with_parameters`, and its lowest and highest value.
    angular_frequency
        Lowest and highest frequency [rad/s].
    values
        Values of the parameter at which rolling is continued over the frequency; by default five across the bounds.
    sense
        Sense of rolling, +1 or −1; by default that of the larger circular component of the base motion.
    control
        Length of steps along the curves.
    progress
        A function that is called with the number of values done and of all values; a bar by default, False for none.

    Returns
    -------
    xarray.Dataset
        Over `point`: `angular_frequency` [rad/s], the parameter, `curve`, `supercritical` (1 yes, 0 no, −1 not
        decided), `coefficient`. Over `curve_index`: `curve_kind`, `curve_end`. Over `theory_parameter`:
        `theory_frequency` [rad/s], the critical frequency (exact for circular motion, averaged otherwise), NaN if there
        is none.
        `attrs["rolling"]` states the stability of rolling at the points checked: "stable", "unstable" or both.

    Raises
    ------
    ParameterError
        If bounds or values are invalid, or there is no damping, without which nothing decays.
    NoOrbitError
        If rolling was found at none of the values.
    Interrupted
        On Ctrl-C; `partial` has the curves so far.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
    >>> boundary = sb.studies.stability_boundary(
    ...     model, motion, bounds=(0.05, 0.08), angular_frequency=(1.0, 3.0), values=[0.065]
    ... )
    >>> boundary["curve_kind"].values.tolist()
    ['Neimark-Sacker']
    """
    from stylobate.orbits.orbit import require_subject
    from stylobate.orbits.shooting import is_stable
    from stylobate.studies.checks import require_bounds, require_frequencies
    from stylobate.studies.responses.exact_response import between_bifurcations, first_orbit

    require_subject(model, motion)
    low, high = require_bounds(bounds, parameter)
    frequencies = require_frequencies(angular_frequency)
    _require_damping(model, parameter, low)
    values = as_numbers("values", values, quantity_of(parameter).unit)
    chosen = np.linspace(low, high, 5) if values is None else np.asarray(values, dtype=float)
    if chosen.size == 0 or not np.all((chosen >= low) & (chosen <= high)):
        raise ParameterError(f"values must lie between the bounds {(low, high)!r}, got {values!r}")
    curves: list[BifurcationCurve] = []
    looked_at: set[bool] = set()
    reason: Exception | None = None

    def result() -> "xr.Dataset":
        return (
            _joined(curves, parameter)
            .assign(_of_theory(model, motion, parameter, (low, high), sense))
            .assign_attrs(
                kind="stability boundary",
                parameter=parameter,
                bounds=[low, high],
                angular_frequency_range=list(frequencies),
                rolling=" or ".join(
                    name for name, seen in (("stable", True), ("unstable", False)) if seen in looked_at
                ),
                provenance=json.dumps(provenance_of_run(model, motion)),
            )
        )

    for done, value in enumerate(chosen):
        try:
            report_of(progress)(done, chosen.size)
            at = engine.with_parameters(model, motion, **{parameter: float(value)})
            try:
                orbit = first_orbit(*at, frequencies, sense)
            except NoOrbitError as error:
                reason = error
                continue
            branch = between_bifurcations(orbits.continue_branch(orbit, "angular_frequency", bounds=frequencies))
            looked_at |= {is_stable(point.multipliers) for point in branch.path}
            for one in losses(branch):
                if not any(_on(curve, one, float(value), frequencies, (low, high)) for curve in curves):
                    both = (frequencies, (low, high))
                    curves.append(orbits.bifurcation_curve(one, parameter, bounds=both, control=control))
        except KeyboardInterrupt as stop:
            partial = getattr(stop, "partial", None)
            curves += [partial] if isinstance(partial, orbits.BifurcationCurve) else []
            if not curves:
                raise
            raise Interrupted(
                f"stopped after {done} of {plural(chosen.size, 'value')}; `partial` has the curves so far", result()
            ) from None
    if not looked_at and reason is not None:
        raise NoOrbitError(str(reason))
    return result()


def losses(branch: "Branch") -> "list[Bifurcation]":
    """Return the bifurcations of a branch at which stability is lost or gained."""
    from stylobate.orbits.shooting import is_stable

    kinds = orbits.BifurcationKind
    followed = (kinds.FOLD, kinds.PITCHFORK, kinds.PERIOD_DOUBLING, kinds.NEIMARK_SACKER)
    found = []
    for one in branch.bifurcations:
        place = next(index for index, point in enumerate(branch.path) if point is one.point)
        around = [branch.path[k] for k in (place - 1, place + 1) if 0 <= k < len(branch.path)]
        stable = [is_stable(point.multipliers) for point in around]
        if one.kind in followed and len(set(stable)) > 1:
            found.append(one)
    return found


def _require_damping(model: Model, parameter: str, least: float) -> None:
    if parameter == "damping":
        require_positive("bounds: damping", least)
    elif not model.comes_to_rest:
        raise ParameterError(
            "damping must be above zero, got 0.0: without damping rolling is neutrally stable at best, and has no "
            "stability boundary"
        )


def _on(
    curve: "BifurcationCurve",
    one: "Bifurcation",
    value: float,
    frequencies: tuple[float, float],
    bounds: tuple[float, float],
) -> bool:
    """Return whether a bifurcation lies on a known curve."""
    if curve.kind is not one.kind:
        return False
    widths = np.array([frequencies[1] - frequencies[0], bounds[1] - bounds[0]])
    path = np.array([point.values for point in curve.path]) / widths
    here = np.array([one.parameter, value]) / widths
    if len(path) == 1:
        return bool(np.linalg.norm(path[0] - here) < _ON_CURVE)
    along = np.diff(path, axis=0)
    squares = np.sum(along**2, axis=1)
    # A curve that starts on the bound of a parameter may have a point twice: a chord of length zero.
    share = np.sum((here - path[:-1]) * along, axis=1) / np.where(squares > 0.0, squares, 1.0)
    gaps = np.linalg.norm(path[:-1] + np.clip(share, 0.0, 1.0)[:, np.newaxis] * along - here, axis=1)
    return bool(np.any(gaps < _ON_CURVE + _BENT * np.sqrt(squares)))


def _joined(curves: "list[BifurcationCurve]", parameter: str) -> "xr.Dataset":
    import xarray as xr

    tables = [curve.points for curve in curves]

    def column(name: str) -> np.ndarray:
        return np.concatenate([table[name].to_numpy() for table in tables]) if tables else np.empty(0)

    lengths = [table.sizes["point"] for table in tables]
    return xr.Dataset(
        {
            "curve": ("point", np.repeat(np.arange(len(tables)), lengths)),
            "supercritical": (
                "point",
                column("supercritical"),
                {"long_name": "1 if supercritical, 0 subcritical, -1 not decided"},
            ),
            "coefficient": ("point", column("coefficient"), {"long_name": "coefficient of the normal form"}),
            "minimum_tilt": ("point", column("minimum_tilt"), {"units": "rad"}),
            "peak_tilt": ("point", column("peak_tilt"), {"units": "rad"}),
            "curve_kind": ("curve_index", [curve.kind.value for curve in curves]),
            "curve_end": ("curve_index", ["; ".join(end.value for end in curve.ends) for curve in curves]),
        },
        coords={
            "angular_frequency": ("point", column("angular_frequency"), {"units": "rad s-1"}),
            parameter: ("point", column(parameter), attributes_of(parameter)),
        },
    )


def _of_theory(
    model: Model, motion: BaseMotion, parameter: str, bounds: tuple[float, float], sense: int | None
) -> dict[str, object]:
    """Return theory's critical frequency over the parameter; empty if there is none."""
    values = np.linspace(*bounds, _THEORY_POINTS)
    critical = np.full(values.size, np.nan)
    averaged = False
    for index, value in enumerate(values):
        try:
            curves = response_curves(
                *engine.with_parameters(model, motion, **{parameter: float(value)}), angular_frequency=[1.0]
            )
        except (UnsupportedError, ParameterError):
            continue
        averaged = averaged or bool(curves.attrs["averaged"])
        wanted = "clockwise" if sense == -1 else "anticlockwise"
        name = wanted if wanted in curves["sense"] and sense is not None else str(curves["sense"][0].item())
        critical[index] = float(curves["critical_frequency"].sel(sense=name))
    return {
        "theory_parameter": ("theory_parameter", values),
        "theory_frequency": ("theory_parameter", critical, {"units": "rad s-1", "long_name": "critical frequency"}),
        "theory_is_exact": ((), not averaged),
    }
