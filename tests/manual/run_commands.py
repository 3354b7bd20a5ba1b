#!/usr/bin/env python3
"""Runs the commands that the manual shows, and compares what they print with what the manual says.

    run_commands.py --odis build/release/apps/odis/odis [PAGE...]
    run_commands.py --installed PREFIX [PAGE...]

Pages are README.md, docs/*.md and those of the examples. Each runs in an empty folder of its own, which has the files
of FILES under the names that the manual uses. The language of a block decides:

    sh        runs, each command at a small size (SMALL). It has to succeed.
    console   `$ command` runs as it is written. What follows is compared with what it prints: a line of `...` stands for
              any lines, numbers may be 2 % off, numbers of seconds and bytes by any amount.
    others    c, cpp, cmake, json, python, text, xml: do not run.

Commands that run are those of RUNNABLE, and `cc` if there is an installed library: PREFIX takes the place of /opt/odis,
and pkg-config looks there. Those of LEFT_OUT do not, but what they name has to be there. A comment in the
lines above a block says what else does not run, and why:

    <!-- blocks: skip, takes an hour -->                     the block
    <!-- blocks: skip odis-mitsuba, needs Mitsuba -->        commands that contain odis-mitsuba

What needs a component that is not here (NEEDS) is left out as well. Every block is listed with what became of it. A
block without a language, of a language that is not named above, or of indented commands is an error, and so is a
command that neither is in one of the two tables nor has such a comment.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_RUN = {"c", "cmake", "cpp", "json", "python", "text", "xml"}
# First words of commands that run: of none that installs, builds, or asks a network.
RUNNABLE = {"odis", "build/release/apps/odis/odis", "[", "cat", "cd", "diff", "export", "ls", "mkdir"}
LEFT_OUT = {
    "apt-get": "installs", "pip": "installs", "scripts/setup": "installs", "scripts/cross": "installs",
    "scripts/furniture": "downloads", "git": "downloads", "make": "builds", "cmake": "builds", "ctest": "builds",
    "ninja": "builds", "cpack": "builds", "cc": "builds", "g++": "builds", "python3": "needs the Python package",
    "odis-mitsuba": "needs Mitsuba", "bench/beside_mitsuba.py": "needs Mitsuba", "bench/in_mitsuba.py": "needs Mitsuba",
    "bench/beside_cycles.py": "needs Cycles",
}
LOOKS_LIKE_A_COMMAND = re.compile(r" {4}(cmake|git|make|odis|odis-mitsuba|pip|python3|scripts/\S+) ")

# Where the manual's names lead: folders of the project, and its demo scene for scenes of the reader's.
FILES = {
    "scenes": "scenes", "examples": "examples", "include": "include", "scripts": "scripts", "weights": "weights",
    "render.guide": "fuzz/corpus/saved/guide", "fuzz/corpus/saved": "fuzz/corpus/saved",
    "scene.xml": "scenes/demo/scene.xml", "a.xml": "scenes/demo/scene.xml", "b.xml": "scenes/demo/scene.xml",
    "kitchen/scene.xml": "scenes/demo/scene.xml", "lamp/scene.xml": "scenes/demo/scene.xml",
    "minimal.c": "examples/minimal.c", "knot.ply": "scenes/demo/knot.ply", "kitchen/knot.ply": "scenes/demo/knot.ply",
    "lamp/knot.ply": "scenes/demo/knot.ply", "my.weights": "weights/odis.weights",
}
PLACEHOLDERS = {"SCENE…": "scene.xml", "SCENE": "scene.xml"}

# A pattern in a command, a trial that fails where the component is missing, and its name.
NEEDS = [
    (r"--denoise\b|\bodis denoise\b", "render scene.xml --spp 1 --resolution 8x8 --denoise -q -o trial.exr",
     "Open Image Denoise"),
    (r"--preset paper", "render scene.xml --spp 2 --resolution 8x8 --preset paper-fast -q -o trial.exr", "oneDNN"),
    (r"--integrator openpgl", "render scene.xml --spp 1 --resolution 8x8 --integrator openpgl -q -o trial.exr",
     "Open PGL"),
]


def at_most(limit):
    return lambda given: str(min(int(given), limit)) if given else None


def first_few(given):
    """The first two of a list of numbers of samples, each at most 8."""
    return ",".join(str(min(int(one), 8)) for one in given.split(",")[:2]) if given else "4"


# How a command is made small: what becomes of the value of an option, which is None if the option is not given.
SMALL = {
    "render": {"--resolution": lambda _: "64x36", "--spp": at_most(8)},
    "inspect": {"--paths": lambda _: "4096"},
    "compare": {"--pixels": lambda _: "576", "--reference-spp": lambda _: "8", "--seeds": lambda _: "2",
                "--spp": first_few},
    "analyze": {"--pixels": lambda _: "576", "--reference-spp": lambda _: "4", "--spp": lambda _: "2"},
    "bench": {"--pixels": lambda _: "576", "--rounds": lambda _: "1"},
    "scenes generate": {"--count": lambda _: "1"},
    "scenes sheet": {"--spp": lambda _: "1"},
    "dataset generate": {"--seeds": lambda given: given and "3-3", "--quick": None},
}


def small(arguments):
    """The arguments of `odis` for a small image in place of a large one."""
    name = next((name for name in SMALL if arguments[:len(name.split())] == name.split()), None)
    if name is None or arguments[1:2] and arguments[1].endswith((".guide", ".odis")):
        return arguments
    result = list(arguments)
    for option, change in SMALL[name].items():
        if change is None:
            result += [] if option in result else [option]
            continue
        at = result.index(option) if option in result else None
        value = change(None if at is None else result[at + 1])
        if at is not None:
            result[at + 1] = value
        elif value is not None:
            result += [option, value]
    return result


class Block:
    def __init__(self, page, line, language, lines, comments):
        self.where, self.language, self.lines = f"{page}:{line}", language, lines
        self.skips = []  # (part of the commands that do not run, "" for all; why)
        for comment in comments:
            match = re.fullmatch(r"<!-- blocks: skip ?([^,]*), (.+) -->", comment)
            if not match:
                raise SyntaxError(f"found {comment}, expected <!-- blocks: skip WORDS, WHY -->")
            self.skips.append((match[1], match[2]))

    def commands(self):
        """(command, lines that it prints by the manual): lines that end in a backslash are joined."""
        commands, text = [], ""
        for line in self.lines:
            if self.language == "console" and not text and not line.startswith("$ "):
                if not commands:
                    raise SyntaxError("expected `$ command` first")
                commands[-1][1].append(line)
                continue
            text += line.removeprefix("$ ") if self.language == "console" else line
            if text.endswith("\\"):
                text += "\n"
            elif text.strip():
                commands.append((text, []))
                text = ""
            else:
                text = ""
        return commands


def blocks_of(page, text):
    lines, at, comments = text.split("\n"), 0, []
    while at < len(lines):
        line = lines[at]
        if fence := re.fullmatch(r"```(.*)", line):
            end = next((i for i in range(at + 1, len(lines)) if lines[i] == "```"), None)
            if end is None:
                raise SyntaxError(f"{page}:{at + 1}: expected a line ``` that ends the block")
            try:
                yield Block(page, at + 1, fence[1], lines[at + 1:end], comments)
            except SyntaxError as error:
                raise SyntaxError(f"{page}:{at + 1}: {error}") from None
            at, comments = end + 1, []
            continue
        if LOOKS_LIKE_A_COMMAND.match(line):
            raise SyntaxError(f"{page}:{at + 1}: found an indented command, expected a block between lines of ```")
        if line.startswith("<!-- blocks:"):
            comments.append(line)
        elif comments:
            raise SyntaxError(f"{page}:{at + 1}: expected a block below {comments[-1]}")
        at += 1


NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
ANY_AMOUNT = re.compile(NUMBER.pattern + r" (?:s|ms|min|M/s|[KMG]iB|[kMG]B)\b")


def same_line(expected, found):
    """Whether two lines are the same but for numbers that differ little, and seconds and bytes."""
    expected, found = (ANY_AMOUNT.sub("amount", line.rstrip()) for line in (expected, found))
    if re.sub(r"\s+", " ", NUMBER.sub("0", expected)) != re.sub(r"\s+", " ", NUMBER.sub("0", found)):
        return False
    pairs = zip(map(float, NUMBER.findall(expected)), map(float, NUMBER.findall(found)))
    return all(abs(a - b) <= 0.02 * max(abs(a), abs(b)) for a, b in pairs)


def same_lines(expected, found):
    if not expected:
        return not found
    if expected[0] == "...":
        return any(same_lines(expected[1:], found[i:]) for i in range(len(found) + 1))
    return bool(found) and same_line(expected[0], found[0]) and same_lines(expected[1:], found[1:])


class Runner:
    def __init__(self, odis, installed, folder):
        self.odis, self.installed, self.folder, self.missing, self.failed = odis, installed, folder, {}, False
        self.counts = {"ran": 0, "left out": 0}

    def enter(self, page):
        """A folder for a page, with the files that the manual speaks of."""
        self.place = self.folder / page.replace("/", "_")
        for name, source in FILES.items():
            target = self.place / name
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if (ROOT / source).is_dir() else shutil.copy)(ROOT / source, target)
        for name in ("bin/odis", "build/release/apps/odis/odis"):
            wrapper = self.place / name
            wrapper.parent.mkdir(parents=True, exist_ok=True)
            wrapper.write_text(f'#!/bin/sh\nexec {sys.executable} {__file__} --odis {self.odis} --as-odis "$@"\n')
            wrapper.chmod(0o755)

    def run(self, command, as_written):
        environment = dict(os.environ, PATH=f"{self.place}/bin:{os.environ['PATH']}")
        environment["ODIS_MANUAL_AS_WRITTEN"] = "1" if as_written else ""
        if self.installed:
            environment["PKG_CONFIG_PATH"] = str(next(self.installed.rglob("odis.pc")).parent)
        return subprocess.run(["bash", "-e", "-o", "pipefail", "-c", command], cwd=self.place, env=environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", timeout=300)

    def why_not(self, block, command):
        """Why a command does not run here, or nothing."""
        for words, why in block.skips:
            if words in re.sub(r" #.*", "", command):
                return why
        for pattern, trial, name in NEEDS:
            if re.search(pattern, command):
                if name not in self.missing:
                    self.missing[name] = self.run(f"odis {trial}", True).returncode != 0
                if self.missing[name]:
                    return f"needs {name}"
        return None

    def check_names(self, block, command):
        """Programs of the project and targets of make that a command names exist."""
        for name in re.findall(r"(?<![\w/~.-])(?:scripts|bench|examples)/[\w./-]+", command):
            if not (ROOT / name).exists():
                self.fail(block.where, f"found '{command}', expected the name of a file in place of {name}")
        makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
        for target in re.findall(r"\bmake ([a-z][a-z-]*)", re.sub(r" #.*", "", command)):
            if not re.search(rf"^{target}:", makefile, re.M):
                self.fail(block.where, f"found '{command}', expected a target of the Makefile in place of {target}")

    def fail(self, where, text):
        print(f"{where}: error: {text}")
        self.failed = True

    def do(self, block):
        if block.language not in NOT_RUN | {"sh", "console"}:
            return self.fail(block.where, f"found a block of '{block.language}', expected sh, console, "
                             + ", ".join(sorted(NOT_RUN)))
        if block.language in NOT_RUN:
            return print(f"{block.where}: not run: {block.language}")
        left_out, scripts = {}, []
        for command, output in block.commands():
            if why := self.why_not(block, command):
                left_out[why] = left_out.get(why, 0) + 1
            elif (word := command.split()[0]) in RUNNABLE or word == "cc" and self.installed:
                scripts.append((command, output))
            elif word in LEFT_OUT:
                self.check_names(block, command)
                left_out[LEFT_OUT[word]] = left_out.get(LEFT_OUT[word], 0) + 1
            else:
                self.fail(block.where, f"found '{command}', which this test does not run, expected a comment above "
                          "the block: <!-- blocks: skip WORDS, WHY -->")
        self.counts["ran"] += len(scripts)
        self.counts["left out"] += sum(left_out.values())
        print(f"{block.where}: {len(scripts)} run"
              + "".join(f"; {count} not run: {why}" for why, count in left_out.items()), flush=True)
        if block.language == "sh" and scripts:
            text = "\n".join(command for command, _ in scripts)
            placeholders = {**PLACEHOLDERS, "/opt/odis": str(self.installed)} if self.installed else PLACEHOLDERS
            for word, value in placeholders.items():
                text = re.sub(rf"(?<![\w/$]){word}(?!\w)", value, text)
            self.expect_success(block, text, False)
        for command, output in scripts if block.language == "console" else []:
            found = self.expect_success(block, command, True)
            if found is not None and not same_lines(output, found.rstrip("\n").split("\n") if found else []):
                self.fail(block.where, f"$ {command}\nexpected\n" + "\n".join(output) + f"\nfound\n{found}")

    def expect_success(self, block, text, as_written):
        done = self.run("set -x\n" + text if not as_written else text, as_written)
        if done.returncode == 0:
            return done.stdout
        return self.fail(block.where, f"exit code {done.returncode} of\n{text}\n{done.stdout[-2000:]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--odis", default="/nowhere", type=pathlib.Path, help="the program")
    parser.add_argument("--installed", metavar="PREFIX", type=pathlib.Path, help="where the library is installed")
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="default: all")
    arguments = parser.parse_args()
    pages = arguments.pages or ["README.md", *sorted(str(p.relative_to(ROOT)) for p in ROOT.glob("docs/*.md")),
                                "examples/README.md", "examples/tiny/README.md", "examples/film/README.md"]
    with tempfile.TemporaryDirectory(prefix="odis-manual-") as folder:
        runner = Runner(arguments.odis.resolve(), arguments.installed and arguments.installed.resolve(),
                        pathlib.Path(folder))
        for page in pages:
            try:
                blocks = list(blocks_of(page, (ROOT / page).read_text(encoding="utf-8")))
                if any(block.language in ("sh", "console") for block in blocks):
                    runner.enter(page)
                for block in blocks:
                    runner.do(block)
            except SyntaxError as error:
                runner.fail(page, error)
    print(f"{runner.counts['ran']} commands run, {runner.counts['left out']} not run")
    sys.exit(1 if runner.failed else 0)


if __name__ == "__main__":
    if "--as-odis" in sys.argv:
        at = sys.argv.index("--as-odis")
        program, given = sys.argv[at - 1], sys.argv[at + 1:]
        os.execv(program, [program, *(given if os.environ.get("ODIS_MANUAL_AS_WRITTEN") else small(given))])
    main()
