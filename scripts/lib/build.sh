# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Building for one host. Source after common.sh and meshlab_sources.sh.

# shellcheck shell=bash

HOSTS=(pymeshlab meshlab-2025.07 meshlab-2020.09 pymeshlab-2023.12 pymeshlab-2022.2)
BUILD_PACKAGES=(g++ cmake ninja-build qtbase5-dev libqt5opengl5-dev libglew-dev libeigen3-dev
	libqhull-dev)

# need_one_host ARGUMENT...: ends with the script's usage() unless the one argument is a host.
need_one_host() {
	case "${1:-}" in
	-h | --help)
		usage
		exit 0
		;;
	esac
	if [ $# -ne 1 ] || [[ " ${HOSTS[*]} " != *" $1 "* ]]; then
		usage >&2
		exit 2
	fi
}

# headers_of HOST: the MeshLab release with whose headers the plugin for a host is built.
headers_of() {
	case "$1" in
	pymeshlab | pymeshlab-2023.12) echo 2025.07 ;;
	pymeshlab-2022.2) echo 2022.02 ;;
	meshlab-*) echo "${1#meshlab-}" ;;
	esac
}

# build_host HOST [CMAKE_OPTION...]: configures and builds, with options all that they add, too; prints the
# path of the plugin.
build_host() {
	local host="$1" built_as="$1" target=filter_mcfskel plugin=filter_mcfskel folder sources
	shift
	# CMake remembers options: without any, an earlier run's tests are not built once more.
	[ $# -eq 0 ] || target=all
	# The same interface as that of today's pymeshlab, so most of the plugin is the same.
	if [ "$host" = pymeshlab-2023.12 ]; then
		built_as=pymeshlab target=filter_mcfskel_2023.12 plugin=filter_mcfskel/2023.12
	fi
	folder="$ROOT/build/$built_as"
	need_packages "${BUILD_PACKAGES[@]}" >&2
	sources="$(meshlab_sources "$(headers_of "$built_as")")"
	locked "$folder" build_in "$folder" "$host" "$target" -DMESHLAB_HOST="$built_as" \
		-DMESHLAB_SRC="$sources" "$@" >&2
	echo "$folder/$plugin/libfilter_mcfskel.so"
}

# build_in FOLDER HOST TARGET CMAKE_OPTION...: a unity build, since most of the time of compiling goes into
# templates that several files instantiate.
build_in() {
	local folder="$1" host="$2" target="$3"
	shift 3
	quietly cmake -S "$ROOT" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON "$@" ||
		die "could not configure for $host"
	if ! ninja -C "$folder" -n "$target" | grep -q 'no work to do'; then
		say "building for $host"
		quietly ninja -C "$folder" -j "$JOBS" "$target" || die "could not build for $host"
	fi
}
