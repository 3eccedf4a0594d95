"""A bar that one robot holds up to another, which takes it at its other end."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

GIVER = """def giver():
  set_tcp(p[0, 0, 0.12, 0, 0, 0])
  set_target_payload(0.8, [0, 0, 0.05])
  movej([0.5, -1.6, -1.6, -1.5, 1.5708, 0], a=1.4, v=1.05)
  movej(p[-0.65, -0.45, 0.25, 0, 3.1416, 0], a=1.4, v=1.05)
  movel(p[-0.65, -0.45, 0.12, 0, 3.1416, 0], a=0.8, v=0.15)
  set_standard_digital_out(0, True)
  movel(p[-0.65, -0.45, {z}, 0, 3.1416, 0], a=0.8, v=0.4)
  movel(p[-0.65, 0, {z}, 0, 3.1416, 0], a=0.8, v=0.4)
{brought}
{await_held}
  set_standard_digital_out(0, False)
{early}
  movel(p[{back}, 0, {up}, 0, 3.1416, 0], a=0.8, v=0.4)
{away}
  movel(p[-0.65, -0.45, {up}, 0, 3.1416, 0], a=0.8, v=0.4)
end
"""
TAKER = """def taker():
  set_tcp(p[0, 0, 0.12, 0, 0, 0])
  set_target_payload(0.8, [0, 0, 0.05])
  movej([0.7, -1.6, -1.6, -1.5, 1.5708, 0], a=1.4, v=1.05)
  movej(p[-0.65, -0.45, {up}, 0, 3.1416, 0], a=1.4, v=1.05)
{await_brought}
  movel(p[{side}, 0, {up}, 0, 3.1416, 0], a=0.8, v=0.4)
  movel(p[-0.65, 0, {z}, 0, 3.1416, 0], a=0.8, v=0.15)
  set_standard_digital_out(0, True)
{held}
{await_away}
  movel(p[-0.65, 0, {up}, 0, 3.1416, 0], a=0.8, v=0.4)
  movel(p[-0.65, -0.45, {up}, 0, 3.1416, 0], a=0.8, v=0.4)
end
"""
CELL = """robot = "ur/ur10e"
clearance_mm = 5
{base}
[tool.tcp]
tcp = {{ xyz_mm = [0, 0, 120] }}
cylinder_mm = [{radius}, 110]
pose = {{ xyz_mm = [0, 0, 55] }}
[[part]]
name = "bar"
box_mm = [{length}, 60, 60]
pose = {{ xyz_mm = [{at}] }}
mass_kg = 2
attach = "set_standard_digital_out(0, True)"
release = "set_standard_digital_out(0, False)"
"""
STATION = """clearance_mm = 5
[robot.left]
program = "giver.script"
cell = "left.toml"
[robot.right]
program = "taker.script"
cell = "right.toml"
[[hand_over]]
part = "left.bar"
to = "right.bar"
[links]
"""
LINKS = {
    "brought": '"left.digital_out[1]" = "right.digital_in[1]"',
    "away": '"left.digital_out[2]" = "right.digital_in[2]"',
    "held": '"right.digital_out[3]" = "left.digital_in[3]"',
}
SIGNALS = {"brought": 1, "away": 2, "held": 3}


def hand_over(
    folder: Path,
    without: Collection[str] = (),
    at: str | None = None,
    *,
    early: bool = False,
    height: float = 0.4,
    back: float = -0.65,
    side: float = -0.65,
    radius: float = 30.0,
    length: float = 400.0,
) -> Path:
    """The station file of a hand-over in a folder.

    Args:
        folder: that gets its files.
        without: signals that are not waited for: brought, held, away.
        at: mm, where the bar is in the taker's cell; None for where it is.
        early: whether the giver says that it is away before it is.
        height: m, of the tools where the bar changes hands.
        back, side: m, where the giver draws back to, and the taker comes from.
        radius, length: mm, of the grippers and of the bar.
    """
    folder.mkdir(parents=True, exist_ok=True)
    said = {name: f"  set_standard_digital_out({k}, True)" for name, k in SIGNALS.items()}
    asked = {
        f"await_{name}": "  sleep(0.01)"
        if name in without
        else f"  while (get_standard_digital_in({k}) == False):\n    sync()\n  end"
        for name, k in SIGNALS.items()
    }
    words = {**said, **asked, "early": "  sleep(0.01)"}
    if early:
        words |= {"early": words["away"], "away": "  sleep(0.01)"}
    numbers = {"z": height, "up": round(height + 0.1, 6), "back": back, "side": side}
    (folder / "giver.script").write_text(GIVER.format(**words, **numbers), "utf-8")
    (folder / "taker.script").write_text(TAKER.format(**words, **numbers), "utf-8")
    shape = {"radius": radius, "length": length}
    (folder / "left.toml").write_text(CELL.format(base="", at="-800, -450, 90", **shape), "utf-8")
    base = "base = { xyz_mm = [-1600, 0, 0], rpy_deg = [0, 0, 180] }"
    there = at or f"-800, 0, {1e3 * height - 30:g}"
    (folder / "right.toml").write_text(CELL.format(base=base, at=there, **shape), "utf-8")
    links = "\n".join(link for name, link in LINKS.items() if name not in without)
    file = folder / "station.toml"
    file.write_text(STATION + links + "\n", "utf-8")
    return file
