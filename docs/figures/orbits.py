"""Draws the figures of "Exact periodic orbits" and "What exact orbits show" into docs/_static/orbits.

Run it with `python docs/figures/orbits.py`; it takes four minutes on two cores. The column is that of the paper,
c = η = 0.1, in its units.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "orbits"
C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(slenderness=C), damping=ETA)

# Okabe and Ito's colours, told apart by the colour-blind; line styles and markers repeat what they say.
BLUE, ORANGE, GREEN, GREY = "#0072b2", "#d55e00", "#009e73", "#777777"
MARKS = {"pitchfork": "D", "period doubling": "^", "Neimark-Sacker": "o", "fold": "s"}


def line(acceleration: float, angular_frequency: float = 8.0) -> sb.Harmonic:
    """Return a straight-line motion."""
    return sb.Harmonic.straight(
        acceleration=acceleration, angular_frequency=angular_frequency
    )


def ellipse(minor: float) -> sb.Harmonic:
    """Return an elliptic motion, anticlockwise, of the amplitude 0.08 along x."""
    return sb.Harmonic.elliptic(
        amplitude=(0.08, minor), phase=-np.pi / 2.0, angular_frequency=4.0
    )


def rolling(motion: sb.BaseMotion, bounds: tuple[float, float]) -> sb.orbits.Branch:
    """Return symmetric rolling against the frequency."""
    orbit = sb.orbits.periodic_orbit(MODEL, motion)
    return sb.orbits.continue_branch(orbit, "angular_frequency", bounds=bounds)


def first(branch: sb.orbits.Branch, kind: str) -> sb.orbits.Bifurcation:
    """Return the bifurcation of this kind at the highest frequency."""
    return max(
        (one for one in branch.bifurcations if one.kind.value == kind),
        key=lambda one: one.parameter,
    )


def draw_family(
    axes: Axes, branch: sb.orbits.Branch, colour: str, label: str, tilt: str
) -> None:
    """Draw mean or peak tilts: stable orbits bold, unstable ones thin and dashed, bifurcations marked."""
    points = branch.points
    x, y, stable = (
        points[name].to_numpy() for name in ("angular_frequency", tilt, "stable")
    )
    # A bifurcation is a point of the path and belongs to both sides.
    touching = stable | np.append(stable[1:], False) | np.append(False, stable[:-1])
    axes.plot(x, y / C, color=colour, linewidth=1.0, linestyle=(0, (4, 2)))
    axes.plot(
        x, np.where(touching, y / C, np.nan), color=colour, linewidth=2.6, label=label
    )
    for one in branch.bifurcations:
        filled = one.supercritical is not None
        axes.plot(
            one.parameter,
            getattr(one.orbit, tilt) / C,
            marker=MARKS[one.kind.value],
            color="black",
            markerfacecolor="black" if filled else "white",
            markersize=5.0,
            zorder=5,
        )


def response() -> Figure:
    """Frequency response: exact symmetric and asymmetric rolling beside the averaged solution."""
    figure = Figure(figsize=(7.4, 6.0), layout="constrained")
    panels = figure.subplots(2, 2, sharex="col", sharey="row")
    for column, (acceleration, low, high) in enumerate(
        ((0.04, 0.75, 1.75), (0.13, 1.25, 2.25))
    ):
        symmetric = rolling(line(acceleration), (low, 8.0))
        fine = sb.orbits.StepControl(largest=0.005)
        born = sb.orbits.switch_branch(
            first(symmetric, "pitchfork"), bounds=(low, 2.5), control=fine
        )
        theta = np.linspace(low, high, 600)
        steady = sb.theory.steady_rolling(theta, 0.5 * acceleration, c=C, eta=ETA).upper
        averaged = np.asarray(steady.amplitude) / C
        for axes, tilt in zip(
            panels[:, column], ("mean_tilt", "peak_tilt"), strict=True
        ):
            draw_family(axes, symmetric, BLUE, "symmetric rolling", tilt)
            draw_family(axes, born, ORANGE, "asymmetric rolling", tilt)
            bold = np.where(steady.stable, averaged, np.nan)
            axes.plot(theta, averaged, color="black", linewidth=0.6, linestyle=":")
            axes.plot(
                theta,
                bold,
                color="black",
                linewidth=1.4,
                linestyle=":",
                label="averaged",
            )
            axes.set_xlim(low, high)
        panels[0, column].set_title(f"$a_1/g = {acceleration}$", fontsize=10)
        panels[1, column].set_xlabel("base frequency $\\Omega/\\omega_0$")
    panels[0, 0].set_ylabel("mean tilt $\\theta/c$")
    panels[1, 0].set_ylabel("peak tilt $\\theta/c$")
    names = {
        "pitchfork": "pitchfork",
        "period doubling": "period doubling",
        "Neimark-Sacker": "Neimark–Sacker",
    }
    for kind, name in names.items():
        panels[0, 1].plot(
            [],
            [],
            marker=MARKS[kind],
            color="black",
            markersize=5.0,
            linestyle="none",
            label=name,
        )
    panels[0, 1].legend(fontsize=8, frameon=False)
    return figure


def paths() -> Figure:
    """Paths of the tilt before and after the pitchfork, a1 = 0.04."""
    symmetric = rolling(line(0.04), (0.9, 8.0))
    pitchfork = first(symmetric, "pitchfork")
    figure = Figure(figsize=(7.4, 3.7), layout="constrained")
    before, after = figure.subplots(1, 2, sharex=True, sharey=True)
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    for axes in (before, after):
        axes.plot(
            np.cos(angle), np.sin(angle), color=GREY, linewidth=0.8, linestyle=":"
        )
        axes.plot(0.0, 0.0, marker="+", color="black", markersize=7.0)
        axes.set_aspect("equal")
        axes.set_xlabel("tilt $\\theta_x/c$, along the base motion")
    before.plot(*closed_path(symmetric, 1.12), color=BLUE, linewidth=2.4)
    before.set_title("$\\Omega/\\omega_0 = 1.12$: one orbit, stable", fontsize=10)
    unstable = {"color": BLUE, "linewidth": 1.0, "linestyle": (0, (4, 2))}
    after.plot(*closed_path(symmetric, 1.07), **unstable, label="symmetric, unstable")
    for opposite, colour, style, name in (
        (False, ORANGE, "-", "asymmetric, stable"),
        (True, GREEN, (0, (6, 1.2)), "symmetry-related, stable"),
    ):
        born = sb.orbits.switch_branch(pitchfork, bounds=(0.9, 2.5), opposite=opposite)
        after.plot(
            *closed_path(born, 1.07),
            color=colour,
            linewidth=2.2,
            linestyle=style,
            label=name,
        )
    after.set_title("$\\Omega/\\omega_0 = 1.07$: three orbits", fontsize=10)
    after.legend(
        fontsize=7.5, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 0.08)
    )
    before.set_ylabel("tilt $\\theta_y/c$")
    return figure


def closed_path(branch: sb.orbits.Branch, value: float) -> np.ndarray:
    """Return tilts over c of the orbit at this frequency, back to the first."""
    path = branch.orbits_at(value)[0].path[:2] / C
    return np.append(path, path[:, :1], axis=1)


def draw_curve(
    axes: Axes,
    curve: sb.orbits.BifurcationCurve,
    colour: str,
    style: object,
    label: str,
) -> None:
    """Draw a curve in the plane of frequency and a second parameter."""
    x, y = zip(*(point.values for point in curve.path), strict=True)
    axes.plot(x, y, color=colour, linestyle=style, linewidth=1.8, label=label)


def curves() -> Figure:
    """Bifurcation curves: over frequency and amplitude, and from the straight line to the circle."""
    figure = Figure(figsize=(7.4, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    fine = sb.orbits.StepControl(largest=0.01)

    circle = rolling(
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=4.0), (0.8, 8.0)
    )
    bounds = ((0.3, 3.7), (0.002, 0.4))
    hopf = sb.orbits.bifurcation_curve(
        circle.bifurcations[0], "acceleration", bounds=bounds
    )
    draw_curve(left, hopf, BLUE, "-", "circle $a_0$: Neimark–Sacker")
    some = np.array([point.values[1] for point in hopf.path])[::6]
    left.plot(
        sb.theory.critical_frequency(some, c=C, eta=ETA),
        some,
        marker="o",
        markerfacecolor="none",
        color=BLUE,
        markersize=4.5,
        linestyle="none",
        label="circle, closed form",
    )
    straight = rolling(line(0.04), (0.6, 8.0))
    fork = sb.orbits.bifurcation_curve(
        straight.bifurcations[-1], "acceleration", bounds=bounds, control=fine
    )
    draw_curve(left, fork, ORANGE, (0, (6, 1.5)), "line $a_1$: pitchfork")
    a1 = np.linspace(0.0101, 0.4, 300)
    left.plot(
        sb.theory.critical_frequency(0.5 * a1, c=C, eta=ETA),
        a1,
        color=GREY,
        linestyle=":",
        linewidth=1.6,
        label="line $a_1$, averaged",
    )
    left.set_xlabel("base frequency $\\Omega/\\omega_0$")
    left.set_ylabel("amplitude $a_0/g$, $a_1/g$ of the base acceleration")
    left.set_xlim(0.4, 3.7)
    left.set_ylim(0.0, 0.4)
    left.legend(fontsize=8, frameon=False, loc="lower right")

    inset = right.inset_axes((0.6, 0.26, 0.26, 0.42))
    inset.yaxis.tick_right()
    bounds = ((0.4, 2.0), (0.0, 0.0835))
    half = rolling(ellipse(0.04), (0.9, 4.0))
    fork = sb.orbits.bifurcation_curve(
        half.bifurcations[-1], "amplitude_y", bounds=bounds, control=fine
    )
    open_circle = rolling(ellipse(0.08), (0.9, 4.0))
    tiny = sb.orbits.StepControl(first=1e-4, largest=1e-3)
    hopf = sb.orbits.bifurcation_curve(
        open_circle.bifurcations[-1], "amplitude_y", bounds=bounds, control=tiny
    )
    a2 = np.linspace(0.0, 0.08, 200)
    averaged = sb.theory.critical_frequency(0.5 * (0.08 + a2), c=C, eta=ETA)
    for axes in (right, inset):
        draw_curve(axes, fork, ORANGE, (0, (6, 1.5)), "pitchfork")
        draw_curve(axes, hopf, BLUE, "-", "Neimark–Sacker")
        axes.plot(
            averaged, a2, color=GREY, linestyle=":", linewidth=1.6, label="averaged"
        )
        axes.plot(
            sb.theory.critical_frequency(0.08, c=C, eta=ETA),
            0.08,
            "o",
            color="black",
            markersize=4.0,
        )
    meeting = hopf.path[0].values
    inset.plot(*meeting, "s", color="black", markerfacecolor="white", markersize=4.5)
    inset.annotate(
        "1:2", meeting, textcoords="offset points", xytext=(-18, 0), fontsize=8
    )
    inset.annotate(
        "circle",
        (1.50472, 0.08),
        textcoords="offset points",
        xytext=(-34, -2),
        fontsize=8,
    )
    inset.set_xlim(1.485, 1.511)
    inset.set_ylim(0.0768, 0.0809)
    inset.set_xticks([1.49, 1.50], ["1.49", "1.50"], fontsize=7)
    inset.set_yticks(
        [0.077, 0.078, 0.079, 0.080], ["0.077", "0.078", "0.079", "0.080"], fontsize=7
    )
    right.indicate_inset_zoom(inset, edgecolor="black", alpha=0.4)
    right.set_xlim(0.85, 2.15)
    right.set_ylim(0.0, 0.0835)
    right.set_xlabel("base frequency $\\Omega/\\omega_0$")
    right.set_ylabel("$a_2/g$ of an ellipse with $a_1/g = 0.08$")
    right.legend(fontsize=8, frameon=False, loc="upper left")
    return figure


def exact() -> Figure:
    """Exact frequency response of straight-line motion, a1 = 0.13."""
    return sb.plot(
        sb.studies.exact_response(MODEL, line(0.13), angular_frequency=(1.2, 3.0))
    )


def boundary_line() -> Figure:
    """Boundary of stable rolling, straight-line motion, over frequency and amplitude."""
    found = sb.studies.stability_boundary(
        MODEL,
        line(0.13),
        bounds=(0.012, 0.4),
        angular_frequency=(0.7, 2.8),
        values=[0.13],
    )
    return sb.plot(found)


def boundary_ellipse() -> Figure:
    """Boundary of stable rolling as an ellipse opens."""
    return sb.plot(
        sb.studies.stability_boundary(
            MODEL,
            ellipse(0.04),
            parameter="amplitude_y",
            bounds=(0.0, 0.08),
            angular_frequency=(0.9, 1.6),
        )
    )


def averaging() -> Figure:
    """Where averaging is right about straight-line motion."""
    found = sb.studies.averaging_map(
        MODEL,
        line(0.13),
        values=np.linspace(0.02, 0.4, 77),
        angular_frequency=np.geomspace(0.8, 8.0, 300),
    )
    figure = sb.plot(found)
    figure.axes[0].set_xscale("log")
    figure.axes[0].set_xticks([0.8, 1, 2, 4, 8], ["0.8", "1", "2", "4", "8"])
    figure.axes[0].minorticks_off()
    return figure


def sweeps() -> Figure:
    """Slow sweeps beside exact families: over the frequency to the end, over the amplitude down and up."""
    figure = Figure(figsize=(7.4, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    symmetric = rolling(line(0.13), (1.4, 8.0))
    born = sb.orbits.switch_branch(first(symmetric, "pitchfork"), bounds=(1.5, 2.5))
    draw_family(left, symmetric, BLUE, "symmetric", "peak_tilt")
    draw_family(left, born, ORANGE, "asymmetric", "peak_tilt")
    (start,) = symmetric.orbits_at(1.72)
    values = np.concatenate([np.arange(1.72, 1.6, -0.01), np.arange(1.6, 1.54, -0.002)])
    swept = sb.studies.slow_sweep(
        MODEL,
        start.motion,
        values=values,
        tilt=start.tilt,
        tilt_rate=start.tilt_rate,
        periods_each=300,
    )
    draw_sweep(left, swept, down="slow sweep down", up="slow sweep up")
    left.set_xlim(1.53, 1.73)
    left.set_ylim(0.6, 1.2)
    left.set_xlabel("base frequency $\\Omega/\\omega_0$")
    left.set_ylabel("peak tilt $\\theta/c$")

    start = sb.orbits.periodic_orbit(MODEL, line(0.03, 3.0))
    family = sb.orbits.continue_branch(start, "acceleration", bounds=(0.004, 0.031))
    points = family.points
    draw_family_over(right, points, "acceleration")
    values = np.append(
        np.arange(0.03, 0.0079, -0.002), [0.007, 0.0065, 0.006, 0.0055, 0.005]
    )
    swept = sb.studies.slow_sweep(
        MODEL,
        start.motion,
        parameter="acceleration",
        values=values,
        tilt=start.tilt,
        tilt_rate=start.tilt_rate,
        back=True,
    )
    draw_sweep(right, swept, down="slow sweep down", up="and up again")
    right.set_ylim(-0.01, 0.2)
    right.set_ylabel("peak tilt $\\theta/c$")
    right.set_xlabel("amplitude of the base acceleration $a_1/g$")
    for axes in (left, right):
        axes.legend(fontsize=8, frameon=False, loc="upper right")
    return figure


def draw_family_over(axes: Axes, points: xr.Dataset, name: str) -> None:
    """Draw the peak tilt of a family over any parameter, stable orbits bold."""
    x, y, stable = (points[key].to_numpy() for key in (name, "peak_tilt", "stable"))
    touching = stable | np.append(stable[1:], False) | np.append(False, stable[:-1])
    axes.plot(x, y / C, color=BLUE, linewidth=1.0, linestyle=(0, (4, 2)))
    axes.plot(
        x,
        np.where(touching, y / C, np.nan),
        color=BLUE,
        linewidth=2.6,
        label="symmetric",
    )


def draw_sweep(axes: Axes, swept: xr.Dataset, *, down: str, up: str) -> None:
    """Draw the peak tilt of a slow sweep, down and up, and a cross where the column overturned."""
    one = swept.isel(sweep=0)
    at, tilt = (
        one[str(swept.attrs["parameter"])].to_numpy(),
        one["peak_tilt"].to_numpy() / C,
    )
    turn = int(np.argmin(at))
    known = np.isfinite(tilt)
    axes.plot(
        at[: turn + 1],
        tilt[: turn + 1],
        marker="v",
        linestyle="none",
        color="black",
        markerfacecolor="none",
        markersize=6,
        label=down,
    )
    if turn < at.size - 1:
        axes.plot(
            at[turn + 1 :],
            tilt[turn + 1 :],
            marker="^",
            linestyle="none",
            color=GREY,
            markersize=4,
            label=up,
        )
    if not known.all():
        lost = int(np.argmin(known))
        axes.plot(
            at[lost],
            tilt[lost - 1],
            marker="X",
            color="black",
            linestyle="none",
            markersize=8,
            label="overturned",
        )


def chaos() -> Figure:
    """Poincaré sections of modulated and of chaotic rolling, and the largest Lyapunov exponents."""
    figure = Figure(figsize=(7.4, 3.6), layout="constrained")
    symmetric = rolling(line(0.13), (1.4, 8.0))
    born = sb.orbits.switch_branch(first(symmetric, "pitchfork"), bounds=(1.4, 2.5))
    for axes, value in zip(figure.subplots(1, 2), (1.56, 1.558), strict=True):
        orbit = born.orbits_at(value)[0]
        start = {"tilt": 1.0005 * np.array(orbit.tilt), "tilt_rate": orbit.tilt_rate}
        section = sb.studies.poincare_section(
            MODEL, orbit.motion, **start, periods=6000, skip=1000
        )
        found = sb.studies.lyapunov_exponents(
            MODEL, orbit.motion, **start, periods=5000, skip=1000, count=1
        )
        print(
            value,
            float(found["lyapunov_exponent"][0]),
            float(found["error"][0]),
            found.attrs["ending"],
        )
        points = section["section_tilt"].to_numpy()[0] / C
        axes.plot(*points.T, ".", color=BLUE, markersize=1.6, markeredgewidth=0.0)
        axes.plot(*(np.array(orbit.tilt) / C), "+", color="black", markersize=8)
        axes.set_title(f"$\\Omega/\\omega_0 = {value:g}$", fontsize=10)
        axes.set_xlabel("tilt $\\theta_x/c$")
        axes.set_ylabel("tilt $\\theta_y/c$")
    return figure


DRAWINGS = (
    response,
    paths,
    curves,
    exact,
    boundary_line,
    boundary_ellipse,
    averaging,
    sweeps,
    chaos,
)

if __name__ == "__main__":
    for draw in DRAWINGS:
        save(draw(), FOLDER / f"{draw.__name__}.png")
