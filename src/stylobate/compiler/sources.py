"""Source of functions: their syntax trees, with the names that they use, and errors that name the place."""

import ast
import builtins
import copy
import inspect
import linecache
import sys
import textwrap
import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from stylobate.compiler.marks import is_fast


class CompileError(Exception):
    """A function cannot be compiled; the message has location, reason and remedy."""


class Refusal(Exception):  # noqa: N818  becomes a CompileError where the place is known
    """A function contains unsupported code.

    Parameters
    ----------
    reason
        Reason and remedy.
    """


class LanesRefusal(Refusal):
    """A function contains code that is unsupported only in loops over lanes."""


def at_its_place(reason: object, node: ast.AST, file: str, function: str) -> CompileError:
    """Return the error for a refusal, with file and line."""
    return CompileError(f"{file}:{getattr(node, 'lineno', '?')}: in {function}: {reason}")


PACKAGE = "stylobate_kernels"

_texts: dict[str, list[str]] = {}
"""Lines by virtual file name; a copy, since `linecache`, which tracebacks use, may drop them."""


def written_module(name: str, text: str, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module of a text, with the functions of a model under these names.

    Its functions are plain Python; their lines are available to the compiler, tracebacks and debuggers.
    """
    module = types.ModuleType(f"{PACKAGE}.{name}")
    module.__file__ = f"<{module.__name__}>"
    vars(module).update(functions)
    sys.modules[module.__name__] = module
    _texts[module.__file__] = text.splitlines(keepends=True)
    linecache.cache[module.__file__] = (len(text), None, _texts[module.__file__], module.__file__)
    exec(compile(text, module.__file__, "exec"), vars(module))  # noqa: S102  our own text
    return module


def lines_of(file: str) -> list[str]:
    """Return the lines of a generated module or of a file on disk."""
    if file in _texts:
        return _texts[file]
    linecache.checkcache(file)
    return linecache.getlines(file)


_Cached = type(cache(len))
_Node = ast.FunctionDef | ast.Lambda
_Functions = dict[tuple[str, int], tuple[list[_Node], types.CodeType | None]]


@dataclass(frozen=True, slots=True)
class Source:
    """Source of a function.

    Parameters
    ----------
    function
        The function.
    name, file
        Name and file in messages.
    arguments, body
        Syntax tree; the body of a lambda is one return statement.
    signature
        Arguments with default values.
    fast
        Whether the function is marked `fast`.
    """

    function: types.FunctionType
    name: str
    file: str
    arguments: ast.arguments
    body: tuple[ast.stmt, ...]
    signature: inspect.Signature
    fast: bool

    def find(self, name: str) -> Any:
        """Return the value of a name of an enclosing function, of the module or of Python.

        Raises
        ------
        LookupError, ValueError
            If the name has no value.
        """
        return value_of_name(self.function, name)


def value_of_name(function: types.FunctionType, name: str) -> Any:
    """Return the value of a name that a function does not assign to.

    Raises
    ------
    LookupError, ValueError
        If the name has no value.
    """
    if function.__closure__ and name in function.__code__.co_freevars:
        return function.__closure__[function.__code__.co_freevars.index(name)].cell_contents
    names = function.__globals__
    return names[name] if name in names else vars(builtins)[name]


def source_of(function: Callable[..., Any]) -> Source:
    """Return the source of a function.

    Raises
    ------
    CompileError
        If the text cannot be read, or does not belong to the function.
    """
    plain = plain_function(function)
    node = _node_of(plain.__code__)
    body = (ast.Return(node.body, lineno=node.lineno),) if isinstance(node, ast.Lambda) else tuple(node.body)
    signature = inspect.signature(plain, follow_wrapped=False)
    name, file = plain.__name__, plain.__code__.co_filename
    return Source(plain, name, file, node.args, body, signature, is_fast(plain))


def plain_function(function: Callable[..., Any]) -> types.FunctionType:
    """Return the Python function of a static method, of a cache, or of a function that another library compiled.

    Raises
    ------
    CompileError
        If there is no such function. What other decorators make of a function is unknown.
    """
    plain: Any = function
    while not isinstance(plain, types.FunctionType):
        if isinstance(plain, staticmethod | _Cached):
            plain = plain.__wrapped__
        elif hasattr(plain, "py_func"):
            plain = plain.py_func
        else:
            raise CompileError(_reason_against(function))
    return plain


def _reason_against(function: Any) -> str:
    name = getattr(function, "__name__", repr(function))
    if hasattr(function, "__wrapped__") and not isinstance(function, types.MethodType):
        kind = type(function).__qualname__
        return (
            f"{name} is an object of the class {kind}, made by a decorator; write a decorator that returns a function"
        )
    return f"{name} is not a function written in Python"


def _node_of(code: types.CodeType) -> _Node:
    lines = lines_of(code.co_filename)
    place = (code.co_name, code.co_firstlineno)
    nodes, written = _functions_of("".join(lines), code.co_filename).get(place, ([], None))
    exact = bool(nodes)
    if not nodes:
        nodes, written = _within_other_text(lines, *place)
    if len(nodes) != 1 or written is None or not _is_same(written, code, exact=exact):
        raise CompileError(
            f"the text of {code.co_name} cannot be found in {code.co_filename}; write it in a file, or in a cell of a "
            "notebook, one function to a line; if the file has changed since it was imported, start again"
        )
    return nodes[0]


def _is_same(a: types.CodeType, b: types.CodeType, *, exact: bool) -> bool:
    """Return whether two codes are equal or, if not `exact`, use the same names and constants in the same lines.

    The code of a call of an imported name differs between a whole module and a single function.
    """

    def described(code: types.CodeType) -> tuple[object, ...]:
        lines = [line and line - code.co_firstlineno for _, _, line in code.co_lines()]
        constants = [repr(one) for one in code.co_consts if not isinstance(one, types.CodeType)]
        used = (code.co_names, code.co_varnames, code.co_freevars, constants, sorted({line for line in lines if line}))
        return (*used, code.co_code) if exact else used

    return described(a) == described(b)


@cache
def _functions_of(text: str, file: str) -> _Functions:
    """Return the functions of a text with their code, by name and first line."""
    try:
        tree = ast.parse(text, file)
        whole = compile(tree, file, "exec", dont_inherit=True)
    except SyntaxError:  # changed since its import, or a document that contains programs
        return {}
    codes = {(code.co_name, code.co_firstlineno): code for code in _codes_in(whole)}
    nodes: dict[tuple[str, int], list[_Node]] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.Lambda):
            nodes.setdefault((getattr(node, "name", "<lambda>"), _first_line(node)), []).append(node)
    return {place: (found, codes.get(place)) for place, found in nodes.items()}


def _within_other_text(lines: list[str], name: str, first: int) -> tuple[list[_Node], types.CodeType | None]:
    """Return a function that begins in this line of a file that is not a program as a whole."""
    try:
        text = textwrap.dedent("".join(inspect.getblock(lines[first - 1 :])))
    except (IndexError, SyntaxError):
        return [], None
    nodes, code = _functions_of(text, "").get((name, 1), ([], None))
    moved = [ast.increment_lineno(copy.deepcopy(node), first - 1) for node in nodes]
    return moved, code


def _codes_in(code: types.CodeType) -> Iterator[types.CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes_in(constant)


def _first_line(node: _Node) -> int:
    decorators = node.decorator_list if isinstance(node, ast.FunctionDef) else []
    return min([node.lineno, *(decorator.lineno for decorator in decorators)])
