#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then times this project beside its peers: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/bench.sh
. "$ROOT/scripts/lib/bench.sh"

check_options bench/bench_options.py "$@"
python="$(bench_python)"
host=()
for argument in "$@"; do
	case "$argument" in
	# The latter are what follows --only.
	--host | --only=host | --only=kept | host | kept)
		# shellcheck source=lib/python_env.sh
		. "$ROOT/scripts/lib/python_env.sh"
		plugin="$("$ROOT/scripts/build.sh" pymeshlab | tail -n 1)"
		host_python="$(python_env)"
		host=(--plugin "$plugin" --host-python "$host_python")
		break
		;;
	esac
done
programs="$(build_bench)"
exec "$python" "$ROOT/scripts/bench/bench.py" --programs "$programs" "${host[@]}" "$@"
