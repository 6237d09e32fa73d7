"""Report on the source paper: figures as files, findings as a table, and one HTML page."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from stylobate.errors import FileError
from stylobate.files import write_whole
from stylobate.paper import figures
from stylobate.plots.orbits import plot_exact_response
from stylobate.plots.page import PageSection, PageTable, Picture, page, png_of
from stylobate.plots.responses import plot_stability_boundary
from stylobate.results.findings import Finding, PaperCheck
from stylobate.results.storage import write_netcdf

_TITLE = "A round column on a vibrating base: the source paper reproduced, checked and corrected"

_INTRODUCTION = (
    "The paper, A. Munitsyn and M. Munitsyna, “Dynamic of a cylindrical column on a vibrating base” "
    "(Vibroengineering Procedia, 2021), studies a slender "
    "free-standing column with a circular base under harmonic base motion. This page recomputes the curves of the "
    "paper from its equations and compares each of its statements with a measurement. It lists misprints, and "
    "statements that hold within limits or do not hold as stated. Numbers in parentheses are the paper's equations.",
    "Units: angles in rad, time τ = ω₀t, frequency ratio ν = Ω/ω₀, accelerations in g. The letters are those of "
    "stylobate; the table lists the paper's letter where it differs. Unless stated otherwise c = η = 0.1, the numbers "
    "of the paper's figures. Every number below was computed when this page was made.",
)

_SYMBOLS = PageTable(
    ("symbol", "meaning", "in the paper"),
    (
        (
            "r, h; c = r/h",
            "base radius, height of the centre of mass; slenderness, the tilt at which the column tips",
            "",
        ),
        ("ω₀ = √(mgh/J₀)", "frequency scale; J₀ the moment of inertia about a diameter of the base", ""),
        ("ν = Ω/ω₀", "frequency ratio: angular frequency of the base over ω₀", "θ"),
        ("θ = (θ_x, θ_y)", "tilt vector: points to the side of the lean", "α = (α₁, α₂)"),
        ("θ, β", "tilt angle, the length of the tilt vector; azimuth of the lean", "A, β"),
        ("θ̇, β̇", "tilt rate; rate at which the contact point rolls round the rim", "μ, ω"),
        ("ω", "frequency of free motion in units of ω₀", "ω"),
        ("a0; a1, a2", "amplitude of circular base motion; amplitudes along the two axes", ""),
        ("ψ", "phase by which the contact point leads the base acceleration", ""),
        ("η", "damping", ""),
        ("κ = mh²/J₀, i_a = I_a/(mr²); Λ", "ratios of inertia, I_a about the axis; 1 + i_a − κ", "–"),
        ("σ, ζ", "spin about the axis; spin damping", "–"),
        ("θ₊, θ₋; ν*", "upper and lower branch of steady rolling; frequency above which the upper one is stable", ""),
    ),
)

# Name of the picture, heading of its section, drawing function and caption.
_PICTURES: tuple[tuple[str, str, Callable[[PaperCheck], Figure], str], ...] = (
    (
        "column",
        "The column and its symbols",
        lambda _: figures.sketch(),
        "The leaning column from the side, and its base from above. The tilt vector points to the side of the lean, "
        "its length is the tilt angle θ, and its azimuth β is that of the contact point.",
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
        "The frequency ν* above which rolling is stable, against the amplitude of the base, for several values of the "
        "damping η. Dots: the closed form without damping. A curve begins where the boundary meets the fold of the two "
        "branches.",
    ),
    (
        "modulated-rolling",
        "Below the critical frequency",
        lambda check: figures.modulated(check.data["modulated"]),
        "Stable modulated rolling below ν* = 1.3971 at a0 = 0.065: limit cycles of (7).",
    ),
    (
        "free-twist",
        "Free spin",
        lambda check: figures.twist(check.data["twist"]),
        "Steady rolling of a solid cylinder with free spin, a0 = 0.065, for several values of the spin damping ζ. With "
        "less spin damping the column leans less; it spins against its rolling. Bold: stable.",
    ),
    (
        "free-twist-boundary",
        "Free spin",
        lambda check: figures.twist_boundary(check.data["twist_boundary"]),
        "The frequency ν* above which steady rolling with free spin is stable, against amplitude, spin damping ζ "
        "(grey: no spin) and damping η (dot: its limit η → 0 at every finite ζ). For columns with i_a < 2κ − 1 = ½ "
        "also the frequency above which it is unstable again (dots: limit ζ → 0).",
    ),
    (
        "figure-2-straight",
        "Straight-line base motion",
        lambda check: figures.figure_2(check.data["response"], check.data["straight"]),
        "Fig. 2 for straight-line base motion: the averaged curves, and the full motion started on them: mean and "
        "range of the tilt over the second half of 60 periods; a cross marks overturning (its height has no "
        "meaning).",
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
        "averaged solution, which is stable by (10); the column overturns.",
    ),
    (
        "exact-response",
        "Exact periodic orbits",
        lambda check: plot_exact_response(check.data["exact"]),
        "Exact rolling under straight-line motion, a1 = 0.13, beside the averaged curves: mean tilt and, shaded, its "
        "range where stable. At the pitchfork two orbits without the symmetry bifurcate from the symmetric orbit.",
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
        "Planar motion",
        lambda check: figures.backbones(check.data["backbones"]),
        "Two curves that look similar and are different: free rolling (5) and free rocking (3), each with a forced "
        "response near it. Rocking is marked stable if it is stable within its plane; conclusion 5 is about leaving "
        "it.",
    ),
    (
        "planar-kick",
        "Planar motion",
        lambda check: figures.kicks(check.data["kicks"]),
        "Why planar motion is lost: the sideways kick of one passage near the vertical, divided by its offset, grows "
        "without bound as the offset shrinks.",
    ),
    (
        "runaway-azimuth",
        "Free vibration",
        lambda check: figures.runaway(check.data["runaway"]),
        "Free motion without damping from a tilt of 0.7c with a small sideways rate: the azimuth of the lean advances "
        "by about half a turn at each passage near the vertical. Right: the path of the tilt vector inside the circle "
        "θ = c.",
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
        raise FileError(f"cannot write into {target}: {error.strerror or error}") from error
    return report


def findings_table(findings: Sequence[Finding]) -> PageTable:
    """Convert the findings to a table."""
    header = ("where", "statement", "measured", "verdict")
    return PageTable(header, [(f.source, f.statement, f.measured, f.verdict.value) for f in findings])


def _draw(check: PaperCheck, target: Path) -> dict[str, list[Picture]]:
    drawn: dict[str, list[Picture]] = {}
    for name, heading, draw, caption in _PICTURES:
        figure = draw(check)
        write_whole(target / f"{name}.png", png_of(figure, resolution=200))
        drawn.setdefault(heading, []).append(Picture(figure, caption))
    return drawn


def _sections(check: PaperCheck, pictures: dict[str, list[Picture]]) -> list[PageSection]:
    return [
        PageSection("The column and its symbols", [*pictures.get("The column and its symbols", []), _SYMBOLS]),
        *(
            PageSection(heading, [*pictures.get(heading, []), findings_table(section.findings)])
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
