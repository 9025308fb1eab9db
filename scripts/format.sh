#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Formats the C++ sources: see --help.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

case "${1:-}" in
'' | --check) ;;
-h | --help)
	cat <<END
usage: scripts/format.sh [--check]

Formats the C++ sources; with --check, only says which ones are not, and fails.
END
	exit 0
	;;
*) die "unknown option '$1'; see --help" ;;
esac

need_packages clang-format-14
cd "$ROOT"
mapfile -t sources < <(git ls-files '*.h' '*.cpp')
if [ "${1:-}" = --check ]; then
	complaints="$(clang-format-14 --dry-run "${sources[@]}" 2>&1 | sed -n 's/:.*clang-format-violations.*//p' | sort -u)"
	[ -z "$complaints" ] || die "not formatted; run scripts/format.sh:"$'\n'"$complaints"
	exit 0
fi
clang-format-14 -i "${sources[@]}"
