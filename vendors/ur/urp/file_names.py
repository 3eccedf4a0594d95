"""What the files of PolyScope end with."""

PROGRAM = ".urp"
INSTALLATION = ".installation"
SCRIPT = ".script"
POLYSCOPE_X = ".urpx"
