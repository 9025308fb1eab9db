# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a filter: options checked before, every failure a SkeletonError, Ctrl-C at any time."""

from __future__ import annotations

import ctypes
import os
import re
import threading
from collections.abc import Callable
from typing import Any, Union

import numpy as np
import pymeshlab

from . import _plugin

#: A number of mesh units, or a text such as "0.2%" of the bounding box diagonal.
Length = Union[float, str, pymeshlab.PercentageValue, pymeshlab.PureValue]
#: The options that are lengths: pymeshlab tells them from numbers only once a filter runs.
LENGTHS = ("target_length", "epsilon", "bone_tolerance")
#: The options that are one of several: pymeshlab holds them as numbers.
CHOICES = ("pole_method", "preset", "repair", "soma", "units")
INT_MAX = np.iinfo(np.int32).max
#: Held while pymeshlab reads: it makes the file's folder the current one of all threads for that time.
_FOLDER = threading.Lock()


class SkeletonError(ValueError):
    """The mesh, an option or a file is not right; the text says what, how many, and what cures it."""


class SkeletonWarning(UserWarning):
    """There is a result, but not all of it is as asked for; the text says what."""


def filter_options(filter_name: str, options: dict[str, Any],
                   known: dict[str, Any]) -> dict[str, Any]:
    """The options as pymeshlab takes them.

    Args:
        filter_name: For the error of an option that does not exist.
        options: As the user gave them; those that are None keep their defaults.
        known: The filter's parameters and their defaults.

    Raises:
        SkeletonError: An option does not exist, or its value is of the wrong kind; the text names it.
    """
    if unknown := sorted(set(options) - set(known)):
        raise SkeletonError(f"There is no option {', '.join(unknown)} of {filter_name}; there are "
                            f"{', '.join(sorted(known))}.")
    return {name: _option(name, value, known[name])
            for name, value in options.items() if value is not None}


def _no_choice(text: str, options: dict[str, Any]) -> str | None:
    """pymeshlab's error of a choice that does not exist, with the option's name; None if it is another."""
    choices = {value: name for name, value in options.items() if name in CHOICES}
    if found := re.match(r"Enum '(.*)' not found\. Possible values are (.*)", text):
        names = ", ".join(re.findall(r"'[^']*'", found[2]))
        return f"{choices.get(found[1], '')}={found[1]!r} is none of {names}."
    if found := re.match(r"Enum (-?\d+) not valid\. Must be a value between 0 and (\d+)", text):
        # The number that it says is that of the choices.
        return f"{choices.get(int(found[1]), '')}={found[1]} is none of the choices, 0 to {int(found[2]) - 1}."
    return None


def _option(name: str, value: Any, default: Any) -> Any:
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if isinstance(value, (pymeshlab.PercentageValue, pymeshlab.PureValue)):
        if name in LENGTHS:
            return value
        raise SkeletonError(f"{name} is no length: write a {_kind(default)}, not {value!r}.")
    if name in LENGTHS:
        return _length(name, value)
    if name in CHOICES and isinstance(value, str):
        return value
    if isinstance(default, bool):
        if isinstance(value, (bool, int, float)) and value in (0, 1):
            return bool(value)
    elif isinstance(default, int):
        if _is_number(value) and (isinstance(value, int) or value.is_integer()):
            if abs(value) > INT_MAX:
                raise SkeletonError(f"{name}={_real(name, value):.15g} is too large.")
            return int(value)
    elif isinstance(default, float):
        if _is_number(value):
            return _real(name, value)
    else:
        return value
    raise SkeletonError(f"{name}={value!r} is no {_kind(default)}.")


