"""A small compiler: plain Python functions of numbers to machine code, lanes side by side in vectors.

A function is taken as it stands in its module; what it calls is found by name and compiled with it, once for every
structure of arguments. Text for LLVM is written directly (`unit`, `body`, `expressions`), llvmlite makes machine code
of it (`machine`), which is kept on disk and always run from there (`kept`, `compiled`). Called without compiling, the
same functions are plain Python.

The accepted language
---------------------
* Numbers: floats, whole numbers of 64 bits, truth values; arithmetic, comparisons, `and`, `or`, `not`, conditional
  expressions; functions of `math`, the same of NumPy, and abs, min, max, sum, int, float, bool, len.
* Tuples and NamedTuples: made, taken to pieces, unrolled by `for`, `zip` and `enumerate`, picked from by an index; a
  generator over one, or over a range that is known, is a tuple.
* Arrays of floats: elements, slices and rows as views, rows copied whole, `np.zeros` of a small known shape. Indices
  that are not known lie between 0 and the length; they are not checked.
* `if`, `while`, `for` over `range` and over tuples, `break`, `continue`, `return`; assignments, also to several names.
* Calls of functions that are written in Python: of modules, static methods of classes, closures and lambdas; default
  values, keywords and `*arguments`.
* `for i in lanes(n)`: straight-line code with conditional expressions, made for as many `i` at once as fit a vector; an
  `n` that is known only while running is positive and a multiple of that. A
  function that is called there and has branches or loops is called for each lane by itself, which is slow.
* What is known while compiling, such as constants of modules, enumerations and classes, is evaluated there; of an `if`
  on what is known only one branch is compiled.

All else is refused with file, line and a remedy (`CompileError`).

Numbers are those of Python to the bit, with these differences: division by zero, a root of a negative number and the
like give infinity or not a number, and zero for whole numbers; `int` of what 64 bits do not hold gives the nearest that
they do; small whole powers are products; other powers and the functions of NumPy are those of the C library; functions
marked `fast` may fuse products with sums and divide by reciprocals. A name is assigned on every way to its use: this is
not checked.
"""
