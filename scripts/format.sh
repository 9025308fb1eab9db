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

need_packages clang-format-14 git
cd "$ROOT"
# Not of <(...), whose failure would go unseen.
listed="$(git ls-files '*.h' '*.cpp')" || die "the sources are listed by git, which fails here; see above"
mapfile -t sources <<<"${listed:?no sources}"
if [ "${1:-}" = --check ]; then
	said="$(clang-format-14 --dry-run "${sources[@]}" 2>&1)" || die "clang-format: $said"
	complaints="$(sed -n 's/:.*clang-format-violations.*//p' <<<"$said" | sort -u)"
	[ -z "$complaints" ] || die "not formatted; run scripts/format.sh:"$'\n'"$complaints"
	exit 0
fi
clang-format-14 -i "${sources[@]}"
