#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the plugin for one host. The last line of the output is the path of the plugin.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"

usage() {
	cat <<END
usage: scripts/build.sh HOST

Builds the plugin for HOST: ${HOSTS[*]}.
Installs missing Debian packages and fetches the headers of the MeshLab release.

environment:
  MESHLAB_SRC    source tree of that release, instead of fetching one
  MCFSKEL_CACHE  where downloads are kept (default: ~/.cache/mcfskel)
  MCFSKEL_JOBS   parallel compilations (default: the number of processors)
END
}

need_one_host "$@"
build_host "$1"
