#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Runs clang-tidy with the checks of .clang-tidy over all headers of the library; any finding is an error.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"

case "${1:-}" in
'') ;;
-h | --help)
	cat <<END
usage: scripts/lint.sh

Runs clang-tidy with the checks of .clang-tidy over all headers of the library; any finding is an error.
Installs it if need be.
END
	exit 0
	;;
*) die "unknown option '$1'; see --help" ;;
esac

need_packages clang-tidy-14 git libeigen3-dev libqhull-dev
tree="$(meshlab_sources 2025.07)"
vcg="$tree/src/vcglib"
[ -d "$vcg" ] || vcg="$tree/vcglib"
cd "$ROOT"
source="$(mktemp --suffix=.cpp)"
trap 'rm -f "$source"' EXIT
git ls-files 'vcg_ext/skeleton/*.h' | sed 's:^vcg_ext/\(.*\)$:#include <\1>:' >"$source"
say "clang-tidy: $(wc -l <"$source") headers"
findings="$(clang-tidy-14 --quiet --config-file=.clang-tidy "$source" -- -std=c++17 -DMCFSKEL_HAS_QHULL=1 -Ivcg_ext \
	-isystem /usr/include/eigen3 -isystem "$vcg" 2>/dev/null)" || die "clang-tidy:"$'\n'"$findings"
