"""`stylobate assess`: columns under a folder of records, with a self-contained report."""

import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stylobate import config, earthquakes, studies
from stylobate.cli.command import Positional, command
from stylobate.cli.object_tables import OBJECT_TABLE, with_object_table
from stylobate.cli.options import Options
from stylobate.cli.output import NETCDF, check_place, print_json, print_table
from stylobate.cli.record_sources import RECORD_SOURCES, with_record_sources
from stylobate.cli.terminal import INTERRUPTED, log_lines, part_lines, remark, say
from stylobate.config.options import COMPUTING, JSON, Group, Option
from stylobate.errors import FileError, Interrupted
from stylobate.files import file_of, sha256_of
from stylobate.text import headings_in_words

if TYPE_CHECKING:
    from stylobate.earthquakes.config.assess import AssessmentSetup
    from stylobate.results.assessment import Assessment

_TOML = ".toml"
_HEAD = ("title", "author", "project")
_SHOWN = ("column", "scale", "did not overturn it", "overturned it", "not decided", "undecided under small variations")


@command(
    Option("folder", "folder of report, tables and figures; NAME-assessment beside the study by default", Path),
    Option("pdf", "write report.pdf too, with page numbers and bookmarks", bool, default=False),
    Option("store", "store of the parts that are computed; FOLDER/store by default", Path),
    argument=Positional(
        text="study, a TOML file; a table of objects (.csv, .xlsx, .gpkg); or a saved assessment (.nc) to show again",
        required=True,
    ),
    groups=(
        Group.of("Records", *RECORD_SOURCES),
        Group.of("Table of objects", *OBJECT_TABLE),
        Group.of("Report", *(Option(name, f"{name} of the report", str) for name in _HEAD)),
        COMPUTING.reduced_to("threads"),
        Group.of("Output", JSON),
    ),
)
def assess(options: Options) -> None:
    """Assess whether columns survive records, and how robust the answer is.

    A study is a TOML file: columns, a folder of records, the dissipation at three levels, the friction coefficient.
    In place of a study, a table of objects, as for `inventory`, and records suffice.
    The command writes report.html, which needs no other file and no network; also tables, figures, a summary and the
    numbers. It stores each computed part: after Ctrl-C the same command continues. Examples:

    stylobate assess study.toml

    stylobate assess study.toml --pdf

    stylobate assess objects.csv --records quakes --pdf

    stylobate assess study-assessment/assessment.nc --folder again
    """
    source, pdf = options["source"], options["pdf"]
    file = file_of(source)
    if not file.is_file():
        raise FileError(f"cannot read {source}: No such file or directory")
    if pdf:
        from stylobate.plots.page import require_pdf

        require_pdf()
    target = options["folder"] or file.with_name(f"{file.stem}-assessment")
    check_place(target / "report.html" if target.exists() else target)
    setup = None
    if source.suffix == NETCDF:
        options.refuse_unused(f"to show {source}, for which it computes nothing")
    else:
        values = config.read_config(source) if source.suffix == _TOML else {"columns": str(source)}
        values = {**with_object_table(with_record_sources(values, options), options), **options.pick(*_HEAD)}
        store, threads = options["store"] or target / "store", options["threads"]
        options.refuse_unused()
        setup = _described(values, file, target, _command(options, file))
    remark(f"writing into {target}")
    if setup is not None and (read_as := headings_in_words(setup.options["details"].table_read_as)):
        remark(f"{setup.options['details'].table_file}: {read_as}")
    with _locked(target):
        result = _loaded(source) if setup is None else _computed(setup, store, threads)
        lines = part_lines()
        drawn = None if lines is None else partial(lines, "drawing figures")
        report = earthquakes.assessment_report(result, target, pdf=pdf, progress=drawn)
    summary = earthquakes.assessment_tables(result)["summary"]
    if options["as_json"]:
        print_json({"summary": _rows(summary), "setting": result.setting, "report": str(report)})
    else:
        shown = [summary.header.index(name) for name in _SHOWN if name in summary.header]
        rows = [[row[place] for place in shown] for row in summary.rows]
        print_table(str(result.setting["title"]), rows, [summary.header[place] for place in shown])
        say((target / "summary.txt").read_text(encoding="utf-8").partition("\n")[2])
        say(f"report: {report.with_suffix('.pdf') if pdf else report}")


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Lock the folder while this process writes into it.

    Raises
    ------
    FileError
        If another process has locked the folder.
    """
    from filelock import FileLock, Timeout

    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = FileLock(folder.resolve() / ".lock", timeout=0, is_singleton=True)
        lock.acquire()
    except Timeout:
        raise FileError(
            f"{folder}: another assessment writes into it. Wait until it ends, or name another folder."
        ) from None
    except OSError as error:
        raise FileError(f"cannot write {folder}: {error.strerror or error}") from None
    try:
        yield
    finally:
        lock.release()


def _loaded(source: Path) -> "Assessment":
    from stylobate.results import Assessment

    return Assessment.load(source)


def _command(options: Options, source: Path) -> str:
    """Return the command that repeats the computation, with the options that change its result."""
    words = ["stylobate", "assess", source.name]
    for option in (*RECORD_SOURCES, *OBJECT_TABLE):
        value = options[option.name]
        given = value if isinstance(value, (list, tuple)) else [value]
        for one in given:
            if one is not None and one is not False:
                words += [option.written_flag, *([] if one is True else [str(one)])]
    return shlex.join(words)


def _described(values: Mapping[str, Any], source: Path, target: Path, command: str) -> "AssessmentSetup":
    description = earthquakes.AssessConfig.parse(values)
    _refuse_folder_of_another(target, description.title)
    setup = description.build()
    setup.options["details"] = replace(
        setup.options["details"], study_file=source.name, study_sha256=sha256_of(source), command=command
    )
    return setup


def _computed(setup: "AssessmentSetup", store: Path, threads: int | None) -> "Assessment":
    try:
        with _locked(store), log_lines(quiet=0.0):
            return earthquakes.assess(
                setup.columns,
                setup.records,
                **setup.options,
                store=store,
                executor=studies.Threads(threads),
                progress=part_lines(),
            )
    except (Interrupted, KeyboardInterrupt):
        remark(f"the computed parts are kept in {store}; the same command continues from them")
        raise click.exceptions.Exit(INTERRUPTED) from None


def _refuse_folder_of_another(target: Path, title: str) -> None:
    """Raise FileError if the folder holds the report of a study of another title."""
    earlier = target / "assessment.nc"
    if not earlier.is_file():
        return
    try:
        other = _loaded(earlier).setting["title"]
    except FileError:  # damaged: this command writes it again
        return
    if other != title:
        raise FileError(f"{target} holds the assessment {other!r}; name another folder with --folder, or remove it")


def _rows(table: Any) -> list[dict[str, str]]:
    return [dict(zip(table.header, row, strict=True)) for row in table.rows]
