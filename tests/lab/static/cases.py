"""Cases of the laboratory as static files, and what is read in its page."""

import json
import re

from stylobate.lab.options import lessons, presets

LESSONS, PRESETS = lessons(), presets()
OPENING = LESSONS[0]
REFUSED = "This page has no answer for"
FOLDER = "some/where"


def contents(page):
    """Return the list of answers in a page."""
    found = re.search('<script id="answers" type="application/json">(.*?)</script>', page)
    return json.loads(found[1])


def refusals(page):
    """Return the texts of the page that say that it has no answer."""
    return page.evaluate(
        "words => [...document.querySelectorAll('.problems, .note, .said, .old-note, .plane-panel .problem, .shares')]"
        ".filter((one) => !one.hidden && one.textContent.includes(words)).map((one) => one.className)",
        REFUSED,
    )


BLOCK = {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2500.0}
EL_CENTRO = {"kind": "record", "sample": "el centro 1940"}
MAP = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
    "tilt": [0.03, 0.01],
    "periods": 40,
    "map": {
        "x": {"name": "angular_frequency", "from": 0.6, "to": 3.4, "number": 9},
        "y": {"name": "acceleration", "from": 0.02, "to": 0.18, "number": 8},
    },
}
