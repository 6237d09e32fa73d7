"""A sheet of all kinds of figures × light, dark, one column of a journal, slide: for looking at before a release.

    python tools/figure_sheet.py figure-sheet [kind …]

writes one picture per kind and look, and `index.html`, which shows them side by side. The results are small.
"""

import sys
from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

LOOKS: dict[str, tuple[str, Any]] = {
    "light": ("default", None),
    "dark": ("dark_background", None),
    "column": ("default", 3.5),
    "slide": ("default", (13.3, 7.5)),
}
STONE = sb.Column.solid(radius=0.35, height=5.2, density=2700.0)
PIN = sb.Sliding(sb.Column.solid(radius=0.03, height=0.2, density=884.0), friction_coefficient=0.25)
STOUT = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
LIMITS = [
    sb.earthquakes.LimitState(response="slip", limit=0.05),
    sb.earthquakes.LimitState(response="edge", limit=0.15),
]
SLENDER = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
WOBBLING = sb.Wobbling(STONE, damping=0.05)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=1.6)
FEEDER = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.44)
PULSE = sb.Pulse.ricker(acceleration=2.0, angular_frequency=4.0)
STARTS = {"tilt_x": np.linspace(-0.1, 0.1, 41), "tilt_y": np.linspace(-0.1, 0.1, 41)}
BOX = {"tilt_x": (-0.1, 0.1), "tilt_y": (-0.1, 0.1)}
STEADY = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07)}


def quakes() -> dict[str, sb.Record]:
    """Return synthetic records of one kind."""
    noise = sb.records.EvolvingNoise(arias=1.2, duration_5_95=8.0, middle_time=5.0, frequency=2.5, bandwidth=0.3)
    made = (noise.record(np.random.default_rng(seed), components=2, step=0.02) for seed in range(8))
    return {f"motion {place}": record.trimmed(0.0, 14.0).scaled_to(1.0) for place, record in enumerate(made)}


def branch() -> sb.orbits.Branch:
    """Return a branch of planar orbits through a pitchfork."""
    orbit = sb.orbits.periodic_orbit(SLENDER, LINE)
    return sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.4, 1.9))


def incremental() -> Any:
    """Return runs under scaled records."""
    return sb.earthquakes.incremental_dynamic_analysis(
        WOBBLING, quakes(), scales=np.linspace(0.2, 2.0, 12), rotations=(0.0,)
    )


def counted_rate() -> Any:
    """Return the annual rate counted from the runs of an incremental dynamic analysis."""
    runs = incremental()
    intensity = np.geomspace(0.5, 20.0, 30)
    hazard = sb.earthquakes.HazardCurve(
        intensity=intensity,
        rate=1e-2 / intensity**2,
        units="m s-2",
        quantity="peak ground acceleration",
        component="RotD50",
    )
    return sb.earthquakes.empirical_rate(
        runs["intensity"], runs["reached"], hazard, record=runs["record"], rng=np.random.default_rng(0)
    )


def reached() -> Any:
    """Return the intervals of these runs that overturned."""
    runs = incremental()
    return sb.earthquakes.reached_intervals(runs["intensity"], runs["outcome"] == int(sb.Outcome.OVERTURNED))


