#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the fuzz targets of tests/fuzz/ with clang and runs them. Called by scripts/fuzz.sh --readers.

set -euo pipefail
# shellcheck source=../lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/../lib/common.sh"
# shellcheck source=../lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"

FUZZ_PACKAGES=(g++ clang libclang-rt-14-dev libomp-dev cmake ninja-build libeigen3-dev libqhull-dev)
TARGETS=(cg swc skeleton_ply stage_ply stage_flow)
FOLDER="$ROOT/build/fuzz"
FINDINGS="$FOLDER/findings"
# A target that fails again and again is stopped after so many.
MAX_FINDINGS=10

build_targets() {
	local sources
	sources="$(meshlab_sources 2025.07)"
	quietly cmake -S "$ROOT" -B "$FOLDER" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
		-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
		-DMCFSKEL_PLUGIN=OFF -DMCFSKEL_FUZZ=ON -DMESHLAB_SRC="$sources" ||
		die "could not configure the fuzz targets"
	say "building the fuzz targets"
	quietly ninja -C "$FOLDER" -j "$JOBS" || die "could not build the fuzz targets"
	rm -rf "$FOLDER/seeds"
	"$FOLDER/tests/fuzz/make_seeds" "$FOLDER/seeds" || die "could not make the seeds"
}

dictionary_of() {
	case "$1" in
	cg | swc) echo "$ROOT/tests/fuzz/skeleton_text.dict" ;;
	*) echo "$ROOT/tests/fuzz/ply.dict" ;;
	esac
}

# The executions in a log: of all runs that it has, since a finding ends one.
executions_in() {
	sed -n 's/^stat::number_of_executed_units: *//p' "$1" | awk '{ sum += $1 } END { print sum + 0 }'
}

# Edges reached, and all there are.
coverage_in() {
	local reached all
	reached="$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$1" | sort -n | tail -n 1)"
	all="$(sed -n 's/.*Loaded 1 modules *(\([0-9]*\) inline.*/\1/p' "$1" | head -n 1)"
	echo "${reached:-0} of ${all:-0}"
}

# run_target NAME SECONDS: fuzzes until the time is up, findings or not.
run_target() {
	local name="$1" end=$((SECONDS + $2)) log="$FOLDER/$1.log" corpus="$FOLDER/corpus/$1"
	mkdir -p "$corpus" "$FINDINGS/$name"
	: >"$log"
	while [ $((end - SECONDS)) -gt 0 ] &&
		[ "$(find "$FINDINGS/$name" -type f | wc -l)" -lt "$MAX_FINDINGS" ]; do
		OMP_NUM_THREADS=1 "$FOLDER/tests/fuzz/fuzz_$name" -max_total_time=$((end - SECONDS)) \
			-timeout=100 -report_slow_units=100 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
			-dict="$(dictionary_of "$name")" -artifact_prefix="$FINDINGS/$name/" \
			"$corpus" "$FOLDER/seeds/$name" >>"$log" 2>&1 || true
	done
}

minutes="$1"
shift
chosen=("${@:-${TARGETS[@]}}")
for name in "${chosen[@]}"; do
	[[ " ${TARGETS[*]} " == *" $name "* ]] || die "no such target: '$name'; there are: ${TARGETS[*]}"
done
need_packages "${FUZZ_PACKAGES[@]}"
locked "$FOLDER" build_targets
rm -rf "$FINDINGS"
say "fuzzing ${#chosen[@]} targets, $minutes minutes each"
# Each in a process group of its own: whoever stops this script stops what it has started.
set -m
trap 'jobs -p | while read -r group; do kill -- "-$group" 2>/dev/null || true; done' EXIT
trap 'exit 130' INT TERM
for name in "${chosen[@]}"; do
	while [ "$(jobs -rp | wc -l)" -ge 2 ]; do
		wait -n
	done
	run_target "$name" $((60 * minutes)) &
done
wait

status=0
printf '%-14s %12s %9s   %s\n' target executions findings 'edges covered'
for name in "${chosen[@]}"; do
	found="$(find "$FINDINGS/$name" -type f | wc -l)"
	runs="$(executions_in "$FOLDER/$name.log")"
	printf '%-14s %12d %9d   %s\n' "$name" "$runs" "$found" "$(coverage_in "$FOLDER/$name.log")"
	# A target that ran nothing has shown nothing.
	if [ "$found" -gt 0 ] || [ "$runs" -eq 0 ]; then
		status=1
	fi
done
[ "$status" -eq 0 ] || echo "what failed is in $FINDINGS, the reports in $FOLDER/*.log"
exit "$status"
