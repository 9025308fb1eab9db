# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are there as a whole or not at all."""

import contextlib
import errno
import os
import secrets
import stat
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Replaces a file, or leaves it as it was: after any error, and if the process is killed.

    What is written beside it is flushed to the disk before it takes the name. A symbolic link stays, and
    so do the file's permissions and, where the user may, its owner; pipes and devices are written to.

    Raises:
        OSError: with the name of the file.
    """
    target = Path(os.path.realpath(path))
    part = target.with_name(f".mcfskel-{secrets.token_hex(8)}")
    try:
        try:
            there = os.stat(path)
        except FileNotFoundError:
            there = None
        if there and not stat.S_ISREG(there.st_mode):
            with open(path, "wb", buffering=0) as out:
                write_all(out.fileno(), content)
            return
        if there and not os.access(target, os.W_OK, effective_ids=True):
            raise OSError(errno.EACCES, os.strerror(errno.EACCES))
        try:
            out = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600 if there else 0o666)
            try:
                if there:
                    with contextlib.suppress(OSError):  # somebody else's, or no such thing there
                        os.fchown(out, there.st_uid, there.st_gid)
                    with contextlib.suppress(OSError):
                        os.fchmod(out, there.st_mode & 0o777)
                write_all(out, content)
                os.fsync(out)
            finally:
                os.close(out)
            os.replace(part, target)
        except BaseException:
            part.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None


def write_all(descriptor: int, content: bytes) -> None:
    """Writes without a buffer, whose errors would come when nobody looks."""
    rest = memoryview(content)
    while rest:
        rest = rest[os.write(descriptor, rest):]
