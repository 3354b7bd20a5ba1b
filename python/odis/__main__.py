"""`python -m odis` says what is installed, and where."""

import pathlib

from . import Context, _odis, version_text

print(f"odis {version_text}")
print(f"package: {pathlib.Path(__file__).parent}")
print(f"library: {_odis.__file__}")
print(f"threads: {Context().threads}")
