"""Whether answers are what the laboratory's own description says of them."""

from functools import cache
from urllib.parse import unquote

import jsonschema_rs

from stylobate.lab import Limits
from stylobate.lab.app import schema

DOCUMENT = schema(Limits())


@cache
def validator(reference):
    """Return what finds mistakes in JSON by a schema of the document."""
    return jsonschema_rs.Draft202012Validator({**DOCUMENT, "$ref": reference})


def component(name):
    return validator(f"#/components/schemas/{name}")


def mistakes(reference, value):
    return [f"{list(error.instance_path)}: {error.message[:300]}" for error in validator(reference).iter_errors(value)]


def endpoint(method, path):
    """Return the place of an endpoint in the document as the parts of its path there; none if there is no such."""
    parts = unquote(path).split("/")
    for template, methods in DOCUMENT["paths"].items():
        wanted = template.split("/")
        same = all(own == part or own.startswith("{") for own, part in zip(wanted, parts, strict=False))
        if len(wanted) == len(parts) and same and method.lower() in methods:
            return template, method.lower()
    return None


def conforms(response):
    """Raise unless a response is one that its endpoint tells of; for the hooks of a client."""
    found = endpoint(response.request.method, response.request.url.path)
    response.read()
    kind = response.headers.get("content-type")
    if found is None or kind == "text/plain; charset=utf-8":  # no endpoint, or the server's own refusal of no HTTP
        return
    template, method = found
    told = DOCUMENT["paths"][template][method]["responses"]
    status = str(response.status_code)
    assert status in told, f"{method} {template} does not tell of {status}: {response.text[:300]}"
    assert kind in told[status]["content"], f"{method} {template} does not tell of {kind}"
    if kind == "application/json":
        reference = f"#/paths/{_escaped(template)}/{method}/responses/{status}/content/application~1json/schema"
        found = mistakes(reference, response.json())
        assert not found, f"{method} {template}, {status}: {found}"


def _escaped(part):
    return part.replace("~", "~0").replace("/", "~1").replace("{", "%7B").replace("}", "%7D")
