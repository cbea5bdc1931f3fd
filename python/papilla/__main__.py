"""The command ``papilla``: the program that a wheel brings, else the one in the path. ``python3 -m papilla evaluate ...``"""

from __future__ import annotations

import os
import pathlib
import shutil
import sys


def program() -> str:
    """Its file. Raises SystemExit where there is none."""
    own = pathlib.Path(__file__).parent / "bin/papilla"
    found = str(own) if own.exists() else shutil.which("papilla")
    if found is None:
        raise SystemExit("papilla: the program is neither beside the module nor in the path; install it with the wheel "
                         "(docs/how_to/python.md) or by `cmake --install`")
    return found


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    file = program()
    os.execv(file, [file, *sys.argv[1:]])


if __name__ == "__main__":
    main()
