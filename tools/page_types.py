"""Write what the laboratory's page takes from the package, in TypeScript: `python tools/page_types.py`.

These are the types of the server's answers, from `stylobate.lab.answers`, and names and kinds, from their declarations.
With `--check` nothing is written, and the exit status is 1 if a file is not what would be written.
"""

import json
import sys
from pathlib import Path
from typing import Any

from stylobate.base_motions import Harmonic
from stylobate.base_motions.declared import MOTIONS, kinds_by_acceleration, kinds_with_response
from stylobate.config.study import study_of
from stylobate.lab.answers import schemas
from stylobate.lab.grids import OFF_BRANCH
from stylobate.lab.recorded import BEYOND, POINTS, RANGE
from stylobate.lab.requests import GRIDS
from stylobate.models.declared import MODELS
from stylobate.quantities import parameters_of
from stylobate.run_arguments import InitialConditions, numbers_of, run_numbers

FOLDER = Path(__file__).parents[1] / "src/stylobate/lab/web/src/page/server"
_HEAD = "/** Types of the answers, written by tools/page_types.py from stylobate.lab.answers. Do not edit. */\n"
_HEAD_OF_NAMES = "/** Names and kinds, written by tools/page_types.py from their declarations. Do not edit. */\n"
_RATES = ("rad/s", "Hz", "1/min")
_OF_RESPONSES = (
    ("POINTS", "Points of a response curve, about one to a pixel.", POINTS),
    (
        "RANGE",
        "Ends of the range of frequencies of a response curve, over the frequency scale of the column.",
        f"{json.dumps(RANGE)} as const",
    ),
    ("BEYOND", "The range also includes the frequency of the case, and goes beyond it by this factor.", BEYOND),
)


def main() -> int:
    """Write the files, or check them; return the exit status."""
    texts = {FOLDER / "schema.ts": types(), FOLDER / "declared.ts": names()}
    if "--check" not in sys.argv[1:]:
        for path, text in texts.items():
            path.write_text(text, encoding="utf-8", newline="\n")
        return 0
    old = [path.name for path, text in texts.items() if path.read_text(encoding="utf-8") != text]
    for name in old:
        print(f"{name} is not what the package declares. Run python tools/page_types.py.")
    return int(bool(old))


def names() -> str:
    """Return the names and kinds that the page needs before the server answers."""
    turning = [kind for kind, model in MODELS.items() if getattr(model, "spin_state", None) is not None]
    listed = {
        "START": ("The numbers of a start.", numbers_of(InitialConditions)),
        "RUN": ("What runs have besides column, model and motion.", (*run_numbers(), "rules")),
        "RESPONDING": ("Kinds of motions that can have response curves.", kinds_with_response()),
        "BY_ACCELERATION": ("Those whose acceleration does not depend on their frequency.", kinds_by_acceleration()),
        "TURNING": ("Kinds of models of columns that may turn about their axis.", turning),
    }
    parts = [
        f"/** {about} */\nexport const {name}: readonly string[] = {json.dumps(list(words))};\n"
        for name, (about, words) in listed.items()
    ]
    rates = [
        f"  {kind}: {json.dumps([name, one.quantity.unit])},\n"
        for kind, make in MOTIONS.items()
        if Harmonic in (make, getattr(make, "__self__", None))
        for name, one in parameters_of(make).items()
        if one.quantity.unit in _RATES
    ]
    grids = "".join(f"  {name}: {{ starts: {json.dumps(study_of(one).starts)} }},\n" for name, one in GRIDS.items())
    about = "Studies whose result is a grid of classes: whether only initial conditions vary."
    parts += [f"/** {about} */\nexport const GRIDS = {{\n{grids}}} as const;\n"]
    about = "By kind of harmonic motion: the number that holds the frequency, and its unit."
    kind = "Readonly<Record<string, readonly [name: string, unit: string]>>"
    parts += [f"/** {about} */\nexport const FREQUENCIES: {kind} = {{\n{''.join(rates)}}};\n"]
    about = "A start on a branch is off it by this fraction of its tilt: a run leaves a motion that is not stable."
    parts += [f"/** {about} */\nexport const OFF_BRANCH = {OFF_BRANCH!r};\n"]
    parts += [f"/** {about} */\nexport const {name} = {value};\n" for name, about, value in _OF_RESPONSES]
    return "\n".join([_HEAD_OF_NAMES, *parts])


def types() -> str:
    """Return the types of all answers and their parts."""
    parts = [f"{_comment(one, '')}export type {name} = {type_of(one)};\n" for name, one in schemas().items()]
    return "\n".join([_HEAD, *parts])


def type_of(part: dict[str, Any], indent: str = "") -> str:
    """Return the type of a part of a JSON Schema."""
    if "$ref" in part:
        return str(part["$ref"]).rpartition("/")[2]
    if "anyOf" in part:
        return " | ".join(dict.fromkeys(type_of(one, indent) for one in part["anyOf"]))
    if "enum" in part:
        return " | ".join(f'"{one}"' if isinstance(one, str) else str(one) for one in part["enum"])
    if isinstance(part.get("type"), list):
        return " | ".join(type_of({**part, "type": one}, indent) for one in part["type"])
    match part.get("type"):
        case "array":
            return _array(part, indent)
        case "object":
            return _object(part, indent)
        case "number" | "integer":
            return "number"
        case "string" | "boolean" | "null" as plain:
            return str(plain)
        case _:
            return "unknown"


def _array(part: dict[str, Any], indent: str) -> str:
    if "prefixItems" in part:
        return f"readonly [{', '.join(type_of(one, indent) for one in part['prefixItems'])}]"
    item = type_of(part["items"], indent)
    if part.get("minItems") is not None and part.get("minItems") == part.get("maxItems"):
        return f"readonly [{', '.join([item] * part['minItems'])}]"
    return f"readonly ({item})[]" if " " in item else f"readonly {item}[]"


def _object(part: dict[str, Any], indent: str) -> str:
    deeper = f"{indent}  "
    lines = []
    for name, one in part.get("properties", {}).items():
        mark = "" if name in part.get("required", ()) else "?"
        lines.append(f"{_comment(one, deeper)}{deeper}readonly {_key(name)}{mark}: {type_of(one, deeper)};\n")
    others = part.get("additionalProperties", True)
    if not lines:
        return f"Readonly<Record<string, {type_of(others, indent) if isinstance(others, dict) else 'unknown'}>>"
    if others is not False:
        lines.append(f"{deeper}readonly [name: string]: unknown;\n")
    return "{\n" + "".join(lines) + indent + "}"


def _key(name: str) -> str:
    return name if name.isidentifier() else f'"{name}"'


def _comment(part: dict[str, Any], indent: str) -> str:
    text = " ".join(str(part.get("description", "")).split())
    return f"{indent}/** {text} */\n" if text else ""


if __name__ == "__main__":
    sys.exit(main())
