#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then runs unit tests and whole jobs under sanitizers: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"

SANITIZE_PACKAGES=(g++ clang libclang-rt-14-dev libomp-dev cmake ninja-build libeigen3-dev libqhull-dev
	libgtest-dev)
# What makes OpenMP's synchronisation known to the thread sanitizer.
ARCHER=/usr/lib/llvm-14/lib/libarcher.so
THREADS=3 # of the thread sanitizer's runs
BODIES=40

usage() {
	cat <<'END'
usage: scripts/sanitize.sh [address|thread]... [--tests [FILTER] | --jobs [NAMES]] [--meshes PATTERN]

  address  with the address and undefined behaviour sanitizers, on two threads
  thread   with the thread sanitizer, on three threads; without either: one after the other

  --tests [FILTER]  only the unit tests, those that GoogleTest's FILTER names ('*')
  --jobs [NAMES]    only whole jobs: of default,raw,voronoi,sheets,held,kept,steps (all of them)
  --meshes PATTERN  jobs only on meshes whose file name matches (all of meshes/, and of shared/meshes
                    beside the checkout where that is there), and on many bodies for 'many_bodies'

Exit status 0 only if everything passed and no sanitizer had anything to say. The output of each run stays in
build/sanitize-KIND/.
END
}

wrong_use() {
	usage >&2
	exit 2
}

kinds=() what=all filter='*' jobs=default,raw,voronoi,sheets,held,kept,steps pattern='*'
while [ $# -gt 0 ]; do
	case "$1" in
	-h | --help)
		usage
		exit 0
		;;
	address | thread) kinds+=("$1") ;;
	--tests | --jobs)
		[ "$what" = all ] || wrong_use
		what="${1#--}"
		if [ $# -gt 1 ] && [[ "$2" != -* && "$2" != address && "$2" != thread ]]; then
			if [ "$what" = tests ]; then filter="$2"; else jobs="$2"; fi
			shift
		fi
		;;
	--meshes)
		[ $# -ge 2 ] || wrong_use
		pattern="$2"
		shift
		;;
	*) wrong_use ;;
	esac
	shift
done
[ "${#kinds[@]}" -gt 0 ] || kinds=(address thread)

# build KIND TARGET...: builds what is needed.
build() {
	local kind="$1" folder="$ROOT/build/sanitize-$1" sources
	shift
	sources="$(meshlab_sources 2025.07)"
	quietly cmake -S "$ROOT" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
		-DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O2 -gline-tables-only' -DCMAKE_UNITY_BUILD=ON \
		-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DMCFSKEL_PLUGIN=OFF -DMCFSKEL_TESTS=ON \
		-DMCFSKEL_SANITIZE="$kind" -DMESHLAB_SRC="$sources" || die "could not configure for $kind"
	say "building for the $kind sanitizer: $*"
	quietly ninja -C "$folder" -j "$JOBS" "$@" || die "could not build for $kind"
}

# under KIND COMMAND...: runs a command as its sanitizer needs it.
under() {
	local kind="$1"
	shift
	if [ "$kind" = thread ]; then
		# What is not compiled with the sanitizer, OpenMP's own library, would be taken for racing.
		env OMP_NUM_THREADS="$THREADS" OMP_TOOL_LIBRARIES="$ARCHER" \
			TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1 exitcode=66" "$@"
	else
		env OMP_NUM_THREADS=2 ASAN_OPTIONS="detect_stack_use_after_return=1" \
			LSAN_OPTIONS="suppressions='$ROOT/scripts/lib/leaks.supp':print_suppressions=0" \
			UBSAN_OPTIONS="print_stacktrace=1" "$@"
	fi
}

# run KIND NAME COMMAND...: runs a command, keeps its output, says how it went.
failed=0
run() {
	local kind="$1" name="$2" log="$ROOT/build/sanitize-$1/$2.log"
	shift 2
	# GoogleTest passes where its filter names no test.
	if under "$kind" "$@" >"$log" 2>&1 && ! grep -q 'Running 0 tests' "$log"; then
		echo "$kind $name: passed"
	else
		echo "$kind $name: FAILED, see $log"
		grep -m 5 -E 'ERROR: |WARNING: |runtime error|WRONG|FAILED|Running 0 tests' "$log" | sed 's/^/    /' || true
		failed=1
	fi
}

need_packages "${SANITIZE_PACKAGES[@]}"
meshes=()
for folder in "$ROOT/meshes" "$ROOT/../shared/meshes"; do
	for file in "$folder"/*.off "$folder"/*.obj; do
		# shellcheck disable=SC2053
		if [ -f "$file" ] && [[ "$(basename "$file")" == $pattern ]]; then
			meshes+=("$file")
		fi
	done
done
# shellcheck disable=SC2053
[ "$what" = tests ] || [ "${#meshes[@]}" -gt 0 ] || [[ many_bodies == $pattern ]] ||
	die "no mesh has a name that matches '$pattern'"

for kind in "${kinds[@]}"; do
	[ "$kind" != thread ] || [ -f "$ARCHER" ] || die "no $ARCHER: the thread sanitizer needs it"
	if [ "$what" != tests ]; then
		locked "$ROOT/build/sanitize-$kind" build "$kind" sanitize_jobs
		program="$ROOT/build/sanitize-$kind/tests/sanitize_jobs"
		# shellcheck disable=SC2053
		if [[ many_bodies == $pattern ]]; then
			run "$kind" many_bodies "$program" --jobs "$jobs" --many "$BODIES"
		fi
		for mesh in "${meshes[@]}"; do
			run "$kind" "$(basename "$mesh")" "$program" --jobs "$jobs" "$mesh"
		done
	fi
	if [ "$what" != jobs ]; then
		locked "$ROOT/build/sanitize-$kind" build "$kind" unit_tests
		# A sanitizer allocates memory itself: a test that refuses all of it cannot run.
		run "$kind" unit_tests "$ROOT/build/sanitize-$kind/tests/unit_tests" \
			--gtest_filter="$filter:-ForEachBlock.DoesWithOneThreadWhereTheSystemRefusesMore"
	fi
done
exit "$failed"
