# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# What every command of this folder needs: where things are, how to say something, how to get
# missing Debian packages. Source it; it runs nothing by itself.

# shellcheck shell=bash

# A failure inside $(...) is a failure.
shopt -s inherit_errexit

# A user's CDPATH would have cd say where it went, into every path that is found by it.
unset CDPATH
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
# Downloads are shared by all checkouts, so they live outside of them.
# Absolute, since some commands work in other folders.
CACHE="$(realpath -ms -- "${MCFSKEL_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/mcfskel}")"
JOBS="${MCFSKEL_JOBS:-$(nproc)}"
export ROOT CACHE JOBS

# Progress goes to stderr: stdout is for results that other commands read.
say() {
	printf '== %s\n' "$*" >&2
}

die() {
	printf 'error: %s\n' "$*" >&2
	exit 1
}

# Runs a command quietly; its output is shown only if it fails. In a shell of its own, so that a function
# that dies is heard.
quietly() {
	local output
	output="$(mktemp)"
	if ! ("$@") >"$output" 2>&1; then
		cat "$output" >&2
		rm -f "$output"
		return 1
	fi
	rm -f "$output"
}

as_root() {
	if [ "$(id -u)" -eq 0 ]; then
		"$@"
	elif command -v sudo >/dev/null; then
		sudo "$@"
	else
		die "needs root or sudo to run: $*"
	fi
}

# need_packages NAME...: installs the Debian packages that are not there yet.
need_packages() {
	command -v dpkg-query >/dev/null ||
		die "this system has no dpkg; install the equivalents of these Debian packages: $*"
	local name native states missing=()
	native="$(dpkg --print-architecture)"
	for name in "$@"; do
		# One line for each architecture that it is there for.
		states="$(dpkg-query -W -f='${Architecture} ${db:Status-Status}\n' "$name" 2>/dev/null || true)"
		grep -qxE "($native|all) installed" <<<"$states" || missing+=("$name")
	done
	[ "${#missing[@]}" -gt 0 ] || return 0
	[ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null ||
		die "Debian packages are missing, and it takes root or sudo to install them: ${missing[*]}"
	say "installing ${missing[*]}"
	local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -qq)
	# A machine's package lists may be absent or old: refresh them only when they do not serve.
	quietly as_root "${apt[@]}" install -y --no-install-recommends "${missing[@]}" 2>/dev/null && return 0
	quietly as_root "${apt[@]}" update
	quietly as_root "${apt[@]}" install -y --no-install-recommends "${missing[@]}" ||
		die "could not install ${missing[*]}"
}

# publish TEMPORARY FINAL: moves a finished result to its place in one step, so that an interrupted
# run leaves nothing that looks finished.
publish() {
	mkdir -p "$(dirname "$2")"
	rm -rf "$2"
	mv "$1" "$2"
}

# with_lock NAME COMMAND...: keeps two runs from preparing the same thing in the cache at once.
with_lock() {
	locked "$CACHE/$1" "${@:2}"
}

# locked PATH COMMAND...: runs a command that writes PATH while no other run does.
locked() {
	local path="$1"
	shift
	mkdir -p "$(dirname "$path")"
	(
		flock -w 20 9 || {
			say "waiting for another run to finish with $path"
			flock 9
		}
		"$@"
	) 9>"$path.lock"
}
