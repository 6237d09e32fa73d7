"""Code that README and documentation name in their text exists: names, arguments, keys, options, targets, files.

Blocks of Python run as tests; this is for what stands between backticks in a sentence, and for commands of consoles.
Values of a page's own variables, such as `run.measures["turns"]`, are looked up where the page runs: see `conftest.py`.
"""

import ast
import builtins
import importlib
import inspect
import keyword
import re
import shlex
import tomllib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest
from markdown_it import MarkdownIt

import stylobate as sb
from stylobate.cli.commands import COMMANDS
from stylobate.config.options import Chosen, written

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "stylobate"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES += [*sorted((ROOT / "docs").glob("[!_]*/*.md")), *sorted((ROOT / "docs").glob("about/decisions/*.md"))]
# Words of other packages and programs, which pages name without importing them.
OUTSIDE = re.compile(
    "DOP853|RockingBC|Strict|brentq|consolidated|fast_math|grayscale|implicitfast|impratio|jax|libblas3|liblapack3|pebble"
    "|prop_cycle|resample_poly|solve_ivp|vmap"
)
# Files that a reader may have, or that a command writes.
EXAMPLES = re.compile(r"(q|site|quake)_\w+|[\w-]+\.(csv|gif|gpkg|html|mp4|mseed|nc|pdf|png|toml|txt|xlsx|zarr|zip)")
RECEIVERS = {
    "run": sb.Run,
    "column": sb.Column,
    "stone": sb.Column,
    "quake": sb.Record,
    "branch": sb.orbits.Branch,
    "orbit": sb.orbits.PeriodicOrbit,
}
CODE = {".py", ".pyi", ".ts", ".md"}
FOLDERS = ("src", "tests", "validation", "benchmarks")
PARTS = {"shake_table", "objects"}

if not (ROOT / "docs" / "index.md").is_file():
    pytest.skip("the documentation is not here", allow_module_level=True)


def tokens(text):
    """Return what stands between backticks in the text of a page, roles of Sphinx left out, and its blocks."""
    text = re.sub(r"\A---\n.*?\n---\n|^:::.*$", "", text, flags=re.DOTALL | re.MULTILINE)
    named, blocks = [], []
    for token in MarkdownIt("commonmark").enable("table").parse(text):
        if token.type == "fence" and token.info.startswith("{") and not token.info.startswith(("{math", "{eval")):
            inner = tokens(token.content)
            named += inner[0]
            blocks += inner[1]
        elif token.type == "fence":
            blocks.append((token.info, token.content))
        before = ""
        for child in token.children or []:
            if child.type == "code_inline" and not before.endswith("}"):
                named.append(child.content)
            before = child.content
    return named, blocks


READ = {page.relative_to(ROOT).as_posix(): tokens(page.read_text("utf-8")) for page in PAGES}


@cache
def words():
    """Return the words of the sources: of the package, its tests and tools, and of the settings."""
    paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.*") if "node_modules" not in path.parts]
    paths += [ROOT / name for name in ("pyproject.toml", "Makefile", "conftest.py", "hatch_build.py", "docs/conf.py")]
    paths.remove(Path(__file__))
    read = [path.read_text("utf-8") for path in paths if path.suffix in {"", ".py", ".pyi", ".ts", ".toml"}]
    return {word for text in read for word in re.findall(r"[^\W\d]\w*", text)}


@cache
def files():
    """Return the paths of the repository, from its root, as posix paths with a leading slash."""
    folders = (*FOLDERS, "docs", "examples", "paper", ".github", ".ci", "tools")
    found = [path for folder in folders for path in (ROOT / folder).rglob("*") if "node_modules" not in path.parts]
    return [f"/{path.relative_to(ROOT).as_posix()}" for path in [*found, *ROOT.iterdir()]]


@cache
def flags(command):
    """Return the options of a command, those of every kind of column, model and motion included."""
    options = COMMANDS[command].load().options(Chosen()).values()
    return {"--help", *(option.flag or f"--{written(option.name)}" for option in options)}


@cache
def own_words(page):
    """Return the words of the blocks of a page."""
    return {word for _, block in READ[page][1] for word in re.findall(r"\w+", block)}


def missing_words(names, page):
    """Return the names that neither the sources nor the blocks of the page have; words in capitals stand for others."""
    known = (words(), own_words(page), dir(builtins), keyword.kwlist)
    named = [name for name in names if not name.isupper() and not OUTSIDE.fullmatch(name)]
    return [name for name in named if not any(name in one for one in known)]


