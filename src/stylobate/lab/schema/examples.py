"""Examples of requests, ready to send."""

import base64
from typing import Any

from stylobate.lab.presets import presets

_PRESETS = {preset.identity: preset.description for preset in presets()}
_COLUMN = {"shape": "dimensionless", "slenderness": 0.1}
_MODEL = {"kind": "slender", "damping": 0.1}
_CIRCLE = {
    "column": _COLUMN,
    "model": _MODEL,
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
}
_START = {"tilt": [0.03, 0.0], "tilt_rate": [0.0, 0.07]}
_RECORD = b"0.00 0.000\n0.01 0.120\n0.02 0.310\n0.03 0.080\n0.04 -0.210\n0.05 0.000\n"

RUNS: dict[str, Any] = {name: _PRESETS[name] for name in (presets()[0].identity, "temple")}
"""Examples of runs."""

RESPONSES: dict[str, Any] = {"circle": {**_CIRCLE, "angular_frequency_range": [0.5, 4.0], "points": 100}}
"""Examples of response curves."""

STARTS: dict[str, Any] = {"circle": {**_CIRCLE, "branch": "upper"}}
"""Examples of initial conditions on steady rolling."""

RECORDS: dict[str, Any] = {
    "text": {"files": [{"name": "shock.txt", "content": base64.b64encode(_RECORD).decode()}], "units": "g"}
}
"""Examples of records to upload."""

JOBS: dict[str, Any] = {
    "map": {
        "kind": "map",
        "description": {
            **_CIRCLE,
            **_START,
            "duration": 60.0,
            "map": {
                "x": {"name": "angular_frequency", "from": 0.8, "to": 4.0, "number": 12},
                "y": {"name": "acceleration", "from": 0.02, "to": 0.4, "number": 10},
            },
        },
    },
    "basin": {
        "kind": "basin",
        "description": {
            **_CIRCLE,
            "duration": 200.0,
            "basin": {place: {"name": f"tilt_{place}", "from": -0.12, "to": 0.12, "number": 7} for place in "xy"},
        },
    },
    "exact": {"kind": "exact", "description": {**_CIRCLE, "angular_frequency_range": [1.2, 2.0]}},
    "animation": {"kind": "animation", "description": {**_CIRCLE, **_START, "duration": 2.0}},
}
"""Examples of jobs."""
