# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The programs that load the plugin, for the tests. Source after common.sh, meshlab_sources.sh,
# build.sh and python_env.sh.

# shellcheck shell=bash

# What it takes to show a MeshLab window where there is no display, to work in it, and to read it.
DISPLAY_PACKAGES=(xvfb xauth libgl1-mesa-dri xdotool imagemagick dbus at-spi2-core python3-gi
	gir1.2-atspi-2.0)
MESHLAB_BUILD_PACKAGES=(libglu1-mesa-dev)
# Of MeshLab's own plugins those that its window cannot do without.
MESHLAB_PLUGINS=(io_base decorate_base filter_layer)
# Everything the plugin can be tested in, besides the pymeshlab that the commands use.
TEST_HOSTS=(meshlab-2020.09 meshlab-2025.07 pymeshlab-2023.12 pymeshlab-2022.2)

# host_folder HOST: gets the host and prints the folder that has its programs under bin/.
host_folder() {
	local python
	case "$1" in
	pymeshlab*)
		# By itself: as an argument of dirname its failure would go unseen.
		if [ "$1" = pymeshlab ]; then python="$(python_env)"; else python="$(python_env "requirements-$1.txt")"; fi
		echo "${python%/bin/python}"
		;;
	meshlab-2020.09) packaged_meshlab "$ROOT/build/$1/host" ;;
	meshlab-2025.07) built_meshlab 2025.07 ;;
	*) die "unknown host '$1'" ;;
	esac
}

# with_plugin HOST FOLDER PLUGIN: puts the plugin into a host that host_folder got, without a trace in
# what the user has installed; prints a folder: programs are under bin/, and data/ is what
# XDG_DATA_HOME has to be.
with_plugin() {
	local host="$1" folder="$2" plugin="$3" place
	if [[ "$host" == pymeshlab* ]]; then
		# Loads what it is told to.
		echo "$folder"
		return
	fi
	if [ "$host" = meshlab-2020.09 ]; then
		# This release has no folder for a user's plugins.
		place="$(find "$folder/lib" -path '*/meshlab/plugins' -type d | head -n 1)"
	else
		mkdir -p "$ROOT/build/$host/host"
		ln -sfn "$folder/bin" "$ROOT/build/$host/host/bin"
		folder="$ROOT/build/$host/host"
		place="$folder/data/VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/${host#meshlab-}"
	fi
	mkdir -p "$place"
	ln -sf "$plugin" "$place/libfilter_mcfskel.so"
	echo "$folder"
}

# packaged_meshlab FOLDER: Debian's MeshLab and meshlabserver 2020.09 in a folder of their own, into
# which a plugin can be put without touching the installed ones.
packaged_meshlab() {
	local folder="$1" version place temporary
	need_packages "${DISPLAY_PACKAGES[@]}" meshlab >&2
	version="$(dpkg-query -W -f='${Version}' meshlab)"
	[[ "$version" == 2020.09* ]] || die "this system's package meshlab is $version, not 2020.09"
	if [ ! -x "$folder/bin/meshlabserver" ]; then
		place="$(dpkg -L meshlab | sed -n 's:^/usr/\(lib/.*\)/libmeshlab-common.so$:\1:p')"
		mkdir -p "$(dirname "$folder")"
		temporary="$(mktemp -d "$folder.XXXXXX")"
		mkdir -p "$temporary/bin" "$temporary/$place/plugins"
		# Copies: where a program is tells it where its plugins are.
		cp /usr/bin/meshlab /usr/bin/meshlabserver "$temporary/bin/"
		ln -s "/usr/$place"/*.so "$temporary/$place/"
		ln -s "/usr/$place"/plugins/*.so "$temporary/$place/plugins/"
		publish "$temporary" "$folder"
	fi
	echo "$folder"
}

# built_meshlab RELEASE: MeshLab built from its source, in the cache.
built_meshlab() {
	local release="$1" folder="$CACHE/meshlab-$1-built" sources
	need_packages "${BUILD_PACKAGES[@]}" "${DISPLAY_PACKAGES[@]}" "${MESHLAB_BUILD_PACKAGES[@]}" >&2
	sources="$(meshlab_sources "$release")"
	with_lock "meshlab-$release-built" build_meshlab "$release" "$sources" "$folder" >&2
	echo "$folder"
}

build_meshlab() {
	local release="$1" sources="$2" folder="$3" plugins
	[ ! -f "$folder/complete" ] || return 0
	say "building MeshLab $release, once for all checkouts: some minutes"
	plugins="$(printf ';meshlabplugins/%s' "${MESHLAB_PLUGINS[@]}")"
	rm -rf "$folder"
	# Its programs name the folder that they were built in, so it cannot be moved: the mark comes last.
	quietly cmake -S "$sources" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DMESHLAB_ALLOW_OPTIONAL_EXTERNAL_LIBRARIES=OFF "-DMESHLAB_PLUGINS=${plugins#;}" ||
		die "could not configure MeshLab $release"
	quietly ninja -C "$folder" -j "$JOBS" || die "could not build MeshLab $release"
	ln -s "$(dirname "$(find "$folder" -name meshlab -type f -perm -u+x | head -n 1)")" "$folder/bin"
	find "$folder" -name '*.o' -delete
	touch "$folder/complete"
}