def command_problems(text, page):
    """Check the name and the options of a command of the package."""
    called = shlex.split(text.replace("\\\n", " "), comments=True)[1:]
    if not called or called[0].isupper() or called[0].startswith("-"):
        return [one for one in called if one[:2] == "--" and one not in {"--help", "--version"}]
    if called[0] not in COMMANDS:
        return [] if called[0] in own_words(page) else [called[0]]
    own = set() if "--model" not in called and "--motion" not in called else own_words(page)
    known = flags(called[0]) | {f"--{written(one)}" for one in own}
    return [one for one in called if re.match("--[a-z]", one) and one.partition("=")[0] not in known]


def option_problems(text, page):
    del page
    known = set().union(*(flags(name) for name in COMMANDS)) | {"--version"}
    return [one for one in text.split() if one[:2] == "--" and one not in known]


def target_problems(text, page):
    """Check the targets and the variables of a call of make."""
    del page
    makefile = (ROOT / "Makefile").read_text("utf-8")
    known = {*re.findall(r"^([\w-]+):", makefile, re.MULTILINE)}
    known |= {f"{name}=" for name in re.findall(r"^(\w+) *[:?]?=", makefile, re.MULTILINE)}
    called = text.partition("make ")[2].partition("#")[0].split()
    return [one for one in called if "".join(one.partition("=")[:2]) not in known]


def program_problems(text, page):
    """Check the module or the file that Python runs, and the extras and groups that pip installs."""
    called = shlex.split(text.partition(" #")[0])
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    if "pip" in called[0]:
        extras = re.findall(r"\w+", " ".join(re.findall(r"\[([^]]*)\]", text)))
        groups = [called[at + 1] for at, word in enumerate(called) if word == "--group"]
        missing = [one for one in extras if one not in project["project"]["optional-dependencies"]]
        return missing + [one for one in groups if one not in project["dependency-groups"]]
    if "-m" not in called:
        return [one for one in called[1:] if one.endswith(".py") and path_problems(one, page)]
    module, *parts = called[called.index("-m") + 1 :]
    parts = parts if module == "validation" else []
    missing = [] if find_spec(module) or module == "build" else [module]
    return missing + [one for one in parts if one not in PARTS and not find_spec(f"validation.{one}")]


def variable_problems(text, page):
    del page
    name = re.match(r"\w+", text)[0]
    return [] if name in words() else [name]


def path_problems(text, page):
    """Check a path of the repository, written from any folder of it; None for the path of something else."""
    path = text.partition(":")[0].rstrip("/")
    first = path.partition("/")[0]
    inside = (ROOT / first).exists() or (PACKAGE / first).exists() or Path(path).suffix in CODE
    if not inside or Path(path).stem == "NAME" or path.startswith("docs/_build"):
        return None
    return [] if any(one.endswith(f"/{path}") for one in files()) else [path]


def key_problems(text, page):
    return missing_words(re.findall(r"\w+", text.partition('"')[0]), page)


def python_problems(text, page):
    """Check the names, attributes, arguments and keys of an expression or assignment; None if it is not Python."""
    source = re.sub(r", …(?=[,}])", "", text).replace("…", "...")
    source = re.sub(r"=(?=$|[,)])", "=...", source)
    try:
        nodes = [*ast.walk(ast.parse(source))]
    except SyntaxError:
        return None
    inner = {id(node.value) for node in nodes if isinstance(node, ast.Attribute)}
    chains = [
        ast.unparse(node) for node in nodes if isinstance(node, ast.Name | ast.Attribute) and id(node) not in inner
    ]
    keys = [
        node.slice.value for node in nodes if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant)
    ]
    calls = [node for node in nodes if isinstance(node, ast.Call)]
    arguments = [name for call in calls for name in unknown_arguments(call, page)]
    named = [word for key in keys for word in re.findall(r"[^\W\d]\w*", str(key))]
    return [*arguments, *missing_words(named, page), *(chain for chain in chains if not exists(chain, page))]


def unknown_arguments(call, page):
    """Return the named arguments of a call that its signature, or else no source, has."""
    names = [one.arg for one in call.keywords if one.arg]
    first, *rest = ast.unparse(call.func).split(".")
    called = resolved(home_of(first), rest) if rest and all(map(str.isidentifier, rest)) else None
    if not callable(called):
        return missing_words(names, page)
    listed = [*inspect.signature(called).parameters.values()]
    known = missing_words(names, page) if listed and listed[-1].kind is inspect.Parameter.VAR_KEYWORD else names
    return [name for name in known if name not in {one.name for one in listed}]


