"""Small changes of a source file, one at a time, for `tools/mutants.py`.

A change concerns an operator of arithmetic, a comparison (its boundary moves, or it turns round), `and` and `or`, a
sign, a constant, the order of arguments, a returned value, or a deleted statement. Docstrings, annotations, decorators,
imports, texts of messages and looks of figures stay: no law states them.
"""

import ast
import difflib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_BINARY = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
_BINARY |= {ast.Pow: ast.Mult, ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd}
_COMPARED = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
_LOOKS = {
    "alpha",
    "figsize",
    "fontsize",
    "linewidth",
    "lw",
    "markersize",
    "ncols",
    "pad",
    "rotation",
    "width_ratios",
    "zorder",
}
_SYMMETRIC = {"max", "min", "hypot"}
_GUARDS = {"strict", "stacklevel"}  # of faults of our own

_Functions = tuple[ast.FunctionDef, ...]


@dataclass(frozen=True, slots=True, order=True)
class Mutant:
    """One change: the text between two offsets of a file, and its replacement."""

    file: str
    start: int
    end: int
    text: str
    line: int
    function: str

    def of(self, source: str) -> str:
        """Return the text of the file with the change."""
        raw = source.encode()
        return (raw[: self.start] + self.text.encode() + raw[self.end :]).decode()

    def diff(self, source: str) -> str:
        """Return the changed lines, in the format of `diff -u` without context."""
        lines = difflib.unified_diff(
            source.splitlines(), self.of(source).splitlines(), self.file, self.file, lineterm="", n=0
        )
        return "\n".join(lines)


def mutants_of(path: Path, root: Path) -> Iterator[Mutant]:
    """Yield all mutants of a file."""
    source = path.read_bytes()
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node, functions in _nodes(ast.parse(source), ()):
        for changed in _changes(node, functions[-1].returns if functions else None):
            yield Mutant(
                str(path.relative_to(root)),
                starts[node.lineno - 1] + node.col_offset,
                starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0),
                ast.unparse(changed) if isinstance(changed, ast.stmt) else f"({ast.unparse(changed)})",
                node.lineno,
                functions[0].name if functions else "",
            )


def _nodes(node: ast.AST, functions: _Functions) -> Iterator[tuple[ast.expr | ast.stmt, _Functions]]:
    """Yield expressions and statements that run, each with the functions around it."""
    if isinstance(node, ast.expr | ast.stmt):
        yield node, functions
    if _is_text(node):
        return
    inner = (*functions, node) if isinstance(node, ast.FunctionDef) else functions
    for name, value in ast.iter_fields(node):
        if name not in {"annotation", "returns", "decorator_list", "format_spec"}:
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from _nodes(child, inner)


def _is_text(node: ast.AST) -> bool:
    match node:
        case ast.Assign(targets=[ast.Name("message")]) | ast.Call(func=ast.Name("Quantity" | "cast")):
            return True
        case ast.keyword(arg):
            return arg in _LOOKS | _GUARDS
        case _:
            return isinstance(node, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom)


def _changes(node: ast.expr | ast.stmt, returns: ast.expr | None) -> Iterator[ast.expr | ast.stmt]:
    match node:
        case ast.Return(ast.expr() as value) if returns is not None:
            yield from map(ast.Return, _other_values(value, ast.unparse(returns)))
        case (
            ast.AugAssign()
            | ast.Expr(ast.Call())
            | ast.Assign(targets=[ast.Attribute() | ast.Subscript()])
            | ast.Raise()
            | ast.Break()
            | ast.Continue()
        ):
            yield ast.Pass()
        case ast.expr():
            yield from _other_expressions(node)
        case _:
            pass


def _other_expressions(node: ast.expr) -> Iterator[ast.expr]:
    match node:
        case ast.BinOp(left, operator, right) if type(operator) in _BINARY:
            yield ast.BinOp(left, _BINARY[type(operator)](), right)
        case ast.Compare(left, [operator], [right]):
            for other in _COMPARED[type(operator)]:
                yield ast.Compare(left, [other()], [right])
        case ast.BoolOp(operator, values):
            yield ast.BoolOp(ast.Or() if isinstance(operator, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.USub() | ast.Not(), operand):
            yield operand
        case ast.Constant(bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(int(value) | float(value)):
            yield ast.Constant(value + 1)
        case ast.Call(ast.Name(name) | ast.Attribute(attr=name)) if name in _SYMMETRIC:
            pass
        case ast.Call(function, [first, second, *others], keywords) if _can_change_places(first, second):
            yield ast.Call(function, [second, first, *others], keywords)
        case _:
            pass


def _other_values(value: ast.expr, kind: str) -> Iterator[ast.expr]:
    """Yield another value of this type, unless a change within the expression makes one."""
    match value:
        case ast.Compare() | ast.BoolOp() | ast.UnaryOp() | ast.Constant():
            pass
        case ast.Tuple([first, second, *others]):
            if _can_change_places(first, second):
                yield ast.Tuple([second, first, *others])
        case _ if kind in {"float", "int", "Floats"}:
            yield ast.UnaryOp(ast.USub(), value)
        case _ if kind == "bool":
            yield ast.UnaryOp(ast.Not(), value)
        case _ if "None" in kind:
            yield ast.Constant(None)
        case _:
            pass  # the next line would stop at any other value


def _can_change_places(first: ast.expr, second: ast.expr) -> bool:
    starred = any(isinstance(one, ast.Starred) for one in (first, second))
    return not starred and ast.dump(first) != ast.dump(second)
