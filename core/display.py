"""Text from anywhere as it may be shown: on a terminal, in a picture, on a page."""

from __future__ import annotations

import re

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def shown(text: str) -> str:
    """The text with the sign for no character in place of what terminals obey and XML lacks.

    Line feeds and tabs stay.
    """
    return _CONTROL.sub("\ufffd", text)
