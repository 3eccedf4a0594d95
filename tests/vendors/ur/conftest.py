"""Programs and installations of PolyScope as tests write them: by hand, from what is known of the
format."""

from __future__ import annotations

import gzip
from collections.abc import Iterable, Sequence
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

import pytest

UR5E = (
    (0.0, 0.0, 0.1625, 1.570796327),
    (0.0, -0.425, 0.0, 0.0),
    (0.0, -0.3922, 0.0, 0.0),
    (0.0, 0.0, 0.1333, 1.570796327),
    (0.0, 0.0, 0.0997, -1.570796327),
    (0.0, 0.0, 0.0996, 0.0),
)
"""δθ, a, d, α of the nominal UR5e ("DH parameters", maker's site)."""
TCP = (0.0, 0.0, 0.12, 0.0, 0.0, 0.0)
HOME = (0.5, -1.3, 1.6, -1.9, -1.5, 0.4)


def listed(values: Iterable[float]) -> str:
    return ", ".join(repr(float(value)) for value in values)


class Build:
    """Writes elements of PolyScope's files."""

    table = UR5E
    tcp = TCP
    home = HOME

    def kinematics(
        self,
        rows: Sequence[Sequence[float]] = UR5E,
        tag: str = "kinematics",
        status: str = "LINEARIZED",
    ) -> str:
        columns = zip(*rows, strict=True)
        inside = "".join(
            f'<{name} value="{listed(column)}"/>'
            for name, column in zip(("deltaTheta", "a", "d", "alpha"), columns, strict=True)
        )
        return f'<{tag} status="{status}" validChecksum="true">{inside}</{tag}>'

    def expression(self, text: str, tag: str = "expression") -> str:
        characters = "".join(f"<ExpressionChar character={quoteattr(sign)}/>" for sign in text)
        return f"<{tag}>{characters}</{tag}>"

    def fixed(
        self,
        name: str,
        joints: Sequence[float],
        parameters: str = "",
        tcp: Sequence[float] = TCP,
        rows: Sequence[Sequence[float]] = UR5E,
        tag: str = "Waypoint",
    ) -> str:
        cls = "" if tag == "Waypoint" else ' class="Waypoint"'
        return (
            f'<{tag}{cls} type="Fixed" name={quoteattr(name)} kinematicsFlags="1">'
            f"<motionParameters {parameters}/><position>"
            f'<JointAngles angles="{listed(joints)}"/><TCPOffset pose="{listed(tcp)}"/>'
            f"{self.kinematics(rows, 'Kinematics')}</position>"
            f'<BaseToFeature pose="0.0, 0.0, 0.0, 0.0, 0.0, 0.0"/></{tag}>'
        )

    def move(
        self,
        *steps: str,
        kind: str = "MoveJ",
        speed: float = 1.05,
        acceleration: float = 1.4,
        attributes: str = 'useActiveTCP="true" positionType="CartesianPose"',
        feature: str = '<feature class="GeomFeatureReference" referencedName="Joint_0_name"/>',
        head: str = "",
    ) -> str:
        return (
            f'<Move motionType="{kind}" speed="{speed}" acceleration="{acceleration}" {attributes}>'
            f"{head}{feature}<children>{''.join(steps)}</children></Move>"
        )

    def node(self, tag: str, *steps: str, inside: str = "", **attributes: str) -> str:
        stated = " ".join(f"{name}={quoteattr(value)}" for name, value in attributes.items())
        below = f"<children>{''.join(steps)}</children>" if steps else ""
        return f"<{tag} {stated}>{inside}{below}</{tag}>"

    def assignment(self, name: str, text: str) -> str:
        return (
            f'<Assignment valueSource="Expression"><variable name="{name}"><initializeExpression/>'
            f"</variable>{self.expression(text)}</Assignment>"
        )

    def script(self, contents: str) -> str:
        return (
            f'<Script type="File"><cachedContents>{escape(contents)}</cachedContents>'
            "<file>/programs/part.script</file></Script>"
        )

    def program(
        self,
        *steps: str,
        once: bool = True,
        before: str = "",
        top: str = "",
        rows: Sequence[Sequence[float]] = UR5E,
        status: str = "LINEARIZED",
        serial: str = "20205500001",
        installation: str = "default",
        saved_in: str = "5.12.0",
    ) -> str:
        first = (
            f'<SpecialSequence type="BeforeStart"><children>{before}</children></SpecialSequence>'
        )
        return (
            f'<URProgram name="job" installation="{installation}" '
            f'installationRelativePath="{installation}" directory="/programs" '
            f'createdIn="{saved_in}" lastSavedIn="{saved_in}" robotSerialNumber="{serial}">'
            f"{self.kinematics(rows, status=status)}<children><InitVariablesNode/>{top}"
            f"{first if before else ''}"
            f'<MainProgram runOnlyOnce="{str(once).lower()}" InitVariablesNode="false"><children>'
            f"{''.join(steps)}</children></MainProgram></children></URProgram>"
        )

    def installation(self, *parts: str, tcps: str | None = None, active: str = "gripper") -> str:
        known = f'<tcp name="gripper" offset="{listed(TCP)}"/>' if tcps is None else tcps
        return (
            '<Installation INSTALLATION-VERSION="2" directory="/programs" fileName="default">'
            f'<TCPSettings activePose="{active}"><availablePoses>{known}</availablePoses>'
            f"</TCPSettings>{''.join(parts)}</Installation>"
        )

    def packed(self, path: Path, text: str) -> Path:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(gzip.compress(text.encode(), mtime=0))
        return path


@pytest.fixture(scope="session")
def build() -> Build:
    return Build()
