#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then runs the filters on hostile meshes, or the readers on hostile files:
# see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"

usage() {
	cat <<'END'
usage: scripts/fuzz.sh [COUNT] [SEED] [OPTION...]
       scripts/fuzz.sh --readers MINUTES [TARGET...]

  COUNT    hostile meshes to run whole jobs on (default: 300)
  SEED     of the generator: the same seed gives the same meshes (default: 1)
  OPTION   of scripts/fuzz/hostile.py, such as --seconds 3600 --workers 1 for as many of COUNT as can be
           had in that time on one core

  --readers MINUTES [TARGET...]
           fuzzes the readers of files instead, each for so many minutes, two at a time; TARGET names
           those to run (default: all of tests/fuzz/)

Both print a table and where what failed is kept; the exit status is 0 only if nothing did.
END
}

wrong_use() {
	usage >&2
	exit 2
}

is_number() {
	[[ "$1" =~ ^[0-9]+$ ]]
}

case "${1:-}" in
-h | --help)
	usage
	exit 0
	;;
--readers)
	{ [ $# -ge 2 ] && is_number "$2" && [ "$2" -gt 0 ]; } || wrong_use
	shift
	exec "$ROOT/scripts/fuzz/readers.sh" "$@"
	;;
esac
count=300 seed=1
if [ $# -gt 0 ] && is_number "$1"; then
	count="$1"
	shift
fi
if [ $# -gt 0 ] && is_number "$1"; then
	seed="$1"
	shift
fi
[[ $# -eq 0 || "$1" == --* ]] || wrong_use
python="$(python_env)"
MCFSKEL_PLUGIN="$(build_host pymeshlab)"
export MCFSKEL_PLUGIN
exec "$python" "$ROOT/scripts/fuzz/hostile.py" "$count" "$seed" "$@"
