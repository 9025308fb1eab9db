# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An X display of one's own, without a screen."""

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

SIZE = (1280, 900)


@contextmanager
def display() -> Iterator[str]:
    """The display's name, for $DISPLAY; leaving ends the server."""
    server, name = start_server()
    try:
        yield name
    finally:
        server.terminate()
        server.wait()


def start_server() -> tuple[subprocess.Popen, str]:
    """A server on a free display, ready for clients, and the display's name."""
    # Servers that are told their number hold a lock on it; those that look for one themselves do
    # not, and two that start together may take the same.
    for number in range(99, 199):
        # Without -noreset the server starts over whenever its last client leaves, and refuses
        # whoever connects at that moment.
        server = subprocess.Popen(
            ["Xvfb", f":{number}", "-displayfd", "1", "-screen", "0", "{}x{}x24".format(*SIZE),
             "-nolisten", "tcp", "-noreset"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            start_new_session=True)
        if server.stdout.readline():
            return server, f":{number}"
        server.wait()
    raise RuntimeError("Xvfb did not start on any display")
