#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sets up what is missing, then makes the tables and figures of the paper again: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/bench.sh
. "$ROOT/scripts/lib/bench.sh"

check_options reproduce_options.py "$@"
python="$(bench_python)"
programs="$(build_bench mcfskel_cli)"
exec "$python" "$ROOT/scripts/reproduce.py" --program "$programs/mcfskel_cli" "$@"
