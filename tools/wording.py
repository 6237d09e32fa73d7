"""Find words that the project's texts avoid, in source, docs and page: `python tools/wording.py`.

Each rule has a pattern and the words to write instead. `PENDING` lists the places that still wait to be rewritten; a
place that needs no exception any more is reported, so that the list only shrinks.
"""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]

RULES = {
    # Underscores and capitals part the words of a name.
    r"(?:(?<![A-Za-z])(?:un)?(?i:told|tells?|telling)|(?<=[a-z])T(?:old|ells?|elling))(?![a-z])"
    r"(?!(?:\W+\w+){0,6}?\W+apart\b)": (
        "report, return, show, state, specify, infer, determine, detect, classify or warn"
    ),
    r"(?i)\b(?:becomes?|became) of\b": "outcome of, response of",
    r"(?i)\b(?:nought|anew|likewise|whoever|many an?\b|hang(?:s|ing)? on|vouch(?:es|ed)?|mend(?:s|ed|ing)?)\b": (
        "zero, again, also, anyone, many, depends on, guarantee, repair"
    ),
}

# Prefixes of paths: the prose of the guide.
PENDING = (
    "docs/",
    "README.md",
)

_READ = {".py", ".pyi", ".ts", ".css", ".html", ".md"}
_FOLDERS = ("src", "docs", "README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def main() -> int:
    """Print each place that breaks a rule, and each exception that is not needed; return the exit status."""
    found = list(problems())
    lines = [
        f"{path}:{line}: {word!r}: use {remedy}" for path, line, word, remedy in found if not path.startswith(PENDING)
    ]
    lines += [
        f"tools/wording.py: {prefix} needs no exception any more. Remove it."
        for prefix in PENDING
        if not any(path.startswith(prefix) for path, *_ in found)
    ]
    print("\n".join(lines), end="\n" if lines else "")
    return 1 if lines else 0


def problems() -> Iterator[tuple[str, int, str, str]]:
    """Yield path, line, word and remedy of each place that breaks a rule."""
    for path in files():
        text = (ROOT / path).read_text(encoding="utf-8")
        for pattern, remedy in RULES.items():
            for match in re.finditer(pattern, text):
                yield path, text.count("\n", 0, match.start()) + 1, match[0], remedy


def files() -> list[str]:
    """Return the paths of all texts under version control, from the root."""
    listed = subprocess.run(["git", "ls-files", *_FOLDERS], cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for path in listed.stdout.split() if Path(path).suffix in _READ and (ROOT / path).exists()]


if __name__ == "__main__":
    sys.exit(main())
