"""How long a guide of a million vertices takes from arrays in Python and from the same arrays in C++, in turns, on the
same number of threads: medians of seconds, and of the seconds of all threads' work, which other programs on the machine
disturb less. Needs the package and the program guide_of_files (`scripts/wheel` builds both).

    python3 bench/guide_in_python.py build/wheel/python/guide_of_files [--vertices 1000000] [--rounds 9] [--threads 2]
"""

import argparse
import pathlib
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python" / "tests"))
import made_up
import odis


def build(fields, context):
    """The guide in Python, and the seconds that it took, by the clock and of all threads' work."""
    options = odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS)
    begin, work = time.perf_counter(), time.process_time()
    builder = odis.GuideBuilder(options, context)
    vertices = odis.PathVertices(**fields)
    builder.add(vertices)
    guide = builder.build()
    return guide, (time.perf_counter() - begin, time.process_time() - work)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="guide_of_files")
    parser.add_argument("--vertices", type=int, default=1000000)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    fields = made_up.vertices(arguments.vertices)
    context = odis.Context(threads=arguments.threads)
    with tempfile.TemporaryDirectory() as folder:
        in_cpp = made_up.InCpp(arguments.program, folder, fields, arguments.threads)
        seconds = {"C++": [], "Python": []}
        # The first round warms up.
        for _ in range(arguments.rounds + 1):
            guide = None
            seconds["C++"].append(in_cpp.build())
            guide, taken = build(fields, context)
            seconds["Python"].append(taken)
        same = in_cpp.guide_bytes() == made_up.guide_bytes(guide)
    for i, kind in enumerate(("by the clock", "of work")):
        taken = {name: [rounds[i] for rounds in all_rounds[1:]] for name, all_rounds in seconds.items()}
        median = {name: statistics.median(numbers) for name, numbers in taken.items()}
        spans = [f"{name} {median[name]:.3f} ({min(taken[name]):.3f} to {max(taken[name]):.3f})" for name in taken]
        print(f"seconds {kind}: {', '.join(spans)}, ratio {median['Python'] / median['C++']:.3f}")
    print(f"the guides are {'the same' if same else 'different'}")


if __name__ == "__main__":
    main()
