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

check_options bench/benchmark_options.py "$@"
python="$(bench_python)"
more=()
# VMTK needs a newer Python; without one the table is without VMTK.
if vmtk="$(python_env_if_possible requirements-vmtk.txt "$(newer_python)")"; then
	more=(--vmtk-python "$vmtk")
fi
programs="$(build_bench)"
exec "$python" "$ROOT/scripts/bench/benchmark.py" --bench-programs "$programs" "${more[@]}" "$@"
