"""Which versions of Mitsuba the integrator is for."""

import re
import warnings

LEAST = (3, 9)
TRIED = (3, 9)  # the newest that the tests have run with


def check(version):
    """Raises ImportError where the version is too old, warns where it is newer than any that was tried."""
    found = tuple(int(number) for number in re.findall(r"\d+", version)[:2])
    text = "%d.%d"
    if found < LEAST:
        raise ImportError(f"odis.mitsuba needs Mitsuba {text % LEAST} or later, found {version}: "
                          f'`pip install "mitsuba>={text % LEAST}"` installs it', name="mitsuba")
    if found > TRIED:
        warnings.warn(f"odis.mitsuba was tried with Mitsuba {text % TRIED}, not yet with {version}", stacklevel=3)
