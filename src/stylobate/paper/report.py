"""The report on the source paper: its figures as files, its findings as a table, all of it on one page."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from stylobate.errors import FileError
from stylobate.files import write_whole
from stylobate.paper import figures, twist_figures
from stylobate.plots.exact_response import plot_exact_response
from stylobate.plots.page import Picture, Section, Table, page, png_of
from stylobate.plots.stability_boundary import plot_stability_boundary
from stylobate.results import Finding, PaperCheck, write_netcdf

_TITLE = "A round column on a vibrating base: the source paper reproduced, checked and corrected"

_INTRODUCTION = (
    "The paper, A. Munitsyn and M. Munitsyna, “Dynamic of a cylindrical column on a vibrating base” "
    "(Vibroengineering Procedia, 2021), studies a slender "
    "free-standing column with a circular base under harmonic base motion. This page repeats its curves from its "
    "equations, measures each of its statements, corrects its misprints, and says where a statement fails. Numbers in "
    "parentheses are the paper's equations.",
    "Units: angles in rad, time τ = ω₀t, frequency θ = θ₀/ω₀, accelerations in g. Unless said otherwise c = η = 0.1, "
    "the numbers of the paper's figures. Every number below was computed when this page was made.",
)

_SYMBOLS = Table(
    ("symbol", "meaning"),
    (
        ("r, h; c = r/h", "base radius, height of the centre of mass; slenderness, the tilt at which the column tips"),
        ("ω₀ = √(mgh/J₀)", "frequency scale; J₀ the moment of inertia about a diameter of the base"),
        ("α = (α₁, α₂); A, β", "tilt vector: where the column leans and by how much; its length and its azimuth"),
        ("μ = dA/dτ, ω = dβ/dτ", "tilt rate; rate at which the contact point rolls round the rim"),
        ("a0; a1, a2", "amplitude of circular base motion; amplitudes along the two axes"),
        ("ψ", "phase by which the contact point leads the base acceleration"),
        ("η", "viscous friction"),
        ("κ = mh²/J₀, i_a = I_a/(mr²); D", "ratios of inertia, I_a about the axis; 1 + i_a − κ"),
        ("σ, ζ", "spin about the axis, and the friction it meets"),
        ("A₊, A₋; θ*", "upper and lower branch of steady rolling; frequency above which the upper one is stable"),
    ),
)

# Name of the picture, the heading it stands under, how to draw it, and its caption.
_PICTURES: tuple[tuple[str, str, Callable[[PaperCheck], Figure], str], ...] = (
    (
        "column",
        "The column and its symbols",
        lambda _: figures.sketch(),
        "The leaning column from the side, and its base from above: the tilt vector α points to where it leans, its "
        "length is the tilt angle A, its azimuth β that of the contact point.",
    ),
    (
        "figure-2-circular",
        "Circular base motion",
        lambda check: figures.figure_2(check.data["response"]),
        "Fig. 2 of the paper: tilt of steady rolling against the frequency of a circular base motion. 1: free rolling "
        "(5). 2, 3: lower and upper branch at a0 = 0.02. 4, 5: the same at a0 = 0.065. Bold: stable.",
    ),
    (
        "figure-3-circular",
        "Circular base motion",
        lambda check: figures.figure_3(check.data["response"], averaged=False),
        "Fig. 3 of the paper: phase of the contact point to the base acceleration, with the curves' numbers of Fig. 2.",
    ),
    (
        "critical-frequency",
        "Circular base motion",
        lambda check: figures.critical(check.data["critical"]),
        "The frequency θ* above which rolling is stable, against the amplitude of the base, for several frictions η. "
        "Dots: the closed form without friction. A curve begins where the boundary meets the fold of the two branches.",
    ),
    (
        "modulated-rolling",
        "Below the critical frequency",
        lambda check: figures.modulated(check.data["modulated"]),
        "Modulated rolling, stable, below θ* = 1.3971 at a0 = 0.065: limit cycles of (7).",
    ),
    (
        "free-twist",
        "A column that may turn",
        lambda check: twist_figures.twist(check.data["twist"]),
        "Steady rolling of a solid cylinder that may turn about its axis, a0 = 0.065, for several spin damping ζ: it "
        "leans less the less friction there is, and spins against its rolling. Bold: stable.",
    ),
    (
        "free-twist-boundary",
        "A column that may turn",
        lambda check: twist_figures.twist_boundary(check.data["twist_boundary"]),
        "The frequency θ* above which steady rolling with a free twist is stable, against amplitude, spin damping ζ "
        "(grey: no twist) and friction η (dot: its limit η → 0 at every finite ζ), and for columns with "
        "i_a < 2κ − 1 = ½ the one above which it is unstable again (dots: limit ζ → 0).",
    ),
    (
        "figure-2-straight",
        "Straight-line base motion",
        lambda check: figures.figure_2(check.data["response"], check.data["straight"]),
        "Fig. 2 for straight-line base motion: the averaged curves, and the full motion started on them: mean and "
        "range of the tilt over the second half of 60 periods; a cross where the column overturned (its height means "
        "nothing).",
    ),
    (
        "figure-3-straight",
        "Straight-line base motion",
        lambda check: figures.figure_3(check.data["response"], averaged=True),
        "Fig. 3 for straight-line base motion, averaged.",
    ),
    (
        "averaging-in-time",
        "Straight-line base motion",
        lambda check: figures.averaging(check.data["averaging"]),
        "Full motion (1) and slow flow (10). Above: both start 15 % above the averaged tilt. Below: both start on the "
        "averaged solution, which (10) calls stable; the column overturns.",
    ),
    (
        "exact-response",
        "Exact periodic orbits",
        lambda check: plot_exact_response(check.data["exact"]),
        "Exact rolling under straight-line motion, a1 = 0.13, beside the averaged curves: mean tilt and, shaded, its "
        "range where stable. At the pitchfork the symmetric orbit gives way to two without the symmetry.",
    ),
    (
        "stability-boundary",
        "Exact periodic orbits",
        lambda check: plot_stability_boundary(check.data["boundary"]),
        "Where rolling under straight-line motion loses its stability, over frequency and amplitude (in these units "
        "accelerations are in g): exactly, and by averaging.",
    ),
    (
        "backbones",
        "Motion in a plane",
        lambda check: figures.backbones(check.data["backbones"]),
        "Two curves that look alike and are not: free rolling (5) and free rocking (3), each with a forced response "
        "that hugs it. Rocking is shown stable or not within its plane; whether it keeps to it is conclusion 5.",
    ),
    (
        "planar-kick",
        "Motion in a plane",
        lambda check: figures.kicks(check.data["kicks"]),
        "Why planar motion is lost: the sideways kick of one passage of the upright, over its offset, grows without "
        "bound as the offset shrinks.",
    ),
    (
        "runaway-azimuth",
        "Free vibration",
        lambda check: figures.runaway(check.data["runaway"]),
        "Free motion without friction from a tilt of 0.7c with a small sideways rate: the azimuth of the lean runs on "
        "by about half a turn at each passage of the upright. Right: the path of the tilt vector inside the circle |α| "
        "= c.",
    ),
    (
        "centre-of-pressure",
        "The standing column",
        lambda check: figures.pressure(check.data["pressure"]),
        "A standing column: path of the centre of pressure on its base (black: the rim).",
    ),
)


def paper_report(check: PaperCheck, folder: str | Path) -> Path:
    """Write figures (PNG), data (netCDF), findings (JSON) and `report.html` into `folder`; return the report's path.

    Raises
    ------
    FileError
        If the folder cannot be written.
    """
    target = Path(folder)
    try:
        (target / "data").mkdir(parents=True, exist_ok=True)
        pictures = _draw(check, target)
        for name, data in check.data.items():
            write_netcdf(data, target / "data" / f"{name}.nc")
        findings = [_plain(finding) for finding in check.findings]
        write_whole(target / "findings.json", json.dumps(findings, indent=1, ensure_ascii=False))
        report = target / "report.html"
        write_whole(report, page(_TITLE, [*_INTRODUCTION, check.summary], _sections(check, pictures)))
    except OSError as error:
        message = f"cannot write into {target}: {error.strerror or error}"
        raise FileError(message) from error
    return report


def findings_table(findings: Sequence[Finding]) -> Table:
    """Return the findings as a table."""
    header = ("where", "statement", "measured", "verdict")
    return Table(header, [(f.source, f.statement, f.measured, f.verdict.value) for f in findings])


def _draw(check: PaperCheck, target: Path) -> dict[str, list[Picture]]:
    drawn: dict[str, list[Picture]] = {}
    for name, heading, draw, caption in _PICTURES:
        figure = draw(check)
        write_whole(target / f"{name}.png", png_of(figure, resolution=180))
        drawn.setdefault(heading, []).append(Picture(figure, caption))
    return drawn


def _sections(check: PaperCheck, pictures: dict[str, list[Picture]]) -> list[Section]:
    return [
        Section("The column and its symbols", [*pictures.get("The column and its symbols", []), _SYMBOLS]),
        *(
            Section(heading, [*pictures.get(heading, []), findings_table(section.findings)])
            for heading, section in check.sections.items()
        ),
    ]


def _plain(finding: Finding) -> dict[str, str]:
    return {
        "source": finding.source,
        "statement": finding.statement,
        "measured": finding.measured,
        "verdict": finding.verdict.value,
    }
