#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the Python package as a wheel that pip installs anywhere pymeshlab does, and as a source
# distribution. The last line of the output is the path of the wheel.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/meshlab_sources.sh
. "$ROOT/scripts/lib/meshlab_sources.sh"
# shellcheck source=lib/build.sh
. "$ROOT/scripts/lib/build.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"

usage() {
	cat <<END
usage: scripts/wheel.sh [FOLDER]

Builds the plugin for pymeshlab, and from it and python/ into FOLDER (default: out/wheels):
  mcfskel-VERSION-py3-none-manylinux_2_35_x86_64.whl  needs no compiler; the same for every Python
  mcfskel-VERSION.tar.gz                              the sources; pip builds the plugin from them

environment:
  MCFSKEL_PLUGIN  a built plugin to take instead
  MESHLAB_SRC, MCFSKEL_CACHE, MCFSKEL_JOBS  as in scripts/build.sh
END
}

case "${1:-}" in
-h | --help)
	usage
	exit 0
	;;
-*)
	usage >&2
	exit 2
	;;
esac
[ "$#" -le 1 ] || {
	usage >&2
	exit 2
}

# That of pymeshlab's own wheel: whoever has pymeshlab has a system that is new enough.
platform=manylinux_2_35_x86_64
# pymeshlab carries these and has loaded them before it loads the plugin; a second copy of MeshLab's
# library would have documents of its own.
carried=(libmeshlab-common.so 'libQt5*' libgomp.so.1)

mkdir -p "${1:-$ROOT/out/wheels}"
folder="$(cd "${1:-$ROOT/out/wheels}" && pwd)"
plugin="${MCFSKEL_PLUGIN:-$(build_host pymeshlab)}"
[ -f "$plugin" ] || die "there is no plugin '$plugin'; see MCFSKEL_PLUGIN"
plugin="$(realpath -s -- "$plugin")" # setup.py works in a folder of its own
python="$(python_env requirements-wheel.txt)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

say "building the wheel and the source distribution"
# Of a copy: setuptools leaves its traces in the folder that it builds, and reuses what is there.
mkdir "$work/tree"
(cd "$ROOT" && cp -RL CMakeLists.txt LICENSE README.md cmake filter_mcfskel vcg_ext python "$work/tree/")
mkdir "$work/tree/scripts"
cp -R "$ROOT/scripts/build.sh" "$ROOT/scripts/lib" "$work/tree/scripts/"
rm -rf "$work/tree/python/build" "$work/tree/python/"*.egg-info
export MCFSKEL_PLUGIN="$plugin"
quietly "$python" -m build --outdir "$work/plain" --sdist --wheel "$work/tree/python" ||
	die "could not build the package"
options=()
for library in "${carried[@]}"; do
	options+=(--exclude "$library")
done
PATH="$(dirname "$python"):$PATH" quietly "$python" -m auditwheel repair --plat "$platform" \
	"${options[@]}" --wheel-dir "$work/wheels" "$work"/plain/*.whl || die "could not repair the wheel"
mv "$work"/plain/*.tar.gz "$folder/"
wheel="$(basename "$work"/wheels/*.whl)"
mv "$work/wheels/$wheel" "$folder/"
echo "$folder/$wheel"
