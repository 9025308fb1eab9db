#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then scores programs on surfaces whose skeletons are known: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/bench.sh
. "$ROOT/scripts/lib/bench.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"

for argument in "$@"; do
	case "$argument" in
	-h | --help)
		need_packages python3
		exec /usr/bin/python3 "$ROOT/scripts/bench/benchmark_options.py" --help
		;;
	esac
done
need_packages "${BENCH_PACKAGES[@]}"
# Mistakes are told before anything is built.
/usr/bin/python3 "$ROOT/scripts/bench/benchmark_options.py" "$@"
python="$(bench_python)"
more=()
# VMTK needs a newer Python; without one the table is without VMTK. A program of its own: in the condition of an if,
# errors in a function would go unseen.
if vmtk="$(bash -euo pipefail -c '. "$1/common.sh"; . "$1/python_env.sh"
	python_env requirements-vmtk.txt "$(newer_python)"' - "$ROOT/scripts/lib")"; then
	more=(--vmtk-python "$vmtk")
fi
programs="$(build_bench)"
exec "$python" "$ROOT/scripts/bench/benchmark.py" --bench-programs "$programs" "${more[@]}" "$@"
