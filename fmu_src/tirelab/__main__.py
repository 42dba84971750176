"""The program `tirelab` as a module: python -m tirelab."""

from .cli import main

if __name__ == "__main__":
    main()
