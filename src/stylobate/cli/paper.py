"""`stylobate paper`: reproduction, check and correction of the source paper."""

import os
from pathlib import Path

import click

from stylobate.cli.command import command
from stylobate.cli.options import Options
from stylobate.cli.output import check_place, print_json, print_table
from stylobate.cli.terminal import section_lines
from stylobate.config.options import JSON, Group, Option


@command(
    Option("folder", "folder of the report; stylobate-paper by default", Path, default=Path("stylobate-paper")),
    Option("workers", "number of processes; all cores by default", int, minimum=1),
    groups=(Group.of("Output", JSON),),
)
def paper(options: Options) -> None:
    """Reproduce the source paper: figures, measured claims, corrected misprints.

    The command writes figures, their data and one self-contained page, report.html, into a folder, and prints the
    verdict on every claim. It takes about a minute on two cores, and ends with status 1 if a claim could not be
    confirmed.

    The folder stores each finished section: after Ctrl-C the same command computes only the other sections.
    """
    from stylobate.paper import check_paper, paper_report
    from stylobate.results.findings import ClaimStatus

    folder, workers = options["folder"], options["workers"]
    check_place(folder / "report.html" if folder.exists() else folder)
    check = check_paper(workers=workers or os.cpu_count() or 1, progress=section_lines(), folder=folder)
    report = paper_report(check, folder)
    rows = [(f.source, f.statement, f.measured, f.verdict.value) for f in check.findings]
    if options["as_json"]:
        print_json([dict(zip(("source", "statement", "measured", "verdict"), row, strict=True)) for row in rows])
    else:
        print_table("Every claim of the paper, measured", rows, ("where", "statement", "measured", "verdict"))
        print(check.summary)
        print(f"report: {report}")
    if any(finding.verdict is ClaimStatus.NOT_CONFIRMED for finding in check.findings):
        raise click.exceptions.Exit(1)
