"""How messages say that a call has too few or too many arguments."""

import pytest

from flyby.core.source.text.arguments import wrong_count


@pytest.mark.parametrize(
    ("wanted", "given", "names", "text"),
    [
        (0, 1, (), "takes 0 arguments, not 1"),
        (1, 2, (), "takes 1 argument, not 2"),
        (1, 0, ("Value",), "takes 1 argument (Value), not 0"),
        (2, 1, ("Point", "Tool"), "takes 2 arguments (Point, Tool), not 1"),
    ],
)
def test_the_count_has_the_right_plural(
    wanted: int, given: int, names: tuple[str, ...], text: str
) -> None:
    assert wrong_count(wanted, given, names) == text
