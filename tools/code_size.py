"""Counts files, lines of code, functions and imports of the package, room by room: `python tools/code_size.py`.

Lines of code are those without blank lines, comments and docstrings. A path of another checkout, or of another
package, counts that one: `python tools/code_size.py ../before/src/stylobate`.
"""

import ast
import io
import sys
import tokenize
from collections import Counter, defaultdict
from pathlib import Path

HERE = Path(__file__).parents[1] / "src" / "stylobate"
_NO_CODE = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
_FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef


def counted(source: str) -> Counter[str]:
    """Count the lines of code, the functions, those used once, and the lines of imports of a module."""
    tree = ast.parse(source)
    docstrings: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            docstrings |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in _NO_CODE:
            code |= set(range(token.start[0], token.end[0] + 1))
    imports = [one for one in ast.walk(tree) if isinstance(one, ast.Import | ast.ImportFrom)]
    functions = [one for one in ast.walk(tree) if isinstance(one, _FUNCTIONS)]
    return Counter(
        files=1,
        lines=len(code - docstrings),
        functions=len(functions),
        short=sum(_is_short(one) for one in functions),
        imports=sum((one.end_lineno or one.lineno) - one.lineno + 1 for one in imports),
    )


def _is_short(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Return whether a body has at most two lines besides its docstring."""
    body = function.body[1:] if ast.get_docstring(function) else function.body
    return not body or (body[-1].end_lineno or 0) - body[0].lineno < 2  # noqa: PLR2004


def main(root: Path) -> None:
    """Print the counts of each room and of the whole package."""
    rooms: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).parts
        rooms[parts[0] if len(parts) > 1 else "(top)"] += counted(path.read_text(encoding="utf-8"))
    total: Counter[str] = Counter()
    for one in rooms.values():
        total += one
    columns = ("files", "lines", "functions", "short", "imports")
    print(f"{'':14}" + "".join(f"{name:>11}" for name in columns))
    for name, one in (*sorted(rooms.items(), key=lambda item: -item[1]["lines"]), ("all", total)):
        print(f"{name:14}" + "".join(f"{one[column]:>11}" for column in columns))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE)
