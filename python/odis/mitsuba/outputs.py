"""Files that are written: checked before there is anything to write, and whole where they appear."""

import os
import tempfile


def check_outputs(read, paths):
    """Raises ValueError unless all these files may be written, and are neither one another nor the file that is read."""
    seen = {os.path.realpath(read)}
    for path in paths:
        _check_target(path)
        if is_special(path):
            continue
        if os.path.realpath(path) in seen:
            raise ValueError(f"{path}: expected a file of its own, found one that is read or written already")
        seen.add(os.path.realpath(path))


def _check_target(path):
    """A file to write, before there is anything to write."""
    folder = os.path.dirname(os.path.realpath(path))
    if os.path.isdir(path):
        raise ValueError(f"{path}: expected a file, found a folder")
    if not os.path.isdir(folder):
        raise ValueError(f"{path}: expected that its folder exists")
    if not os.access(path if is_special(path) else folder, os.W_OK):
        raise ValueError(f"{path}: expected a place that may be written to")


def is_special(path):
    """Whether it is written straight into: a device, a pipe, or an open file of a process, which is what /dev/stdout
    leads to and may be a plain file."""
    while True:
        folder = os.path.realpath(os.path.dirname(os.path.abspath(path)))
        if f"{folder}/".startswith("/proc/"):
            return True
        path = os.path.join(folder, os.path.basename(path))
        if not os.path.islink(path):
            return os.path.exists(path) and not os.path.isfile(path)
        path = os.path.join(folder, os.readlink(path))


def write_whole(path, data):
    """Writes bytes so that under this name there is all or nothing."""
    if is_special(path):
        with open(path, "ab") as file:
            file.write(data)
        return
    path = os.path.realpath(path)  # A link stays, and leads to the new file.
    handle, beside = tempfile.mkstemp(prefix=f".{os.path.basename(path)}.", dir=os.path.dirname(path))
    try:
        with open(handle, "wb") as file:
            file.write(data)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(beside, 0o666 & ~mask)
        os.replace(beside, path)
    except BaseException:
        os.unlink(beside)
        raise
