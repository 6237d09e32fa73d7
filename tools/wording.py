"""Find words that the project's texts avoid, and code too wide for a page: `python tools/wording.py [prefix …]`.

Each rule has a pattern and the words to write instead. `PAGE_RULES` hold for README, documentation and examples. With
prefixes of paths, only what stands below them is shown.
"""

import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
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
    r"\"\"\"(?:Return|Say|Tell|Note|Give)s? (?:what|how|where|why)\b": "a verb and a noun: Return the outcome of …",
    r"(?i)\bthe upright\b(?! (?:column|base|format|position))": "the vertical",
    r"(?i)(?<![`\"_])\bstrobed\b": "stroboscopic (Poincaré)",
}

PAGE_RULES = {
    r"(?i)\bin a plane\b": "planar",
    r"(?i)\bin space\b": "three-dimensional",
    r"(?i)\bno-return tilts?\b": "point of no return",
    r"(?i)\bmade records?\b": "synthetic ground motions",
    r"(?i)\bcreep(?:s|ing)?\b": "is conveyed, mean transport velocity",
    r"(?i)\bfrictions\b": "damping parameters",
    r"(?i)\bfree twist\b|\bmay turn\b": "free axial rotation (spin)",
    r"(?i)(?<!`)\bstrobe[ds]?\b": "stroboscopic (Poincaré) samples",
    r"(?i)\bholds? the contact\b": "assumes permanent contact without slip",
    r"(?i)\bthe house\b": "repository layout, architecture",
    r"(?i)(?<![`\"])\bjams?\b": "dynamic jamming (Painlevé)",
    r"(?i)(?<!# )\bwhat (?:it|they) (?:is|are|was|were|has|have|can|does|do|knows?|gives?|needs?|shows?|means?)\b": (
        "the noun: outcome, response, value"
    ),
}

_WIDTH = 88  # columns that a page shows without scrolling
_PAGES = ("docs/", "README.md", "examples/", "paper/")
_READ = {".py", ".pyi", ".ts", ".css", ".html", ".md", ".rst"}
_FOLDERS = ("src", "docs", "examples", "paper", "README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def main(prefixes: Sequence[str] = ()) -> int:
    """Print each place that breaks a rule; return the exit status."""
    lines = [
        f"{path}:{line}: {word!r}: use {remedy}"
        for path, line, word, remedy in problems()
        if path.startswith(tuple(prefixes) or "")
    ]
    print("\n".join(lines), end="\n" if lines else "")
    return 1 if lines else 0


def problems() -> Iterator[tuple[str, int, str, str]]:
    """Yield path, line, word and remedy of each place that breaks a rule."""
    for path in files():
        text = (ROOT / path).read_text(encoding="utf-8")
        for pattern, remedy in (RULES | PAGE_RULES if path.startswith(_PAGES) else RULES).items():
            for match in re.finditer(pattern, text):
                yield path, text.count("\n", 0, match.start()) + 1, match[0], remedy
        if path.endswith(".md"):
            yield from _wide_code(path, text)


def _wide_code(path: str, text: str) -> Iterator[tuple[str, int, str, str]]:
    fence = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("```"):
            fence = "" if fence else line
        elif fence and not fence.startswith("```{") and len(line) > _WIDTH:
            yield path, number, f"{line[:20]}…", f"at most {_WIDTH} columns in code, not {len(line)}"


def files() -> list[str]:
    """Return the paths of all texts under version control, from the root."""
    listed = subprocess.run(["git", "ls-files", *_FOLDERS], cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for path in listed.stdout.split() if Path(path).suffix in _READ and (ROOT / path).exists()]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
