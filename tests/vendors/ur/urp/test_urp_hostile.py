"""Trees that nobody would draw: whatever they hold, they are read or refused in words."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError
from flyby.core.source.execution.limits import ExecutionLimits
from flyby.core.source.reading import ReadOptions
from flyby.vendors.ur.run.reader import read
from flyby.vendors.ur.urp.source import source_of_text

from ..conftest import Build

TAGS = [
    "Move",
    "Waypoint",
    "CircleMove",
    "gui.program.direction.MoveDirectionNode",
    "Until",
    "SafeHome",
    "Folder",
    "Loop",
    "If",
    "Switch",
    "SwitchCase",
    "DefaultCase",
    "Set",
    "Wait",
    "Popup",
    "Script",
    "Assignment",
    "SubProgram",
    "CallSubProgram",
    "Thread",
    "Event",
    "Timer",
    "Halt",
    "Comment",
    "Force",
    "Pallet",
    "Contributed",
    "SuppressedNode",
    "suppressedNode",
    "children",
    "expression",
    "variable",
    "ExpressionChar",
    "ExpressionToken",
    "ExpressionVariable",
    "ProgramVariable",
    "pin",
    "tcp",
    "feature",
    "position",
    "JointAngles",
    "TCPOffset",
    "Kinematics",
    "motionParameters",
    "via",
    "to",
    "from",
    "payload",
    "BaseToFeature",
    "cachedContents",
    "count",
    "digitalValue",
    "waitTime",
    "InitVariablesNode",
    "variables",
]
KEYS = [
    "type",
    "name",
    "reference",
    "referencedName",
    "motionType",
    "speed",
    "acceleration",
    "blendRadius",
    "useActiveTCP",
    "positionType",
    "angles",
    "pose",
    "value",
    "character",
    "token",
    "comment",
    "message",
    "distance",
    "nextMotionTime",
    "runOnlyOnce",
    "checkContinuously",
    "valueSource",
    "haltProgram",
    "orientationMode",
    "offset",
]
TEXTS = [
    "MoveJ",
    "MoveL",
    "MoveP",
    "Fixed",
    "Variable",
    "Relative",
    "Forever",
    "While",
    "Counting",
    "If",
    "ElseIf",
    "Else",
    "Sleep",
    "DigitalInput",
    "AnalogInput",
    "DigitalOutput",
    "Condition",
    "Line",
    "File",
    "DISTANCE",
    "true",
    "false",
    "x",
    "end",
    "p",
    "movej(",
    "digital_in[0]",
    "../Waypoint",
    "../../Move[2]",
    "../..",
    "/",
    "0.5",
    "-1",
    "1e400",
    "NaN",
    "3",
    "0.1, -1.4, 1.6, -1.8, -1.5, 0.2",
    "1e300, 0, 0, 1e300, 1e300, 0",
    "\n",
    '"',
    "≟",
]

attributes = st.dictionaries(st.sampled_from(KEYS), st.sampled_from(TEXTS), max_size=4)


def _element(tag: str, stated: dict[str, str], inside: list[str], text: str) -> str:
    listed = "".join(f" {key}={quoteattr(value)}" for key, value in stated.items())
    below = (
        f"<children>{''.join(inside)}</children>" if inside and text != "bare" else "".join(inside)
    )
    return f"<{tag}{listed}>{below}</{tag}>"


def _nested(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.builds(
        _element,
        st.sampled_from(TAGS),
        attributes,
        st.lists(inner, max_size=4),
        st.sampled_from(["bare", "below"]),
    )


leaves = st.builds(_element, st.sampled_from(TAGS), attributes, st.just([]), st.just("bare"))
trees = st.recursive(leaves, _nested, max_leaves=25)


@settings(max_examples=150, deadline=None)
@given(st.lists(trees, max_size=5), st.booleans(), trees)
def test_a_tree_of_anything_does_no_harm(
    build: Build, steps: list[str], once: bool, top: str
) -> None:
    text = build.program(*steps, once=once, top=top)
    try:
        source, _ = source_of_text(text, "job.urp")
        assert source.text.count("\n") < 2000
        read(text, "job.urp", ReadOptions(limits=ExecutionLimits(statements=2000)))
    except FlybyError as error:
        assert str(error)
