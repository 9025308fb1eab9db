# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The site opens on docs/index.md. README.md, which the tree opens on, is a page beside it."""

PLACES = {"docs/index.md": "index.html", "README.md": "README.html"}


def on_files(files, config):  # the name is MkDocs'
    for source, place in PLACES.items():
        files.get_file_from_path(source).dest_uri = place
    return files
