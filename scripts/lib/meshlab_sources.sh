# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The MeshLab source tree of a release: the only place where the headers of its plugin interface
# and of VCG are. Source after common.sh.

# shellcheck shell=bash

MESHLAB_GIT="${MESHLAB_GIT:-https://github.com/cnr-isti-vclab/meshlab.git}"

# meshlab_sources RELEASE: prints the folder of the source tree, fetching it if need be. MESHLAB_SRC,
# a folder named by the user, comes first; then a clone of the release; then Debian's source package.
meshlab_sources() {
	local release="$1" folder="$CACHE/meshlab-$1"
	if [ -n "${MESHLAB_SRC:-}" ]; then
		is_meshlab_tree "$MESHLAB_SRC" || die "MESHLAB_SRC=$MESHLAB_SRC is no MeshLab source tree"
		realpath -s -- "$MESHLAB_SRC"
		return
	fi
	with_lock "meshlab-$release" fetch_meshlab "$release" "$folder" >&2
	echo "$folder"
}

is_meshlab_tree() {
	[ -f "$1/src/common/mlexception.h" ] &&
		{ [ -f "$1/src/vcglib/vcg/complex/complex.h" ] || [ -f "$1/vcglib/vcg/complex/complex.h" ]; }
}

fetch_meshlab() {
	local release="$1" folder="$2" temporary
	! is_meshlab_tree "$folder" || return 0
	mkdir -p "$CACHE"
	temporary="$(mktemp -d "$CACHE/fetch.XXXXXX")"
	# shellcheck disable=SC2064
	trap "rm -rf $(printf %q "$temporary")" EXIT
	if ! clone_meshlab "$release" "$temporary/tree"; then
		say "MeshLab $release: no clone could be made; taking Debian's source package"
		rm -rf "$temporary/tree"
		debian_meshlab "$release" "$temporary"
	fi
	is_meshlab_tree "$temporary/tree" ||
		die "no source tree of MeshLab $release could be had; set MESHLAB_SRC to one"
	publish "$temporary/tree" "$folder"
}

clone_meshlab() {
	local release="$1" tree="$2" tag vcglib=src/vcglib
	command -v git >/dev/null || return 1
	tag="$(GIT_TERMINAL_PROMPT=0 timeout 15 git ls-remote --tags "$MESHLAB_GIT" 2>/dev/null |
		sed -n "s:.*refs/tags/\([Mm]esh[Ll]ab-$release\)\$:\1:p" | head -n 1)"
	[ -n "$tag" ] || return 1
	say "cloning MeshLab $release"
	quietly timeout 900 git clone -q --depth 1 --branch "$tag" "$MESHLAB_GIT" "$tree" || return 1
	grep -q 'path = src/vcglib' "$tree/.gitmodules" || vcglib=vcglib
	quietly timeout 900 git -C "$tree" submodule update -q --init --depth 1 "$vcglib"
}

# Debian's source package, through an apt configuration of our own, so that the machine's is left
# alone. The archive of upstream's source is all we need, and it may be there even where Debian's own
# part of the package is not: apt then fails, but leaves it.
debian_meshlab() {
	local release="$1" work="$2" suite mirror version tarball
	case "$release" in
	2020.09) suite=bookworm ;;
	2022.02) suite=trixie ;;
	*) suite=sid ;;
	esac
	need_packages xz-utils debian-archive-keyring
	mirror="$(debian_mirror)"
	[ -n "$mirror" ] || die "this machine's apt names no Debian mirror; set MESHLAB_SRC to a source tree"
	mkdir -p "$work/apt/lists/partial" "$work/apt/cache/archives/partial"
	echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" \
		>"$work/apt/sources.list"
	local options=(
		-o "Dir::Etc::SourceList=$work/apt/sources.list" -o Dir::Etc::SourceParts=-
		-o "Dir::State::Lists=$work/apt/lists" -o "Dir::Cache=$work/apt/cache"
		-o "APT::Sandbox::User=$(id -un)"
		# A mirror frozen at some date is as good: the version is fixed, and signatures are checked.
		-o Acquire::Check-Valid-Until=false)
	say "downloading the source of MeshLab $release from Debian $suite"
	quietly apt-get "${options[@]}" -q update || return 1
	version="$(apt-cache "${options[@]}" showsrc meshlab 2>/dev/null |
		sed -n "s/^Version: \($release[^0-9].*\)\$/\1/p" | head -n 1)"
	[ -n "$version" ] || die "Debian $suite has no source package of MeshLab $release"
	(cd "$work" && apt-get "${options[@]}" -q source --download-only "meshlab=$version") \
		>"$work/apt/log" 2>&1 || true
	tarball="$(find "$work" -maxdepth 1 -name 'meshlab_*.orig.tar.*' ! -name '*.asc' | head -n 1)"
	if [ -z "$tarball" ]; then
		cat "$work/apt/log" >&2
		return 1
	fi
	mkdir "$work/tree"
	tar -xf "$tarball" -C "$work/tree" --strip-components=1
}

# The mirror of Debian's main archive that the machine's own apt is set to. apt can tell only once it
# has package lists.
debian_mirror() {
	local mirror
	mirror="$(listed_mirror)"
	if [ -z "$mirror" ]; then
		quietly as_root apt-get -o DPkg::Lock::Timeout=300 -q update
		mirror="$(listed_mirror)"
	fi
	echo "$mirror"
}

listed_mirror() {
	# shellcheck disable=SC2016
	apt-get indextargets --format '$(REPO_URI) $(ORIGIN) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
		awk '$2 == "Debian" && $3 !~ /-/ && $4 == "main" { print $1; exit }'
}
