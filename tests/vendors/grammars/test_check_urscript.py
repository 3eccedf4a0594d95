"""The checker of URScript takes a sound program and refuses each of its broken variants."""

from __future__ import annotations

import pytest

from .check import Refused
from .urscript import check_urscript

SOUND = """# A sound program.
def job():
  set_tcp(p[0,0,0.1,0,0,0])
  set_target_payload(1.5, [0,0,0.05])
  global home = [0, -1.57, 1.57, 0, 0, 0]
  place = p[0.4, -0.2, 0.3, 0, 3.14, 0]
  def lift(pose, height=0.1):
    return pose_add(pose, p[0,0,height,0,0,0])
  end
  thread watch():
    while True:
      textmsg("inputs ", get_digital_in(1))
      sync()
    end
  end
  handle = run watch()
  movej(home, a=1.4, v=1.05)
  $ 3 "Waypoint_1"
  movej(get_inverse_kin(place, qnear=home), a=1.2, v=0.8, t=0, r=0.02)
  movel(place, 1.2, 0.25, 0, 0.02)
  movel(lift(place), a=1.2, v=0.25)
  movec(p[.4,.1,.3,0,3.14,0], place, a=1.2, v=0.25, r=0.01, mode=1)
  movep(place, a=1.2, v=0.25, r=1e-2)
  i = 0
  while (i < 3 and not False):
    i = i + 1 - -2
    if i == 2:
      break
    elif i > 4 or home[0] != 0:
      sleep(0.5)
    else:
      sync()
    end
  end
  kill handle
end
"""
BREAKS = [
    ("def job():", "def job()"),
    ("def job():", "def end():"),
    ("def job():", "def movel():"),
    ("def job():", "define job():"),
    ("def job():\n", ""),
    ("kill handle\nend\n", "kill handle\n"),
    ("      sync()\n    end\n  end\n  kill", "      sync()\n  end\n  kill"),
    ("p[0,0,0.1,0,0,0]", "p[0,0,0.1,0,0]"),
    ("p[0,0,0.1,0,0,0]", "p[0,0,0.1,0,0,0,0]"),
    ("p[0,0,0.1,0,0,0]", "[0,0,0.1,0,0,0]"),
    ("set_tcp(", "set_tpc("),
    ("set_target_payload(1.5, [0,0,0.05])", "set_target_payload()"),
    ("set_target_payload(1.5,", "set_target_payload(mass=1.5,"),
    ("global home = [0, -1.57, 1.57, 0, 0, 0]\n", ""),
    ("place = p[0.4", "place == p[0.4"),
    ("place = p[0.4", "1place = p[0.4"),
    ("place = p[0.4", "pläce = p[0.4"),
    ("place = p[0.4", "place = q[0.4"),
    ("p[0.4, -0.2,", "p[0.4 -0.2,"),
    ("p[0.4, -0.2,", "p[0.4, -0.2.1,"),
    ("p[0.4, -0.2,", "p[1e99, -0.2,"),
    ("p[0.4, -0.2,", "p[4000000000, -0.2,"),
    ("lift(place)", "lift()"),
    ("lift(place)", "lift(place, depth=1)"),
    ("lift(place)", "raise_it(place)"),
    ("lift(place)", "lift(plase)"),
    ("movej(home, a=1.4, v=1.05)", "movej([0,1,2], a=1.4, v=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(a=1.4, v=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, a=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=0, v=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, v=-1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, w=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, v=1.05, r=-0.1)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, 1.05)"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, v=1.05) sync()"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a=1.4, v=1.05"),
    ("movej(home, a=1.4, v=1.05)", "movej(home, a:=1.4, v=1.05)"),
    ("movej(home, a=1.4, v=1.05)", "MoveJ(home, a=1.4, v=1.05)"),
    ("movel(place, 1.2, 0.25, 0, 0.02)", "movel(place, 1.2, 0.25, 0, 0.02, 1)"),
    ("mode=1", "mode=2"),
    ("movec(p[.4,.1,.3,0,3.14,0], place,", "movec(p[.4,.1,.3,0,3.14,0],"),
    ("r=1e-2", "t=1e-2"),  # movep has no t
    ("qnear=home", "near=home"),
    ('$ 3 "Waypoint_1"', '$ "Waypoint_1"'),
    ('"inputs "', "'inputs '"),
    ("while (i < 3 and not False):", "while (i < 3 && not False):"),
    ("while (i < 3 and not False):", "while (i < 3 and not False)"),
    ("elif i", "else if i"),
    ("i = 0\n", ""),
    ("handle = run watch()", "handle = run watch"),
    ("# A sound", "# Größe, a sound"),
    ("# A sound", "# A\x00 sound"),
    ("# A sound", "# A" + " very" * 300 + " sound"),
]


def test_a_sound_program_is_taken() -> None:
    check_urscript({"job.script": SOUND})


def test_without_a_script_nothing_is_taken() -> None:
    with pytest.raises(Refused):
        check_urscript({"job.txt": SOUND})


@pytest.mark.parametrize(("old", "new"), BREAKS)
def test_a_broken_program_is_refused(old: str, new: str) -> None:
    assert old in SOUND
    with pytest.raises(Refused):
        check_urscript({"job.script": SOUND.replace(old, new, 1)})
