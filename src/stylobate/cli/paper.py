"""`stylobate paper`: the source paper reproduced, checked and corrected."""

import os
from pathlib import Path
from typing import Annotated

import typer

from stylobate.cli.output import check_place, print_json, print_table
from stylobate.cli.paper_progress import sections_done

Folder = Annotated[Path, typer.Option(help="where to write figures, data and report.html")]
Workers = Annotated[int | None, typer.Option(help="processes to use; all cores by default", show_default=False, min=1)]
Json = Annotated[bool, typer.Option("--json", help="print JSON instead of a table")]


def paper(folder: Folder = Path("stylobate-paper"), workers: Workers = None, as_json: Json = False) -> None:
    """Reproduce the source paper: draw its figures, measure its claims, correct its misprints.

    Writes figures, their data and one self-contained page, report.html, into a folder, and prints the verdict on
    every claim. Takes about a minute on two cores. Ends with status 1 if a claim could not be confirmed.

    The folder keeps each finished section: after Ctrl-C the same command computes only the others.
    """
    from stylobate.paper import check_paper, paper_report  # noqa: PLC0415  heavy imports wait until they are used
    from stylobate.results import Verdict  # noqa: PLC0415

    check_place(folder / "report.html" if folder.exists() else folder)
    with sections_done() as progress:
        check = check_paper(workers=workers or os.cpu_count() or 1, progress=progress, folder=folder)
    report = paper_report(check, folder)
    rows = [(f.source, f.statement, f.measured, f.verdict.value) for f in check.findings]
    if as_json:
        print_json([dict(zip(("source", "statement", "measured", "verdict"), row, strict=True)) for row in rows])
    else:
        print_table("Every claim of the paper, measured", rows, ("where", "statement", "measured", "verdict"))
        print(check.summary)
        print(f"report: {report}")
    if any(finding.verdict is Verdict.NOT_CONFIRMED for finding in check.findings):
        raise typer.Exit(1)
