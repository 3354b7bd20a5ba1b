"""A line of text that says how much of an image is traced."""

import sys
import time

import mitsuba as mi

SECONDS_PER_LINE = 10  # where lines stay


class ProgressLine:
    """Called with fractions from 0 to 1. A terminal or a notebook shows one line that changes, other files get a line
    every ten seconds, and one at the end."""

    def __init__(self, stream=None, title="odis"):
        self.stream, self.title = stream or sys.stderr, title
        self.changes = self.stream.isatty() or in_notebook()
        self.shown, self.last = None, time.monotonic()

    def __call__(self, fraction):
        percent = int(100 * min(fraction, 1))
        due = self.changes or percent == 100 or time.monotonic() - self.last >= SECONDS_PER_LINE
        if due and percent != self.shown:
            self.shown, self.last = percent, time.monotonic()
            begin, end = ("\r", "\n" if percent == 100 else "") if self.changes else ("", "\n")
            self.stream.write(f"{begin}{self.title}: {percent:3d} % of the samples{end}")
            self.stream.flush()


def in_notebook():
    """Whether Jupyter runs this."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


def default_progress():
    """As with Mitsuba's own progress: shown to people, if the log level is Info or lower."""
    if mi.log_level() <= mi.LogLevel.Info and (sys.stderr.isatty() or in_notebook()):
        return ProgressLine()
    return lambda fraction: None
