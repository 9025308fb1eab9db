#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Puts the plugin where a host looks for plugins, or takes it away. The last line of the output is
# the path of the plugin there.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"

usage() {
	cat <<END
usage: scripts/install.sh HOST [--uninstall] [--python PROGRAM] [--prefix FOLDER]

Builds the plugin for HOST (${HOSTS[*]})
and puts it where HOST looks for plugins:
  meshlab-2025.07  the user's folder of plugins, under \${XDG_DATA_HOME:-~/.local/share}/VCG
  meshlab-2020.09  lib/.../meshlab/plugins of the installed MeshLab: this release has no folder for a
                   user's plugins
  pymeshlab...     lib/plugins of the package pymeshlab: 'import pymeshlab' then has the filters

options:
  --uninstall       take the plugin away again
  --python PROGRAM  the Python that has pymeshlab (default: python3)
  --prefix FOLDER   where MeshLab 2020.09 is installed (default: /usr)
END
}

wrong() {
	usage >&2
	exit 2
}

host="" uninstall=no python=python3 prefix=/usr
while [ $# -gt 0 ]; do
	case "$1" in
	-h | --help)
		usage
		exit 0
		;;
	--uninstall) uninstall=yes ;;
	--python | --prefix)
		[ $# -gt 1 ] || wrong
		declare "${1#--}=$2"
		shift
		;;
	-*) wrong ;;
	*)
		[ -z "$host" ] || wrong
		host="$1"
		;;
	esac
	shift
done
[ -n "$host" ] || wrong
[[ " ${HOSTS[*]} " == *" $host "* ]] || wrong

# The folder in which the host looks for plugins.
plugin_folder() {
	case "$host" in
	meshlab-2020.09)
		local found
		found="$(find "$prefix/lib" -maxdepth 3 -path '*/meshlab/plugins' -type d 2>/dev/null | head -n 1 || true)"
		[ -n "$found" ] || die "there is no MeshLab 2020.09 under $prefix; on Debian 12: apt-get install meshlab"
		echo "$found"
		;;
	# The scalar is part of the name: fp for single precision.
	meshlab-*) echo "${XDG_DATA_HOME:-$HOME/.local/share}/VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/${host#meshlab-}" ;;
	pymeshlab*) pymeshlab_folder ;;
	esac
}

# pymeshlab itself is not imported: with a broken plugin in its folder it could not be.
pymeshlab_folder() {
	local wanted folder version
	wanted="${host#pymeshlab}"
	wanted="${wanted#-}"
	{ read -r version && read -r folder; } < <("$python" -c 'if True:
		import importlib.metadata, importlib.util
		print(importlib.metadata.version("pymeshlab"))
		print(importlib.util.find_spec("pymeshlab").submodule_search_locations[0])' 2>/dev/null) ||
		die "'$python' has no pymeshlab: pip install pymeshlab, or name another with --python"
	# A release's first wheel has no .postN.
	[[ "$version." == "${wanted:-2025.7}".* ]] ||
		die "'$python' has pymeshlab $version, which $host is not"
	echo "$folder/lib/plugins"
}

# Runs a command that changes a folder, as root if it takes that.
in_folder() {
	local folder="$1"
	shift
	if [ -w "$folder" ]; then "$@"; else as_root "$@"; fi
}

folder="$(plugin_folder)"
target="$folder/libfilter_mcfskel.so"
if [ "$uninstall" = yes ]; then
	if [ -e "$target" ]; then
		in_folder "$folder" rm "$target"
		say "removed from $host:"
	else
		say "was not installed in $host:"
	fi
else
	plugin="$(build_host "$host")"
	mkdir -p "$folder" 2>/dev/null || as_root mkdir -p "$folder"
	# In one step: a program that runs keeps the file that it has loaded.
	in_folder "$folder" cp "$plugin" "$target.new"
	in_folder "$folder" mv "$target.new" "$target"
	say "installed for $host; restart it if it is running:"
fi
echo "$target"
