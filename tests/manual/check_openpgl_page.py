#!/usr/bin/env python3
"""Checks that docs/from-openpgl.md names every call of Open PGL that the libopenpgl of this project answers, and every
field of what it takes: check_openpgl_page.py"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    headers = ROOT / "integrations/openpgl/include/openpgl"
    page = (ROOT / "docs/from-openpgl.md").read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```", "", page, flags=re.M | re.S)
    named = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]*)`", prose))))
    in_cpp = re.sub(r"//[^\n]*", "", (headers / "cpp/OpenPGL.h").read_text())
    # Functions of namespaces and of classes have capitals.
    wanted = set(re.findall(r"\b([A-Z]\w+)\([^;{}]*\)(?: const)?(?:\s*:[^{;]*)? ?\{", in_cpp))
    wanted |= set(re.findall(r"\bstruct (\w+) \{", in_cpp))
    for struct in re.findall(r"struct PGL(?:Path|Sample)\w+ \{(.*?)\n\};", (headers / "data.h").read_text(), re.S):
        wanted |= set(re.findall(r"^  [\w* ]+?(\w+)(?:\{[^}]*\})?;", struct, re.M))
        wanted |= set(re.findall(r"\b(E\w+) =", struct))
    # Vectors are vectors everywhere.
    wanted -= {"Vector2", "Vector3", "Point2", "Point3"}
    lacking = sorted(wanted - named)
    print("\n".join(f"docs/from-openpgl.md: error: says nothing of {name}" for name in lacking))
    print(f"{len(wanted)} names, of which {len(lacking)} lack")
    sys.exit(1 if lacking or len(wanted) < 80 else 0)


if __name__ == "__main__":
    main()
