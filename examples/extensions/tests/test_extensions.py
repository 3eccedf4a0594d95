"""What this distribution adds passes flyby's suite, and is refused where it must be."""

from __future__ import annotations

import math

from flyby_extensions import exporter, logs, robots, rules

from flyby.testing.extensions import (
    ExporterConformance,
    GoldenLog,
    LogConformance,
    RobotPackConformance,
    RuleConformance,
)

TRACE = b"#joint-trace 1\n0;0;10;0;0;90;0\n8;1;10;0;0;90;0\n\n16;2;10;0;0;90;-180\n"
ROWS = [(0, 10, 0, 0, 90, 0), (1, 10, 0, 0, 90, 0), (2, 10, 0, 0, 90, -180)]
JOB = """\
MODULE job
  PROC main()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v200, fine, tool0;
    WaitTime 0.5;
    WaitTime 2.5;
    MoveAbsJ [[10,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v200, fine, tool0;
    MoveL Offs(CRobT(),0,60,0), v500, z0, tool0;
    MoveL Offs(CRobT(),0,-60,0), v500, fine, tool0;
  ENDPROC
ENDMODULE
"""


class TestRobots(RobotPackConformance):
    plugin = robots


class TestLogs(LogConformance):
    plugin = logs
    logs = (
        GoldenLog(
            "joint-trace",
            "run.txt",
            TRACE,
            "abb/irb1200-5-090",
            (0.0, 0.008, 0.016),
            [tuple(map(math.radians, row)) for row in ROWS],
        ),
    )


class TestExporter(ExporterConformance):
    plugin = exporter


class TestRules(RuleConformance):
    plugin = rules
    found = {JOB: [("extensions.long-wait", 5), ("extensions.slow-corner", 7)]}  # noqa: RUF012
