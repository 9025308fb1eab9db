# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Building for one host. Source after common.sh and meshlab_sources.sh.

# shellcheck shell=bash

HOSTS=(pymeshlab meshlab-2025.07 meshlab-2020.09 pymeshlab-2023.12 pymeshlab-2022.2)
BUILD_PACKAGES=(g++ cmake ninja-build qtbase5-dev libqt5opengl5-dev libglew-dev libeigen3-dev
	libqhull-dev)

# headers_of HOST: the MeshLab release with whose headers the plugin for a host is built.
headers_of() {
	case "$1" in
	# Debian never had 2023.12; for a plugin its interface is that of 2025.07.
	pymeshlab | pymeshlab-2023.12) echo 2025.07 ;;
	pymeshlab-2022.2) echo 2022.02 ;;
	meshlab-*) echo "${1#meshlab-}" ;;
	esac
}

# build_host HOST [CMAKE_OPTION...]: configures and builds; prints the path of the plugin.
build_host() {
	local host="$1" folder="$ROOT/build/$1" sources
	shift
	need_packages "${BUILD_PACKAGES[@]}" >&2
	sources="$(meshlab_sources "$(headers_of "$host")")"
	quietly cmake -S "$ROOT" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DMESHLAB_HOST="$host" -DMESHLAB_SRC="$sources" "$@" || die "could not configure for $host"
	if ! ninja -C "$folder" -n | grep -q 'no work to do'; then
		say "building for $host"
		quietly ninja -C "$folder" -j "$JOBS" || die "could not build for $host"
	fi
	echo "$folder/filter_mcfskel/libfilter_mcfskel.so"
}
