# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab in a window on a display of its own, used as a person does: by keys and mouse, looking at
what the window shows and at the log."""

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Optional, TypeVar

from display import SIZE, display

PATIENCE = 180.0  # seconds: a busy machine is slow, and nothing is gained by giving up early

T = TypeVar("T")


@dataclass(frozen=True)
class Widget:
    role: str
    name: str
    tooltip: str
    box: tuple[int, int, int, int]  # left, top, width, height, in pixels of the screen
    content: str
    parent: int

    @property
    def centre(self) -> tuple[int, int]:
        left, top, width, height = self.box
        return left + width // 2, top + height // 2


@dataclass(frozen=True)
class Layer:
    number: int
    name: str
    eye: tuple[int, int, int, int]  # where its visibility is shown


class View(list[Widget]):
    """The widgets that show, parents before children."""

    def within(self, root: Widget) -> "View":
        """The widgets inside another one."""
        inside = {next(i for i, widget in enumerate(self) if widget is root)}
        for i, widget in enumerate(self):
            if widget.parent in inside:
                inside.add(i)
        return View(widget for i, widget in enumerate(self) if i in inside and widget is not root)

    def all(self, role: str, name: str = "") -> "View":
        """Widgets of that role whose name matches a pattern from its beginning."""
        return View(w for w in self if w.role == role and re.match(name, w.name))

    def field(self, label: str, role: str = "text") -> list[Widget]:
        """The fields to the right of a label, from left to right."""
        named = self.all("label", re.escape(label) + "$")
        if not named:
            return []
        left, top, width, height = named[0].box
        return sorted((w for w in self if w.role == role and w.box[0] >= left + width
                       and top <= w.centre[1] <= top + height), key=lambda w: w.box[0])


class Window:
    """A running MeshLab. Use it in a `with` statement: leaving it ends all that was started."""

    def __init__(self, program: Path, *meshes: Path, data: Optional[Path] = None) -> None:
        """`data`: where MeshLab looks for what the user has installed ($XDG_DATA_HOME)."""
        # Not a folder of pytest's: names of sockets must be short.
        self.folder = Path(tempfile.mkdtemp(prefix="window"))
        self.log_file = self.folder / "log"
        self.started: list[subprocess.Popen] = []
        self.resources = ExitStack()
        try:
            self.start(program, meshes, data or self.folder / "data")
        except BaseException:
            self.stop()
            raise

    def __enter__(self) -> "Window":
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()

    def start(self, program: Path, meshes: tuple[Path, ...], data: Path) -> None:
        config = self.folder / "config" / "VCG" / "MeshLab_64bit_fp.conf"
        config.parent.mkdir(parents=True)
        config.write_text("[General]\ninformativeShown=true\n"
                          "MeshLab%3A%3ASystem%3A%3AcheckForUpdate=false\n")
        (self.folder / "run").mkdir(mode=0o700)
        environment = os.environ | {
            "HOME": str(self.folder), "XDG_RUNTIME_DIR": str(self.folder / "run"),
            "XDG_CONFIG_HOME": str(self.folder / "config"), "XDG_DATA_HOME": str(data),
            "QT_LINUX_ACCESSIBILITY_ALWAYS_ON": "1", "LC_ALL": "C.UTF-8", "GDK_BACKEND": "x11"}
        for name in ["WAYLAND_DISPLAY", "XAUTHORITY", "QT_QPA_PLATFORM", "AT_SPI_BUS_ADDRESS"]:
            environment.pop(name, None)
        self.environment = environment
        environment["DISPLAY"] = self.resources.enter_context(display())
        bus = self.run("dbus-daemon", "--session", "--nofork", "--print-address=1",
                       stdout=subprocess.PIPE)
        environment["DBUS_SESSION_BUS_ADDRESS"] = bus.stdout.readline().decode().strip()
        if not environment["DBUS_SESSION_BUS_ADDRESS"]:
            raise RuntimeError("dbus-daemon did not start")
        with open(self.log_file, "wb") as log:
            self.meshlab = self.run(str(program), *map(str, meshes), stdout=log,
                                    stderr=subprocess.STDOUT)
        self.main = self.wait(self.main_window, "the main window on the display")
        # The reader starts the bus for screen readers. A Qt program that finds this bus when it starts
        # may never tell what it shows; one that sees the bus come always does.
        self.reader = self.run("/usr/bin/python3", str(Path(__file__).with_name("accessible.py")),
                               str(self.meshlab.pid), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               text=True)
        self.wait(lambda: self.view().all("frame", "MeshLab"), "the main window")
        # Without a window manager windows are as large as they happen to be.
        self.call("xdotool", "windowmove", self.main, "0", "0")
        self.call("xdotool", "windowsize", self.main, *map(str, SIZE))
        self.wait(lambda: [w for w in self.view().all("frame", "MeshLab") if w.box[2:] == SIZE],
                  "the main window in full size")
        if any(mesh.suffix == ".mlp" for mesh in meshes):
            self.wait(self.layers, "the layers of the project")  # of which the log says nothing
        elif meshes:
            self.wait_log("All files opened")

    def main_window(self) -> Optional[str]:
        """The number that the display gave to MeshLab's main window, once it shows."""
        found = subprocess.run(
            ["xdotool", "search", "--onlyvisible", "--name", "^MeshLab 20"], env=self.environment,
            capture_output=True, text=True, timeout=PATIENCE).stdout.split()
        return found[-1] if found else None

    def run(self, *command: str, **options: Any) -> subprocess.Popen:
        """Starts a program in a group of its own, which stop() ends."""
        options.setdefault("stdin", subprocess.DEVNULL)
        options.setdefault("stderr", subprocess.DEVNULL)
        process = subprocess.Popen(command, env=self.environment, start_new_session=True,
                                   cwd=self.folder, **options)
        self.started.append(process)
        return process

    def stop(self) -> None:
        for process in reversed(self.started):
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        self.resources.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def alive(self) -> bool:
        return self.meshlab.poll() is None

    # Looking

    def log(self) -> str:
        return self.log_file.read_text(errors="replace")

    def view(self) -> View:
        """What shows at this moment; empty if it could not be read."""
        self.reader.stdin.write("\n")
        self.reader.stdin.flush()
        found = json.loads(self.reader.stdout.readline())
        return View(Widget(**{**w, "box": tuple(w["box"])}) for w in found)

    def wait(self, condition: Callable[[], T], what: str, seconds: float = PATIENCE) -> T:
        """Waits until a condition is met and returns its value."""
        end = time.monotonic() + seconds
        while True:
            value = condition()
            if value:
                return value
            if not self.alive:
                raise AssertionError(f"MeshLab ended while waiting for {what}:\n{self.log()}")
            if time.monotonic() > end:
                raise AssertionError(f"waited in vain for {what}; the log is\n{self.log()}")
            time.sleep(0.1)

    def wait_log(self, pattern: str, count: int = 1) -> list[str]:
        """Waits until a pattern is in the log that often, and returns what it matched."""
        return self.wait(lambda: (found := re.findall(pattern, self.log())) and len(found) >= count
                         and found, f"'{pattern}' in the log")

    def shown(self, role: str, name: str) -> View:
        """What is in a window, a dialog or a box of that name; empty if it does not show."""
        view = self.view()
        roots = view.all(role, re.escape(name) + "$")
        return view.within(roots[0]) if roots else View()

    def layers(self) -> list[Layer]:
        """The rows of the list of layers."""
        rows: dict[int, list[Widget]] = {}
        for cell in self.view().all("table cell"):
            rows.setdefault(cell.box[1], []).append(cell)
        layers = []
        for top in sorted(rows):
            cells = sorted(rows[top], key=lambda w: w.box[0])
            at = next((i for i, w in enumerate(cells) if w.name.isdigit()), 0)
            if at > 0 and at + 1 < len(cells):
                layers.append(Layer(int(cells[at].name), cells[at + 1].name, cells[at - 1].box))
        return layers

    def picture(self, file: Path, box: Optional[tuple[int, int, int, int]] = None) -> Path:
        crop = [] if box is None else ["-crop", "{2}x{3}+{0}+{1}".format(*box), "+repage"]
        self.call("import", "-window", "root", *crop, str(file))
        return file

    def still_picture(self, file: Path, box: Optional[tuple[int, int, int, int]] = None) -> Path:
        """A picture taken when nothing moves any more."""
        def pixels() -> bytes:
            # Unlike PNG this format has no room for the time.
            return self.picture(self.folder / "now.ppm", box).read_bytes()

        def still() -> bool:
            before = pixels()
            time.sleep(0.2)
            return pixels() == before

        self.wait(still, "a still picture")
        return self.picture(file, box)

    # Doing

    def call(self, *command: str) -> str:
        return subprocess.run(command, env=self.environment, check=True, capture_output=True,
                              text=True, timeout=PATIENCE).stdout

    def keys(self, *names: str) -> None:
        self.call("xdotool", "key", "--delay", "40", *names)

    def write(self, text: str) -> None:
        self.call("xdotool", "type", "--delay", "25", "--", text)

    def click(self, widget: Widget) -> None:
        if not all(0 <= at < size for at, size in zip(widget.centre, SIZE)):
            raise AssertionError(f"{widget.role} {widget.name} at {widget.centre} is not on the screen")
        self.call("xdotool", "mousemove", *map(str, widget.centre), "click", "1")

    def click_at(self, box: tuple[int, int, int, int]) -> None:
        """Clicks into the middle of what has no widget of its own."""
        left, top, width, height = box
        self.call("xdotool", "mousemove", str(left + width // 2), str(top + height // 2), "click", "1")

    def turn(self, right: int, down: int) -> None:
        """Turns the view by dragging the mouse over it that many pixels."""
        x, y = self.view().all("layered pane")[0].centre
        self.call("xdotool", "mousemove", str(x), str(y), "mousedown", "1")
        for step in range(1, 11):
            self.call("xdotool", "mousemove", str(x + right * step // 10), str(y + down * step // 10))
        self.call("xdotool", "mouseup", "1")

    def open_filter(self, name: str, words: str = "") -> Widget:
        """Searches for a filter by its name, or by other words, and opens what is found first; returns its dialog."""
        for patience in (8, 16, 32, 64):
            self.call("xdotool", "windowfocus", self.main)
            self.keys("ctrl+f", "ctrl+a")
            self.write(words or name)
            self.keys("Down", "Return")
            try:
                return self.wait(lambda: self.dialog(name), f"the dialog of {name}", patience)
            except AssertionError:
                if not self.alive:
                    raise
                self.keys("Escape")
        raise AssertionError(f"the search does not find {name}")

    def dialog(self, name: str) -> Optional[Widget]:
        """The filter dialog of that name, if it shows."""
        view = self.view()
        frames = [w for role in ("frame", "panel", "filler") for w in view.all(role, re.escape(name) + "$")
                  if view.within(w).all("push button", "Apply$")]
        return frames[0] if frames else None

    def fill(self, dialog: str, label: str, value: str, role: str = "text", column: int = 0) -> None:
        """Writes into a field of a filter dialog until it holds that."""
        def field() -> Widget:
            return self.wait(lambda: self.shown("frame", dialog).field(label, role)[column:],
                             f"the field {label}")[0]

        def holds() -> bool:
            content = field().content
            return content == value or (role == "spin button" and float(content) == float(value))

        for _ in range(4):
            self.click(field())
            self.keys("ctrl+a")
            self.write(value)
            self.keys("Tab")
            try:
                self.wait(holds, f"{value} in {label}", 5)
                return
            except AssertionError:
                if not self.alive:
                    raise
        raise AssertionError(f"{label} does not take {value}")

    def press(self, dialog: str, button: str) -> None:
        """Presses a button of a window; where that scrolls, after turning the wheel until it shows."""
        def find() -> Optional[tuple[Widget, Widget]]:
            view = self.view()
            for frame in view:
                if frame.role in ("frame", "dialog", "alert") and re.match(dialog, frame.name):
                    buttons = view.within(frame).all("push button", re.escape(button) + "$")
                    if buttons:
                        return frame, buttons[0]
            return None

        for _ in range(20):
            frame, found = self.wait(find, f"the button {button}")
            left, top, _, height = frame.box
            if found.centre[1] < top + height:
                break
            # Over the labels: a turn over a field changes its value.
            self.call("xdotool", "mousemove", str(left + 12), str(top + height // 2),
                      "click", "--repeat", "5", "5")
        self.click(found)

    def choose_file(self, dialog: str, file: Path) -> None:
        """Chooses a file to write, by the button of a filter dialog: what is typed into the field itself MeshLab
        2020.09 does not take."""
        self.press(re.escape(dialog), "...")
        self.wait(lambda: self.shown("dialog", "Save"), "the dialog of files")
        self.write(str(file))
        self.keys("Return")
        self.wait(lambda: not self.shown("dialog", "Save"), "the dialog of files to close")

    def close(self, dialog: str) -> None:
        """Closes a filter dialog."""
        self.press(re.escape(dialog), "Close")
        self.wait(lambda: not self.dialog(dialog), "the dialog to close")
