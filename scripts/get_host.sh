#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Gets a program that loads the plugin. The last line of the output is the folder that has it.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"
# shellcheck source=lib/hosts.sh
. "$ROOT/scripts/lib/hosts.sh"

usage() {
	cat <<END
usage: scripts/get_host.sh HOST

Gets HOST for the tests: ${HOSTS[*]}.
Installs missing Debian packages; builds MeshLab 2025.07 from its source, once, in the cache; copies
Debian's MeshLab 2020.09 into a folder where a plugin can be added without touching the package.
The last line of the output is a folder; under its bin/ are meshlab, meshlabserver or python.
END
}

need_one_host "$@"
folder="$(host_folder "$1")"
# Without its headers there is no plugin for it.
meshlab_sources "$(headers_of "$1")" >/dev/null
echo "$folder"
