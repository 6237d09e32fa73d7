"""Two columns, records of one strong second, and the sections of a report on them."""

import numpy as np

import stylobate as sb
from stylobate.earthquakes import assessment_tables
from stylobate.earthquakes.assessment.report.sections import report_sections

BODIES = {
    name: sb.Column.solid(radius=radius, height=2.0, density=2700.0)
    for name, radius in (("slim <1>", 0.2), ("stout", 0.45))
}
DISSIPATION = {"low": {"damping": 0.01}, "central": {"damping": 0.05}, "high": {"damping": 0.1}}


def made_record(name, peak):
    time = 0.02 * np.arange(101)
    wave = np.sin(np.pi * time / 2.0) * np.sin(2.0 * np.pi * time)
    return sb.Record(
        samples=peak * np.stack([wave, 0.4 * wave**2], axis=-1), step=0.02, name=name, provenance=(f"made for {name}",)
    )


def section(assessment, title):
    (own,) = [one for one in report_sections(assessment, assessment_tables(assessment), {}) if one.heading == title]
    return own.content
