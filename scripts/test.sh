#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, builds everything and runs every test. Options go to ctest: -R NAME, say.

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

case "${1:-}" in
-h | --help)
	echo "usage: scripts/test.sh [CTEST_OPTION...]"
	exit 0
	;;
esac

need_packages libgtest-dev
python="$(python_env)"
build_host pymeshlab -DMCFSKEL_TESTS=ON -DMCFSKEL_PYTHON="$python" >&2
# A host that cannot be had on this machine is skipped by its tests, by name.
for host in meshlab-2025.07 meshlab-2020.09; do
	if place="$(host_folder "$host")" && meshlab_sources "$(headers_of "$host")" >/dev/null; then
		plugin="$(build_host "$host")"
		place="$(with_plugin "$host" "$place" "$plugin")"
		declare -x "MCFSKEL_HOST_$(tr 'a-z.-' 'A-Z__' <<<"$host")=$place"
	else
		say "$host could not be set up: its tests are skipped"
	fi
done
folder="$ROOT/build/pymeshlab"
rm -rf "$folder/pytest" "$folder/ctest.xml"
say "testing"
status=0
ctest --test-dir "$folder" --output-on-failure --no-tests=error -j "$JOBS" \
	--output-junit "$folder/ctest.xml" "$@" || status=$?
"$python" "$ROOT/scripts/count_tests.py" "$folder/ctest.xml" "$folder"/pytest/*.xml || status=1
exit "$status"
