"""Content-Security-Policy of the laboratory's pages."""

import base64
import hashlib
from collections.abc import Mapping

POLICY: Mapping[str, str] = {
    "default-src": "'none'",
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self' data: blob:",
    "connect-src": "'self'",
    "base-uri": "'none'",
    "form-action": "'none'",
    "frame-ancestors": "'none'",
}
"""Content-Security-Policy of the page: it loads from its own server only."""


def written_policy(policy: Mapping[str, str]) -> str:
    """Return a Content-Security-Policy as it is sent."""
    return "; ".join(f"{name} {sources}" for name, sources in policy.items())


def digest_of(text: str) -> str:
    """Return the source that permits a script or style within a page, by its text."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
