"""Small compiler: plain Python functions of numbers to machine code, with vectorised loops over lanes.

The compiler reads the source of a function, finds the functions that it calls by name, and compiles them together, once
for each structure of arguments. It writes text for LLVM (`unit`, `body`, `expressions`); llvmlite compiles the text for
a `machine`. Code of this machine is stored on disk and loaded from there (`kept`, `compiled`); code for browsers is a
module (`web`), with functions that round alike everywhere (`mathematics`). Without compilation the same functions are
plain Python.

The accepted language
---------------------
* Numbers: floats, whole numbers of 64 bits, truth values; arithmetic, comparisons, `and`, `or`, `not`, conditional
  expressions; functions of `math`, the same of NumPy, and abs, min, max, sum, int, float, bool, len.
* Tuples and NamedTuples: creation, unpacking, unrolling by `for`, `zip` and `enumerate`, selection by an index; a
  generator over a tuple, or over a known range, is a tuple. A starred target takes what is left.
* Arrays of floats: elements, slices and rows as views, copies of whole rows, `np.zeros` of a small known shape.
* Objects of dataclasses: creation, fields, properties, methods, class methods, `dataclasses.replace` (`objects`). Their
  `__post_init__` is not called, and of `checked_arguments` only the function itself is compiled.
* `if`, `while`, `for` over `range` and over tuples, `break`, `continue`, `return`; assignments, also to several names.
  A name must be assigned on every path to its use.
* Calls of functions written in Python: functions of modules, static methods of classes, closures and lambdas; default
  values, keywords and `*arguments`.
* `for i in lanes(n)`: straight-line code with conditional expressions, for as many `i` at once as a vector holds. An
  `n` that is known only at run time must be positive and a multiple of that number. A called function with branches or
  loops is called separately for each lane, which is slow.
* Values that are known at compile time, such as constants of modules, enumerations and classes, are evaluated then; of
  an `if` with a known condition only one branch is compiled.

All other code is refused with file, line and a remedy (`CompileError`).

Whole numbers have 64 bits, and nothing is checked while compiled code runs. In functions of models each whole number
has bounds that are known when it is compiled, and code that may leave 2^53, an array or a tuple is refused
(`values`). Functions of the package itself are trusted: indices that are not known count from 0.

Results equal those of Python to the bit, with these differences:

* Division by zero, a root of a negative number and the like give infinity or NaN, and zero for whole numbers.
* A name that is a whole number on one path and a fraction on another is a fraction; its product with zero may be -0.0.
* `int`, `math.floor`, `math.ceil` and `math.trunc` of a number beyond ±2^53 give ±2^53 in functions of models, and the
  nearest whole number of 64 bits in functions of the package; of NaN they give 0. In a loop over lanes the last three
  keep their result as a float in functions of the package.
* Small whole powers are products; other powers and the functions of NumPy are those of the C library.
* `np.errstate` has no effect, and calls of functions marked as `advice` are left out.
* Functions marked `fast` may fuse products with sums and divide by reciprocals.
"""
