"""Write the TypeScript types of the laboratory's answers from its OpenAPI document: `python tools/page_types.py`.

With `--check` nothing is written, and the exit status is 1 if the file is not what would be written.
"""

import sys
from pathlib import Path
from typing import Any

from stylobate.lab.limits import Limits
from stylobate.lab.schema import schema
from stylobate.lab.schema.curves import CURVES
from stylobate.lab.schema.jobs import JOBS
from stylobate.lab.schema.options import CATALOGUE
from stylobate.lab.schema.runs import RUNS

TARGET = Path(__file__).parents[1] / "src/stylobate/lab/web/src/page/server/schema.ts"
_HEAD = "/** Types of the server's answers, written by tools/page_types.py from its OpenAPI document. Do not edit. */\n"


def main() -> int:
    """Write the file, or check it; return the exit status."""
    text = types()
    if "--check" not in sys.argv[1:]:
        TARGET.write_text(text, encoding="utf-8", newline="\n")
        return 0
    if TARGET.read_text(encoding="utf-8") == text:
        return 0
    print(f"{TARGET.name} is not what the server answers. Run python tools/page_types.py.")
    return 1


def types() -> str:
    """Return the types of all components that are answered."""
    components = schema(Limits())["components"]["schemas"]
    answered = sorted({*RUNS, *CURVES, *JOBS, *CATALOGUE})
    parts = [
        f"{_comment(components[name], '')}export type {name} = {type_of(components[name])};\n" for name in answered
    ]
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
    text = str(part.get("description", ""))
    return f"{indent}/** {text} */\n" if text else ""


if __name__ == "__main__":
    sys.exit(main())
