#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The plugin as patches against MeshLab's own tree; see docs/upstream.md.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"

RELEASE=2025.07
UPSTREAM_PACKAGES=(clang-format git libglu1-mesa-dev python3)

usage() {
	cat <<END
usage: scripts/upstream.sh [FOLDER]
       scripts/upstream.sh --build WHICH PRECISION

Writes two patches against MeshLab $RELEASE into FOLDER (default: out/upstream), in the form of git diff:
  filter_mcfskel.patch        the whole plugin
  filter_mcfskel_first.patch  the first one to offer: resample, poles, step, collapse, full

--build applies one to a copy of MeshLab's source in build/upstream and builds it there, with what it needs of
MeshLab: WHICH is whole or first, PRECISION single (as in MeshLab) or double (as in pymeshlab). The last line of the
output is the path of the plugin. The first time takes a quarter of an hour.

environment: as for scripts/build.sh
END
}

# make_patch SOURCES whole|first FILE
make_patch() {
	local options=()
	[ "$2" != first ] || options=(--first)
	mkdir -p "$(dirname "$3")"
	python3 "$ROOT/scripts/upstream/make_patch.py" --meshlab "$1" "${options[@]}" >"$3.part" ||
		die "could not make the patch"
	mv "$3.part" "$3"
}

# build_patch SOURCES whole|first single|double
build_patch() {
	local sources="$1" which="$2" folder="$ROOT/build/upstream" double=OFF tree binaries
	[ "$3" != double ] || double=ON
	tree="$folder/$which" binaries="$folder/$which-$3"
	need_packages "${BUILD_PACKAGES[@]}" >&2
	make_patch "$sources" "$which" "$folder/$which.patch"
	# The patched tree is made anew only where the patch has changed, so that a second run builds nothing.
	if ! cmp -s "$folder/$which.patch" "$tree/.applied"; then
		rm -rf "$tree"
		cp -r "$sources" "$tree"
		(cd "$tree" && GIT_CEILING_DIRECTORIES="$folder" git apply "$folder/$which.patch") ||
			die "the patch does not apply"
		cp "$folder/$which.patch" "$tree/.applied"
	fi
	say "building MeshLab's library and the plugin, $3 precision"
	quietly cmake -S "$tree" -B "$binaries" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DMESHLAB_PLUGINS=meshlabplugins/filter_mcfskel -DMESHLAB_BUILD_ONLY_LIBRARIES=ON \
		-DMESHLAB_ALLOW_DOWNLOAD_SOURCE_LIB3MF=OFF \
		-DMESHLAB_BUILD_WITH_DOUBLE_SCALAR=$double || die "could not configure MeshLab"
	quietly ninja -C "$binaries" -j "$JOBS" filter_mcfskel || die "could not build the plugin in MeshLab"
	echo "$binaries/src/distrib/plugins/libfilter_mcfskel.so"
}

build=
case "${1:-}" in
-h | --help)
	usage
	exit 0
	;;
--build)
	if [ $# -ne 3 ] || [[ " whole first " != *" $2 "* ]] || [[ " single double " != *" $3 "* ]]; then
		usage >&2
		exit 2
	fi
	build=1
	;;
*)
	if [ $# -gt 1 ] || [[ "${1:-}" == -* ]]; then
		usage >&2
		exit 2
	fi
	;;
esac
need_packages "${UPSTREAM_PACKAGES[@]}" >&2
sources="$(meshlab_sources "$RELEASE")"
if [ -n "$build" ]; then
	locked "$ROOT/build/upstream" build_patch "$sources" "$2" "$3"
	exit
fi
folder="${1:-$ROOT/out/upstream}"
make_patch "$sources" whole "$folder/filter_mcfskel.patch"
make_patch "$sources" first "$folder/filter_mcfskel_first.patch"
printf '%s\n' "$folder/filter_mcfskel.patch" "$folder/filter_mcfskel_first.patch"
