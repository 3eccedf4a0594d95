"""How a program is executed where the running controller is not at hand."""
