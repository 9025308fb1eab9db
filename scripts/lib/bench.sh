# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The programs of the bench, and its own Python. Source after common.sh and meshlab_sources.sh.

# shellcheck shell=bash

BENCH_PACKAGES=(g++ cmake ninja-build libeigen3-dev libqhull-dev libcgal-dev libbenchmark-dev
	python3 python3-venv)

# check_options FILE ARGUMENT...: answers --help, and tells mistakes before anything is built. FILE, in scripts/,
# parses the arguments.
check_options() {
	local options="$ROOT/scripts/$1" argument
	shift
	for argument in "$@"; do
		case "$argument" in
		-h | --help)
			need_packages python3
			exec /usr/bin/python3 "$options" --help
			;;
		esac
	done
	need_packages "${BENCH_PACKAGES[@]}"
	/usr/bin/python3 "$options" "$@"
}

# build_bench [PROGRAM...]: prints the folder of the programs, building these, or all, if need be.
build_bench() {
	local folder="$ROOT/build/bench" sources
	sources="$(meshlab_sources 2025.07)"
	locked "$folder" build_bench_in "$folder" "$sources" "$@" >&2
	echo "$folder/tests/bench"
}

build_bench_in() {
	local folder="$1" sources="$2"
	shift 2
	quietly cmake -S "$ROOT" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DMCFSKEL_PLUGIN=OFF -DMCFSKEL_BENCH=ON -DMESHLAB_SRC="$sources" ||
		die "could not configure the bench"
	if ! ninja -C "$folder" -n "$@" | grep -q 'no work to do'; then
		say "building the programs of the bench"
		quietly ninja -C "$folder" -j "$JOBS" "$@" || die "could not build the bench"
	fi
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
	local pip=("$folder/bin/python" -m pip install --disable-pip-version-check)
	if [ ! -f "$folder/complete" ]; then
		say "preparing Python for the bench"
		rm -rf "$folder"
		/usr/bin/python3 -m venv "$folder"
		quietly "${pip[@]}" -r "$ROOT/scripts/bench/requirements.txt" ||
			die "could not install scripts/bench/requirements.txt"
		grep -v '^#' "$ROOT/scripts/bench/requirements-peers.txt" >"$folder/missing"
		touch "$folder/complete"
	fi
	[ -s "$folder/missing" ] || return 0
	# A peer that cannot be had is left out of the table, and tried again in the next run: the network may have
	# been down. The bench does not depend on it.
	while read -r peer; do
		quietly "${pip[@]}" "$peer" </dev/null || {
			say "could not install $peer: it will be missing in the table"
			echo "$peer"
		}
	done <"$folder/missing" >"$folder/missing.part"
	mv "$folder/missing.part" "$folder/missing"
}
