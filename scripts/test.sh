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
	cat <<END
usage: scripts/test.sh [CTEST_OPTION...]

Sets up what is missing, builds everything and runs every test; -R NAME runs those whose names match, -N lists them.

environment:
  MCFSKEL_TEST_HOSTS  the hosts to test in besides pymeshlab, by name
                      (default: ${TEST_HOSTS[*]})
END
	exit 0
	;;
esac

missing=()

# with_python VARIABLE WHAT FILE [PYTHON]: an environment as of python_env() for the tests that ask other programs;
# where it cannot be had the variable stays unset, and those are skipped.
with_python() {
	local variable="$1" what="$2" place
	shift 2
	if place="$(python_env_if_possible "$@")"; then
		export "$variable=$place"
	else
		missing+=("$what SKIPPED: could not be set up; see above")
	fi
}

# Besides GoogleTest what Blender's module expects from the system.
need_packages libgtest-dev libsm6 libxext6 libxfixes3 libxi6 libxkbcommon0 libxrender1
python="$(python_env)"
build_host pymeshlab -DMCFSKEL_TESTS=ON -DMCFSKEL_PYTHON="$python" >&2
folder="$ROOT/build/pymeshlab"
read -r -a hosts <<<"${MCFSKEL_TEST_HOSTS-${TEST_HOSTS[*]}}"
tested=(pymeshlab)
for host in "${hosts[@]}"; do
	# A program of its own: in the condition of an if, errors in a function would go unseen.
	if place="$("$ROOT/scripts/get_host.sh" "$host")"; then
		variable="$(tr a-z.- A-Z__ <<<"$host")"
		more=()
		[ "$host" != meshlab-2025.07 ] || more=("-DMESHLAB_BUILT=$place")
		plugin="$(build_host "$host" "${more[@]}")"
		place="$(with_plugin "$host" "$place" "$plugin")"
		export "MCFSKEL_HOST_$variable=$place" "MCFSKEL_PLUGIN_$variable=$plugin"
		tested+=("$host")
	fi
done
with_python MCFSKEL_READERS_PYTHON "navis, VTK, meshio, Blender" requirements-readers.txt
with_python MCFSKEL_VMTK_PYTHON VMTK requirements-vmtk.txt "$(newer_python)"
rm -rf "$folder/pytest" "$folder/ctest.xml"
say "testing"
status=0
ctest --test-dir "$folder" --output-on-failure --no-tests=error -j "$JOBS" \
	--output-junit "$folder/ctest.xml" "$@" || status=$?
# Without a report ctest has run nothing: with -N, say.
if [ -f "$folder/ctest.xml" ]; then
	"$python" "$ROOT/scripts/count_tests.py" "$folder/ctest.xml" "$folder"/pytest/*.xml || status=1
fi
echo "hosts tested: ${tested[*]}"
for host in "${TEST_HOSTS[@]}"; do
	reason="could not be set up; see above"
	[[ " ${hosts[*]} " == *" $host "* ]] || reason="is not in MCFSKEL_TEST_HOSTS"
	[[ " ${tested[*]} " == *" $host "* ]] || echo "HOST SKIPPED: $host $reason"
done
[ "${#missing[@]}" = 0 ] || printf '%s\n' "${missing[@]}"
exit "$status"
