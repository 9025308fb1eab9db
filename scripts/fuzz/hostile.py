#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: see hostile_run.py."""

import sys
from pathlib import Path

# Before this folder, so that `hostile` is the package with the meshes.
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

from hostile_run import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
