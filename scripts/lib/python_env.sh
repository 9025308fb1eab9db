# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Python environments, in the cache. Source after common.sh.

# shellcheck shell=bash

# Modules that a user has for another Python would be taken before an environment's own.
unset PYTHONPATH PYTHONHOME

# The shared libraries that the pymeshlab wheel expects from the system: OpenGL's loaders for the
# module itself, and fonts and X for its Qt. They are needed on machines without a display as well.
PYMESHLAB_PACKAGES=(libgl1 libopengl0 libegl1 libglib2.0-0 libfontconfig1 libfreetype6
	libx11-6 libxcb1 zlib1g)

# python_env [FILE [PYTHON]]: prints the path of the interpreter of an environment with the requirements in
# that file of scripts/ (default: requirements.txt), making the environment if need be, with PYTHON (default:
# the system's).
python_env() {
	need_packages python3 python3-venv "${PYMESHLAB_PACKAGES[@]}" >&2
	local requirements="$ROOT/scripts/${1:-requirements.txt}" wanted folder
	# A changed list of requirements is a new environment; the old one may still serve another checkout.
	wanted="$(sha256sum "$requirements" | cut -c 1-12)"
	folder="$CACHE/python-$wanted"
	with_lock "python-$wanted" make_python_env "$folder" "$requirements" "${2:-/usr/bin/python3}" >&2
	echo "$folder/bin/python"
}

# python_env_if_possible FILE [PYTHON]: python_env() for the condition of an if, where errors in a function would go
# unseen: a program of its own.
python_env_if_possible() {
	bash -euo pipefail -c '. "$1/common.sh"; . "$1/python_env.sh"; python_env "${@:2}"' - "$ROOT/scripts/lib" "$@"
}

make_python_env() {
	local folder="$1" requirements="$2" python="$3"
	[ ! -f "$folder/complete" ] || return 0
	say "preparing Python with $(basename "$requirements")"
	rm -rf "$folder"
	# A venv knows its own path, so it cannot be made elsewhere and moved: the mark comes last instead.
	"$python" -m venv "$folder" || die "no environment by $python"
	quietly "$folder/bin/python" -m pip install --disable-pip-version-check \
		-r "$requirements" || die "could not install $requirements"
	touch "$folder/complete"
}

# newer_python: a Python of 3.12 or newer, if there is one; VMTK needs it.
newer_python() {
	local python
	for python in python3.12 python3.13 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.1[23]*/bin/python3; do
		if "$python" --version >/dev/null 2>&1; then
			echo "$python"
			return
		fi
	done
	echo python3.12 # which says that there is none
}
