# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a window shows, through the interface that screen readers use. Runs with the system's
Python, which has the bindings: each line on stdin is answered by a line of JSON, the widgets that show
of the process that the argument names."""

import json
import sys
from typing import Any

import gi

gi.require_version("Atspi", "2.0")
from gi.repository import Atspi, GLib  # noqa: E402

DEEPEST = 20
# Each question takes its time, and nobody asks what is in these.
LEFT_OUT = {"tool bar", "menu bar", "status bar", "page tab list", "separator"}


def application(process: int) -> Any:
    desktop = Atspi.get_desktop(0)
    for i in range(desktop.get_child_count()):
        child = desktop.get_child_at_index(i)
        if child is not None and child.get_process_id() == process:
            child.set_cache_mask(Atspi.Cache.NONE)
            return child
    return None


def content(widget: Any, role: str) -> str:
    """What a field holds."""
    if role == "spin button":
        return repr(Atspi.Value.get_current_value(widget))
    if role in ("text", "label"):
        text = widget.get_text_iface()
        return Atspi.Text.get_text(text, 0, Atspi.Text.get_character_count(text)) if text else ""
    return ""


def collect(widget: Any, parent: int, depth: int, found: list[dict]) -> None:
    states = widget.get_state_set()
    # The application itself is in no state at all.
    if depth > DEEPEST or (depth > 0 and not states.contains(Atspi.StateType.SHOWING)):
        return
    role = widget.get_role_name()
    if role in LEFT_OUT:
        return
    box = Atspi.Component.get_extents(widget, Atspi.CoordType.SCREEN) if depth else None
    index = len(found)
    found.append({
        "role": role, "name": widget.get_name(), "tooltip": widget.get_description(),
        "box": [box.x, box.y, box.width, box.height] if box else [0, 0, 0, 0],
        "content": content(widget, role), "parent": parent})
    for i in range(widget.get_child_count()):
        child = widget.get_child_at_index(i)
        if child is not None:
            collect(child, index, depth + 1, found)


def main() -> None:
    process = int(sys.argv[1])
    Atspi.init()
    Atspi.set_timeout(20000, 20000)
    for _ in sys.stdin:
        found: list[dict] = []
        try:
            root = application(process)
            if root is not None:
                collect(root, -1, 0, found)
        except GLib.Error:
            found = []  # something closed while it was read: the reader asks again
        print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main()