def _kind(default: Any) -> str:
    if isinstance(default, bool):
        return "truth value (True or False)"
    return "whole number" if isinstance(default, int) else "number"


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _real(name: str, value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        raise SkeletonError(f"{name} is too large: a whole number of more than 308 digits.") from None


def _length(name: str, value: Any) -> Any:
    if isinstance(value, str) and value.strip().endswith("%"):
        try:
            percent = float(value.strip().removesuffix("%"))
        except ValueError:
            pass
        else:
            if not 0 <= percent <= 100:
                raise SkeletonError(f"{name}={value!r} is not between 0% and 100%.")
            return pymeshlab.PercentageValue(percent)
    elif _is_number(value):
        return pymeshlab.PureValue(_real(name, value))
    raise SkeletonError(f"{name}={value!r} is no length: write 0.01 (mesh units) or '0.2%' (of the "
                        "bounding box diagonal).")


def apply(layers: pymeshlab.MeshSet, name: str, options: dict[str, Any]) -> dict[str, Any]:
    """Runs a filter and returns its numbers. Ctrl-C cancels it; the layers are then as before.

    Raises:
        SkeletonError: The filter failed, for whatever reason; in its own words, on one line.
    """
    return _guarded(lambda: _interruptible(lambda: layers.apply_filter(name, **options)), options)


def open_mesh(path: str) -> pymeshlab.MeshSet:
    """A mesh file as MeshLab reads it, in one layer.

    Raises:
        SkeletonError: There is no such file, or it cannot be read.
    """
    full = absolute(path)
    if os.path.isdir(full):
        raise SkeletonError(f"'{path}' is a folder, not a mesh.")
    if not os.path.isfile(full):
        raise SkeletonError(f"There is no file '{path}'.")
    layers = pymeshlab.MeshSet()
    with _FOLDER:
        folder = os.getcwd()
        try:
            _guarded(lambda: layers.load_new_mesh(full), {"path": path})
        except SkeletonError as error:
            text = str(error)
            if text.startswith("Unknown format"):
                text = "its name does not end like a mesh's: .off, .ply, .obj, .stl, .glb, .gltf, .dae, ..."
            else:  # what comes before says again which file it is
                text = text.rpartition("Error details: ")[2]
            raise SkeletonError(f"'{path}' cannot be read: {text}") from None
        finally:
            os.chdir(folder)  # where a failed reading in pymeshlab leaves it is the file's folder
    _place(layers)
    if layers.mesh_number() > 1:
        apply(layers, "generate_by_merging_visible_meshes", {"mergevertices": False})
    return layers


def absolute(path: str) -> str:
    """The absolute form of a path, for pymeshlab.

    Raises:
        SkeletonError: pymeshlab cannot be given its name, which is not UTF-8 or has a zero byte.
    """
    try:
        if b"\0" in path.encode():
            raise SkeletonError(f"{path!r} has a zero byte: it is no path of a file.")
    except UnicodeEncodeError:
        raise SkeletonError(f"The path {path!a} is not UTF-8, as pymeshlab needs it: rename it.") from None
    if os.path.isabs(path):
        return path
    with _FOLDER:
        return os.path.abspath(path)


def _place(layers: pymeshlab.MeshSet) -> None:
    """Moves the vertices of layers that have a matrix, as of a glTF node, to where it puts them."""
    for layer in list(layers):
        matrix = layer.transform_matrix()
        if np.array_equal(matrix, np.eye(4)):
            continue
        layers.set_current_mesh(layer.id())
        apply(layers, "apply_matrix_freeze", {"alllayers": False})
        if np.linalg.det(matrix[:3, :3]) < 0 and layer.face_number():
            apply(layers, "meshing_invert_face_orientation", {"forceflip": True, "onlyselected": False})


def _guarded(action: Callable[[], Any], options: dict[str, Any]) -> Any:
    try:
        return action()
    except (SkeletonError, MemoryError):
        raise
    except Exception as error:  # pymeshlab has several kinds, RuntimeError among them
        text = reason(error)
        if choice := _no_choice(text, options):
            raise SkeletonError(choice) from None
        named = [name for name, value in options.items() if isinstance(value, str)
                 and f"'{value}'" in text and name not in text]
        raise SkeletonError(", ".join(named) + ": " + text if named else text) from None


def reason(error: Exception) -> str:
    """The plugin's own words in pymeshlab's error, on one line."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if len(lines) > 1:
        lines = [line.removeprefix("Details: ") for line in lines[1:]]
    return " ".join(lines) or type(error).__name__


def _interruptible(action: Callable[[], Any]) -> Any:
    """Runs an action in a thread of its own, so that this one hears of Ctrl-C, and cancels it then."""
    if threading.current_thread() is not threading.main_thread():
        return action()  # signals are the main thread's
    cancel = ctypes.c_int(0)
    ended = threading.Event()
    outcome: list[Any] = []

    def work() -> None:
        try:
            _plugin.cancel_when(cancel)
            outcome.append((action(), None))
        except BaseException as error:
            outcome.append((None, error))
        finally:
            _plugin.cancel_when(None)
            ended.set()

    threading.Thread(target=work, name="mcfskel", daemon=True).start()
    try:
        _wait(ended)
    except BaseException:  # KeyboardInterrupt, or what another signal's handler raises
        cancel.value = 1
        _wait(ended)
        raise
    result, error = outcome[0]
    if error is not None:
        raise error
    return result


def _wait(ended: threading.Event) -> None:
    while not ended.wait(0.1):  # a wait without end hears of no signal on Windows
        pass