def exists(chain, page):
    """Return whether a dotted name exists: of the package, a public class, a usual variable, or another package."""
    first, *rest = chain.split(".")
    if not all(re.fullmatch(r"\w+", part) for part in (first, *rest)):
        return not missing_words([part for part in rest if part.isidentifier()], page)  # of a call or a literal
    if rest and (home := home_of(first)) is not None:
        return rest[-1].isupper() or resolved(home, rest) is not None
    if rest and (PACKAGE / first).is_dir():
        return not path_problems("/".join([first, *rest]) + ".py", page)
    return not missing_words([first, *rest], page)


def home_of(first):
    """Return the value that the first part of a dotted name stands for; None for a word that may mean anything."""
    if first in ("sb", "stylobate"):
        return sb
    named = RECEIVERS.get(first) or public_names().get(first)
    outside = not named and first not in sb.__all__ and not (ROOT / first).exists() and not (PACKAGE / first).exists()
    return importlib.import_module(first) if outside and find_spec(first) else named


@cache
def public_names():
    """Return the parts of the package and the public classes by their names."""
    parts = {name: getattr(sb, name) for name in sb.__all__ if isinstance(getattr(sb, name), ModuleType)}
    listed = {name: getattr(part, name) for part in (sb, *parts.values()) for name in getattr(part, "__all__", ())}
    return {name: value for name, value in listed.items() if isinstance(value, type)} | parts


def resolved(value, names):
    """Return the attribute, field or submodule that names lead to; None if there is none."""
    for name in names:
        if hasattr(value, name):
            value = getattr(value, name)
        elif isinstance(value, ModuleType) and find_spec(f"{value.__name__}.{name}"):
            value = importlib.import_module(f"{value.__name__}.{name}")
        else:
            mro = getattr(value, "__mro__", ())
            value = next(
                (one.__annotations__[name] for one in mro if name in vars(one).get("__annotations__", {})), None
            )
    return value


CHECKS = (
    (r"stylobate( |$)", command_problems),
    (r"--[a-z]", option_problems),
    (r"(STYLOBATE_\w+=\w+ )?make ", target_problems),
    (r"(STYLOBATE_\w+=\w+ )?(\.venv/bin/)?(python3?|pip) ", program_problems),
    (r"STYLOBATE_", variable_problems),
    (r"(GET|POST|DELETE) /", key_problems),
    (r"\[+[a-z]\w*[\w.\" ]*\]+$", key_problems),
    (r"[\w./-]+(/[\w.-]*|\.(py|pyi|ts|md))(:\d+)?$", path_problems),
    (r"(?![\w.]+:\w)[a-zA-Z]", python_problems),
)


def problems_of(text, page):
    """Return what a text names that does not exist; None if it names nothing that can be looked up."""
    if EXAMPLES.fullmatch(text):
        return None
    check = next((check for pattern, check in CHECKS if re.match(pattern, text)), None)
    return check and check(text, page)


def test_code_in_the_text_of_pages_names_what_exists():
    found = {page: {text: problems_of(text, page) for text in named} for page, (named, _) in READ.items()}
    assert [(page, text, names) for page, texts in found.items() for text, names in texts.items() if names] == []


def commands(page):
    """Return the commands of the consoles of a page."""
    blocks = [block for language, block in READ[page][1] if language in ("console", "{code-block} console")]
    return [
        line[2:] for block in blocks for line in re.sub(r"\\\n\s*", "", block).splitlines() if line.startswith("$ ")
    ]


def test_commands_of_pages_have_the_options_that_they_use():
    found = [(page, text, problems_of(text, page)) for page in READ for text in commands(page)]
    assert [one for one in found if one[2]] == []
    assert len(found) > 80


@pytest.mark.parametrize(
    "text",
    [
        "sb.simulate_all",
        "Column.conical",
        "run.tilts",
        'run.measures["residual_wobble"]',
        "Column.solid(radius=0.3, breadth=2.0, density=1.0)",
        "theory.angle_of_turning",
        "[fragility.risks_of_sites]",
        "--angular-speed",
        "stylobate mapping",
        "stylobate map --peak",
        "make site-map",
        "make mutants HOUSE=models",
        "python -m validation guesses",
        "python tools/words.py",
        'pip install ".[spreadsheets]"',
        "STYLOBATE_QUIET=1",
        "GET /api/weather",
        "tests/records",
        "records/reader.py",
        "engine.many",
        "restitution_coefficient",
    ],
)
def test_a_name_that_does_not_exist_is_found(text):
    assert problems_of(text, "README.md")
