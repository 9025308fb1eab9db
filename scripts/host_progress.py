# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress and log of a pymeshlab filter. pymeshlab offers no callback: it prints to stderr."""

import contextlib
import os
import re
import sys
import threading
from typing import Callable, Iterator

PROGRESS = re.compile(r"^LOG: \d+ (?P<what>.*?)\s*\[ (?P<percent>\d+)% \]$")
MESSAGE = re.compile(r"^LOG: \d+ (?P<text>.*)$")


@contextlib.contextmanager
def host_output(on_progress: Callable[[int, str], None],
                on_message: Callable[[str], None]) -> Iterator[None]:
    """While in force, what the process prints goes to the two functions, and nowhere else.

    They are called from a thread of their own. What Python prints to sys.stderr is not affected if
    it goes to a stream made before by terminal().
    """
    sys.stdout.flush()
    sys.stderr.flush()
    saved = [os.dup(descriptor) for descriptor in (1, 2)]
    reading, writing = os.pipe()
    os.dup2(writing, 1)
    os.dup2(writing, 2)
    os.close(writing)

    def listen() -> None:
        with os.fdopen(reading, errors="replace") as lines:
            for line in lines:
                line = line.rstrip("\n")
                if found := PROGRESS.match(line):
                    on_progress(int(found["percent"]), found["what"])
                elif found := MESSAGE.match(line):
                    on_message(found["text"])

    listener = threading.Thread(target=listen)
    listener.start()
    try:
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for descriptor, original in zip((1, 2), saved):
            os.dup2(original, descriptor)  # closes the last writing ends: the listener comes to an end
            os.close(original)
        listener.join()


def terminal():
    """A stream to where stderr goes now, whatever host_output() does later."""
    return os.fdopen(os.dup(2), "w", buffering=1)
