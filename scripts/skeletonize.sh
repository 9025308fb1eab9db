#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then computes and draws the curve skeleton of a mesh: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"

need_packages python3
for argument in "$@"; do
	case "$argument" in
	-h | --help) exec /usr/bin/python3 "$ROOT/scripts/skeletonize.py" --help ;;
	esac
done
/usr/bin/python3 "$ROOT/scripts/skeletonize.py" --only-check "$@"
plugin="$(build_host pymeshlab)"
python="$(python_env)"
exec "$python" "$ROOT/scripts/skeletonize.py" --plugin "$plugin" "$@"
