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

BENCH_PACKAGES=(g++ cmake ninja-build libeigen3-dev libqhull-dev libcgal-dev libbenchmark-dev
	python3 python3-venv)

# Prints the folder of the programs, building them if need be.
build_bench() {
	local folder="$ROOT/build/bench" sources
	sources="$(meshlab_sources 2025.07)"
	quietly cmake -S "$ROOT" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DMCFSKEL_PLUGIN=OFF -DMCFSKEL_BENCH=ON -DMESHLAB_SRC="$sources" ||
		die "could not configure the bench"
	if ! ninja -C "$folder" -n | grep -q 'no work to do'; then
		say "building the bench and CGAL's program"
		quietly ninja -C "$folder" -j "$JOBS" || die "could not build the bench"
	fi
	echo "$folder/tests/bench"
}

# Prints the interpreter of the bench's own Python environment, which holds the peers from PyPI.
bench_python() {
	local wanted folder
	wanted="$(cat "$ROOT"/scripts/bench/requirements*.txt | sha256sum | cut -c 1-12)"
	folder="$CACHE/bench-python-$wanted"
	with_lock "bench-python-$wanted" make_bench_python "$folder" >&2
	echo "$folder/bin/python"
}

make_bench_python() {
	local folder="$1" peer
	[ ! -f "$folder/complete" ] || return 0
	say "preparing Python for the bench"
	rm -rf "$folder"
	/usr/bin/python3 -m venv "$folder"
	local pip=("$folder/bin/python" -m pip install --disable-pip-version-check)
	quietly "${pip[@]}" -r "$ROOT/scripts/bench/requirements.txt" ||
		die "could not install scripts/bench/requirements.txt"
	# A peer that cannot be had is left out of the table; the bench does not depend on it.
	while read -r peer; do
		quietly "${pip[@]}" "$peer" || say "could not install $peer: it will be missing in the table"
	done < <(grep -v '^#' "$ROOT/scripts/bench/requirements-peers.txt")
	touch "$folder/complete"
}

need_packages "${BENCH_PACKAGES[@]}"
python="$(bench_python)"
for argument in "$@"; do
	case "$argument" in
	-h | --help) exec "$python" "$ROOT/scripts/bench/bench.py" --help ;;
	esac
done
host=()
for argument in "$@"; do
	# Also as in --only host and --only kept.
	if [ "$argument" = --host ] || [ "$argument" = host ] || [ "$argument" = kept ]; then
		# shellcheck source=lib/python_env.sh
		. "$ROOT/scripts/lib/python_env.sh"
		plugin="$("$ROOT/scripts/build.sh" pymeshlab | tail -n 1)"
		host_python="$(python_env)"
		host=(--plugin "$plugin" --host-python "$host_python")
	fi
done
programs="$(build_bench)"
exec "$python" "$ROOT/scripts/bench/bench.py" --programs "$programs" "${host[@]}" "$@"
