"""A line of text that says how much of an image is traced."""

import sys

import mitsuba as mi


class ProgressLine:
    """Called with fractions from 0 to 1. A terminal or a notebook shows one line that changes, other files get a line
    for every tenth."""

    def __init__(self, stream=None, title="odis"):
        self.stream, self.title = stream or sys.stderr, title
        self.changes = self.stream.isatty() or in_notebook()
        self.shown = None

    def __call__(self, fraction):
        percent = int(100 * min(fraction, 1))
        step = 1 if self.changes else 10
        if self.shown is None or percent // step != self.shown // step:
            self.shown = percent
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