RESULTS: dict[str, Callable[[], Any]] = {
    "column": lambda: STONE,
    "harmonic motion": lambda: CIRCLE,
    "pulse": lambda: PULSE,
    "record": sb.sample_record,
    "run": lambda: sb.simulate(WOBBLING, sb.sample_record()),
    "runs": lambda: [
        sb.simulate(sb.Wobbling(STONE, damping=eta), sb.sample_record().scaled(0.7)) for eta in (0.02, 0.05, 0.1)
    ],
    "planar run": lambda: sb.simulate(sb.PlanarRocking(STONE, damping=0.05), PULSE),
    "conveyed part": lambda: sb.simulate(PIN, FEEDER, tilt=(1e-3, 0.0), duration=1.0),
    "periodic orbit": lambda: sb.orbits.periodic_orbit(SLENDER, LINE),
    "verdict": lambda: sb.verdict(WOBBLING, sb.sample_record()),
    "ensemble": lambda: sb.simulate_ensemble(
        WOBBLING, sb.sample_record(), duration=90.0, parameters={"scale": np.linspace(0.2, 2.0, 120)}
    ),
    "overturning map": lambda: sb.studies.overturning_map(
        SLENDER,
        CIRCLE,
        over={"angular_frequency": np.linspace(0.5, 4.0, 60), "acceleration": np.linspace(0.02, 0.3, 50)},
        periods=60,
        **STEADY,
    ),
    "basins": lambda: sb.studies.basins(SLENDER, LINE, over=STARTS, periods=200),
    "attractors": lambda: sb.studies.attractors(SLENDER, LINE, over=BOX, count=200, periods=200),
    "basin fractions": lambda: sb.studies.basin_fractions(
        SLENDER, LINE, along={"acceleration": np.linspace(0.05, 0.3, 12)}, over=BOX, count=150, periods=150
    ),
    "integrity": lambda: sb.studies.integrity(SLENDER, LINE, over=STARTS, periods=60),
    "erosion": lambda: sb.studies.erosion(
        SLENDER, LINE, along={"acceleration": np.linspace(0.05, 0.3, 6)}, over=STARTS, periods=40
    ),
    "uncertainty exponent": lambda: sb.studies.uncertainty_exponent(
        SLENDER, LINE, over=BOX, shifted="tilt_x", periods=100, count=400
    ),
    "response curves": lambda: sb.studies.response_curves(SLENDER, CIRCLE, angular_frequency=(0.3, 4.0)),
    "exact response": lambda: sb.studies.exact_response(SLENDER, LINE, angular_frequency=(1.2, 3.0)),
    "stability boundary": lambda: sb.studies.stability_boundary(
        SLENDER, CIRCLE, bounds=(0.03, 0.08), angular_frequency=(1.0, 3.0)
    ),
    "averaging map": lambda: sb.studies.averaging_map(
        SLENDER, LINE, values=np.linspace(0.05, 0.3, 12), angular_frequency=np.geomspace(1.0, 4.0, 40)
    ),
    "slow sweep": lambda: sb.studies.slow_sweep(
        SLENDER, CIRCLE, values=np.linspace(1.8, 1.3, 20), periods_each=60, **STEADY
    ),
    "Poincaré section": lambda: sb.studies.poincare_section(SLENDER, LINE, **STEADY, periods=400, skip=100),
    "Lyapunov exponents": lambda: sb.studies.lyapunov_exponents(SLENDER, LINE, **STEADY, periods=200),
    "branch": branch,
    "bifurcation curve": lambda: sb.orbits.bifurcation_curve(
        branch().bifurcations[0], "acceleration", bounds=((1.3, 1.9), (0.1, 0.16))
    ),
    "after bifurcation": lambda: sb.studies.after_bifurcation(
        branch().bifurcations[0], values=[1.63, 1.6, 1.55], count=10, periods=200.0
    ),
    "outcome differences": lambda: sb.studies.outcome_differences(
        SLENDER,
        sb.SlenderRolling(SLENDER.column, damping=0.1),
        CIRCLE,
        over={"angular_frequency": np.linspace(0.5, 3.0, 20), "acceleration": np.linspace(0.02, 0.2, 16)},
        periods=40.0,
    ),
    "model hierarchy": lambda: sb.studies.model_hierarchy(
        STONE, sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0), tilt=(0.03, 0.0), duration=8.0
    ),
    "incremental dynamic analysis": incremental,
    "slip analysis": lambda: sb.earthquakes.slip_analysis(
        sb.Sliding(STOUT, friction_coefficient=0.12), quakes(), scales=np.geomspace(0.8, 8.0, 25), limit_states=LIMITS
    ),
    "slip paths": lambda: sb.earthquakes.slip_paths(
        sb.Sliding(STOUT, friction_coefficient=0.12), quakes(), scale=3.0, limit_states=LIMITS
    ),
    "fragility": lambda: sb.earthquakes.fragility_of_runs(incremental()),
    "annual rate": lambda: sb.earthquakes.annual_rate(
        sb.earthquakes.lognormal_fragility(3.0, 0.4),
        sb.earthquakes.HazardCurve(intensity=np.geomspace(0.5, 20.0, 30), rate=1e-2 / np.geomspace(0.5, 20.0, 30) ** 2),
    ),
    "empirical annual rate": counted_rate,
    "reached intervals": reached,
    "overturning intervals": lambda: sb.earthquakes.overturning_intervals(
        WOBBLING, PULSE, scales=np.geomspace(0.3, 4.0, 40), over={"size": np.geomspace(0.5, 2.0, 9)}
    ),
    "overturning intervals of one": lambda: sb.earthquakes.overturning_intervals(
        WOBBLING, sb.sample_record(), scales=np.linspace(0.3, 2.0, 60)
    ),
    "record selection": lambda: sb.earthquakes.select_records(
        list(quakes().values()),
        sb.results.DesignSpectrum(period=(0.05, 0.15, 0.5, 2.5), acceleration=(4.0, 9.0, 9.0, 1.8)),
        number=3,
        scales=(0.25, 20.0),
    ),
    "inventory": lambda: sb.earthquakes.inventory(
        [
            sb.earthquakes.InventoryObject(
                name=f"column {place}",
                column={"radius": 0.06 + 0.01 * place, "height": 1.6, "density": 2400.0},
                model={"damping": 0.05},
                friction_coefficient=0.05 if place == 1 else 0.6,  # one slides
                spreads={"radius": sb.earthquakes.LognormalSpread(0.03)},
            )
            for place in range(12)
        ],
        quakes(),
        samples=6,
    ),
    "rocking spectrum": lambda: sb.earthquakes.rocking_spectrum(
        WOBBLING, sb.sample_record(), over={"size": np.geomspace(0.3, 3.0, 25), "scale": [0.5, 1.0]}
    ),
    "planar bias": lambda: sb.earthquakes.planar_bias(
        WOBBLING, dict(list(quakes().items())[:3]), scales=np.geomspace(0.3, 3.0, 8), directions=[0.0, 0.8, 1.6, 2.4]
    ),
    "start boundary": lambda: sb.conveying.start_boundary(
        PIN, slenderness=np.linspace(0.02, 0.8, 80), friction_coefficient=[0.1, 0.3], vertical_ratio=[0.0, 1.0]
    ),
    "slipping boundary": lambda: sb.conveying.slipping_boundary(
        sb.Wobbling(SLENDER.column, damping=0.1, constraint="rubber"),
        CIRCLE,
        friction_coefficient=np.linspace(0.005, 0.13, 40),
        angular_frequency=np.linspace(0.6, 8.0, 80),
    ),
    "contact map": lambda: sb.conveying.contact_map(
        PIN,
        sb.Harmonic.oblique(acceleration=10.0, angular_frequency=300.0, angle=0.5),
        over={"acceleration": np.linspace(2.0, 30.0, 20), "friction_coefficient": np.linspace(0.1, 0.6, 16)},
        periods=20.0,
    ),
    "upright": lambda: sb.conveying.upright(PIN, FEEDER, phases=8, periods=20),
    "drift": lambda: sb.conveying.drift(
        PIN,
        sb.Harmonic.oblique(acceleration=10.0, angular_frequency=300.0, angle=0.5),
        over={"acceleration": np.linspace(2.0, 30.0, 15)},
        periods=30,
        late=10,
    ),
}


def main() -> int:
    """Draw the kinds of the command line, or all, into the folder; return the number of those that failed."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    chosen = sys.argv[2:] or list(RESULTS)
    failed = []
    for kind in chosen:
        try:
            result = RESULTS[kind]()
            for look, (style, size) in LOOKS.items():
                with plt.style.context(style):
                    figure = sb.plot(result, size=size)
                figure.savefig(folder / f"{kind.replace(' ', '-')}-{look}.png", dpi=60 if look == "slide" else 110)
        except Exception as error:  # noqa: BLE001  the others are drawn
            failed.append(kind)
            print(f"{kind}: {type(error).__name__}: {error}", file=sys.stderr)
        else:
            print(kind, flush=True)
    rows = "".join(_row(kind) for kind in RESULTS)
    (folder / "index.html").write_text(f'<!DOCTYPE html><meta charset="utf-8"><title>Figures</title>{rows}\n')
    return len(failed)


def _row(kind: str) -> str:
    name = kind.replace(" ", "-")
    pictures = "".join(f'<img src="{name}-{look}.png" alt="{look}" style="max-width:24%">' for look in LOOKS)
    return f"<h2>{escape(kind)}</h2><div>{pictures}</div>"


if __name__ == "__main__":
    sys.exit(main())
