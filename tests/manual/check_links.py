#!/usr/bin/env python3
"""Checks that the links of the pages below a folder lead to files that are there: check_links.py FOLDER"""
import pathlib
import re
import sys


def main():
    folder, links, dead = pathlib.Path(sys.argv[1]), 0, []
    for page in sorted(folder.rglob("*.md")):
        for link in re.findall(r"\]\((?![a-z]+:)([^)\s#]+)(?:#[^)\s]*)?\)", page.read_text(encoding="utf-8")):
            links += 1
            if not (page.parent / link).exists():
                dead.append(f"{page.relative_to(folder)}: error: a link to {link}, which is not there")
    print("\n".join(dead + [f"{links} links, {len(dead)} lead nowhere"]))
    sys.exit(1 if dead or links < 100 else 0)


if __name__ == "__main__":
    main()
