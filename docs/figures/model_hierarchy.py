"""Draws the figures of the page "The model hierarchy" into docs/_static/hierarchy.

Run it with `python docs/figures/model_hierarchy.py`; it takes minutes on one core. Dimensionless columns, η = ζ = 0.1.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "hierarchy"
ETA = ZETA = 0.1

BLUE, SKY, VERMILION, AMBER, GREY = (
    "#0072B2",
    "#56B4E9",
    "#D55E00",
    "#E69F00",
    "#767676",
)


def circle(c: float, theta: float) -> sb.Harmonic:
    """Return the base motion on a circle of the figures, 0.65 c g."""
    return sb.Harmonic.circular(acceleration=0.65 * c, angular_frequency=theta)


def levels() -> Figure:
    """Histories of one case by all levels, and how they come together as c falls."""
    column = sb.Column.dimensionless(0.2)
    found = sb.studies.model_hierarchy(
        column,
        circle(0.2, 1.8),
        damping=ETA,
        spin_damping=ZETA,
        tilt=(0.08, 0.0),
        tilt_rate=(0.0, 0.14),
        duration=40.0,
        slenderness=[0.025, 0.05, 0.1, 0.2],
        samples=2000,
    )
    for name in (
        "peak_tilt",
        "mean_late_tilt",
        "peak_friction_demand",
        "peak_pivoting_demand",
    ):
        print((found[name] / found["slenderness"]).to_pandas().round(5), name)
    print(found["deviation_order"].to_pandas().round(3))
    return sb.plot(found)


def twist() -> Figure:
    """Where the assumption of no twist decides whether a released column overturns."""
    column = sb.Column.dimensionless(0.1)
    found = sb.studies.outcome_differences(
        sb.Wobbling(column, damping=ETA),
        sb.Rolling(column, damping=ETA, spin_damping=ZETA),
        circle(0.1, 1.0),
        over={
            "angular_frequency": np.linspace(0.5, 6.0, 150),
            "acceleration": np.linspace(0.05, 0.6, 120),
        },
        periods=60.0,
        demands=True,
    )
    decided = found["comparison"].to_numpy() == list(sb.studies.Comparison).index(
        sb.studies.Comparison.ONLY_FIRST
    )
    needed = found["second_peak_friction_demand"].to_numpy()[decided]
    print(
        np.median(needed),
        [(limit, np.mean(needed < limit)) for limit in (0.3, 0.5, 0.7)],
    )
    print(
        dict(
            zip(
                found["comparison_name"].to_numpy(),
                found["count"].to_numpy(),
                strict=True,
            )
        )
    )
    return sb.plot(found)


def path() -> Figure:
    """A column that the base spins up."""
    column = sb.Column.solid(radius=0.5, height=5.0, density=2700.0)
    motion = sb.Harmonic.circular(acceleration=1.27, angular_frequency=3.0)
    model = sb.Rolling(column, damping=ETA, spin_damping=0.5 * ZETA)
    run = sb.simulate(
        model, motion, tilt=(0.08, 0.0), tilt_rate=(0.0, 0.25), duration=6.0
    )
    print(run, run.data["spin"][-1].item())
    return sb.plots.plot_column_path(run)


def responses() -> Figure:
    """Steady rolling by all levels against the frequency, closed forms and marks from runs."""
    figure = Figure(figsize=(7.4, 3.9), layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    for axes, c in zip(panels, (0.1, 0.2), strict=True):
        theta = np.concatenate(
            [np.linspace(0.6, 1.6, 401), np.linspace(1.602, 4.0, 400)]
        )
        draw_theory(axes, theta, c)
        for level, at in (
            ("wobbling", (1.6, 2.2, 2.8, 3.4)),
            ("rolling", (1.7, 2.3, 2.9, 3.5)),
        ):
            for one in at:
                draw_run(axes, level, one, c)
        axes.set_title(f"$c = {c:g}$", fontsize=10)
        axes.set_xlabel("base frequency $\\Omega/\\omega_0$")
        axes.set_xlim(theta[0], theta[-1])
        axes.set_ylim(0.0, 0.75)
        axes.grid(color="#dddddd", linewidth=0.6)
    panels[0].set_ylabel("tilt of steady rolling, $\\theta/c$")
    panels[0].plot([], [], "o", markerfacecolor="none", color="black", label="simulate")
    add_legend(figure)
    return figure


def draw_theory(axes: Axes, theta: np.ndarray, c: float) -> None:
    """Draw the closed forms of all levels: stable solid, unstable dashed."""
    a0 = 0.65 * c
    paper = sb.theory.steady_rolling(theta, a0, c=c, eta=ETA)
    free = sb.theory.free_twist_rolling(theta, a0, c=c, eta=ETA, zeta=ZETA)
    wobbling = sb.theory.wobbling_rolling(theta, a0, c=c, eta=ETA)
    full = sb.theory.full_rolling(theta, a0, c=c, eta=ETA, zeta=ZETA)
    for branch in (paper.upper, paper.lower):
        draw_curve(axes, theta, branch.amplitude / c, branch.stable, SKY, 3.4)
    draw_curve(axes, theta, free.amplitude / c, free.stable, AMBER, 3.4)
    for found, colour in ((wobbling, BLUE), (full, VERMILION)):
        for index in range(found.amplitude.shape[-1]):
            draw_curve(
                axes,
                theta,
                found.amplitude[..., index] / c,
                found.stable[..., index],
                colour,
                1.2,
            )
    names = ("slender (the paper)", "slender rolling", "wobbling", "rolling")
    for name, colour, width in zip(
        names, (SKY, AMBER, BLUE, VERMILION), (3.4, 3.4, 1.2, 1.2), strict=True
    ):
        axes.plot([], [], color=colour, linewidth=width, label=name)
    axes.plot(
        [], [], color=GREY, linewidth=1.0, linestyle=(0, (4, 2)), label="unstable"
    )


def draw_curve(
    axes: Axes,
    x: np.ndarray,
    y: np.ndarray,
    stable: np.ndarray,
    colour: str,
    width: float,
) -> None:
    """Draw one branch."""
    thin = 0.5 * width + 0.3
    axes.plot(
        x,
        np.where(stable, np.nan, y),
        color=colour,
        linewidth=thin,
        linestyle=(0, (4, 2)),
    )
    axes.plot(x, np.where(stable, y, np.nan), color=colour, linewidth=width)


def draw_run(axes: Axes, level: str, theta: float, c: float) -> None:
    """Mark the mean tilt that a run settles on, begun a tenth beside the closed form."""
    column = sb.Column.dimensionless(c)
    model: sb.Model
    if level == "wobbling":
        model, found = (
            sb.Wobbling(column, damping=ETA),
            sb.theory.wobbling_rolling(theta, 0.65 * c, c=c, eta=ETA),
        )
    else:
        model = sb.Rolling(column, damping=ETA, spin_damping=ZETA)
        found = sb.theory.full_rolling(theta, 0.65 * c, c=c, eta=ETA, zeta=ZETA)
    branch = int(np.nanargmax(found.stable))
    if not found.stable[branch]:
        return
    tilt, lead = float(found.amplitude[branch]), float(found.phase[branch])
    lean = np.array([np.cos(lead), np.sin(lead)])
    spin = {"spin": float(found.spin[branch])} if level == "rolling" else {}
    start = {
        "tilt": 1.1 * tilt * lean,
        "tilt_rate": theta * tilt * np.array([-lean[1], lean[0]]),
        **spin,
    }
    run = sb.simulate(model, circle(c, theta), **start, duration=400.0)
    measured = run.measures.get("mean_tilt_late", np.nan)
    print(level, c, theta, run.outcome.name, measured / c, measured / tilt - 1.0)
    colour = BLUE if level == "wobbling" else VERMILION
    axes.plot(
        theta,
        measured / c,
        "o",
        markerfacecolor="white",
        color=colour,
        markersize=5,
        zorder=5,
    )


def add_legend(figure: Figure) -> None:
    """Name the lines of all panels above them."""
    entries = figure.axes[0].get_legend_handles_labels()
    figure.legend(
        *entries, loc="outside upper center", ncols=3, fontsize=8.5, frameon=False
    )


def dissipation() -> Figure:
    """The tilt of a free column for each damping parameter, three-dimensional and planar."""
    figure = Figure(figsize=(7.4, 3.4), layout="constrained")
    column = sb.Column.dimensionless(0.2)
    e = float(sb.theory.housner_restitution(0.2))
    eta = float(sb.theory.equivalent_viscous_damping(0.1, c=0.2, restitution=e))
    print(f"e {e:.6f}, equivalent friction {eta:.5f}")
    models = {
        "Housner's loss at the vertical": (sb.Rolling(column, restitution=e), SKY, 2.6),
        "viscous equivalent": (
            sb.Rolling(column, damping=eta, spin_damping=eta),
            BLUE,
            1.1,
        ),
        "rolling resistance 0.02 r": (
            sb.Rolling(column, rolling_resistance=0.02),
            VERMILION,
            1.1,
        ),
    }
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (title, rate) in zip(
        panels, {"planar": 0.0, "three-dimensional": 0.02}.items(), strict=True
    ):
        for name, (model, colour, width) in models.items():
            run = sb.simulate(
                model, tilt=(0.1, 0.0), tilt_rate=(0.0, rate), duration=60.0
            )
            energy = run.data["energy"].to_numpy()
            left = energy[-1] / energy[0]
            print(
                title,
                name,
                f"energy left {left:.5f}",
                run.outcome.name,
                run.measures["minimum_tilt"] / 0.2,
            )
            axes.plot(
                run.data["time"],
                energy / energy[0],
                color=colour,
                linewidth=width,
                label=name,
            )
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("time $\\omega_0 t$")
        axes.set_xlim(0.0, 60.0)
        axes.set_ylim(0.0, 1.05)
        axes.grid(color="#dddddd", linewidth=0.6)
    panels[0].set_ylabel("energy, relative to the start")
    add_legend(figure)
    return figure


DRAWINGS = (levels, twist, path, responses, dissipation)

if __name__ == "__main__":
    for drawing in DRAWINGS:
        save(drawing(), FOLDER / f"{drawing.__name__}.png")
