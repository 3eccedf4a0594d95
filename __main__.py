"""``python -m flyby`` is the command ``flyby``."""

from .cli.main import main

if __name__ == "__main__":
    main()
