#!/usr/bin/env bash
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The pages and the references of C++ and Python as a site in out/site; any warning is an error.

set -euo pipefail
# shellcheck source=lib/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
# shellcheck source=lib/python_env.sh
. "$ROOT/scripts/lib/python_env.sh"

case "${1:-}" in
'') ;;
-h | --help)
	cat <<END
usage: scripts/docs.sh

Builds the site in out/site: the pages and the reference of the Python package by MkDocs, which checks the links, and
under reference/ the library's headers by Doxygen. Any warning is an error. Installs both if need be.
The last line of the output is the page to open.
END
	exit 0
	;;
*) die "unknown option '$1'; see --help" ;;
esac

need_packages doxygen git
python="$(python_env requirements-docs.txt)"
out="$ROOT/out"
pages="$out/pages"
rm -rf "$pages" "$out/site" "$out/reference"
mkdir -p "$pages"

say "reference"
cd "$ROOT"
warnings="$( (
	cat docs/Doxyfile
	echo "OUTPUT_DIRECTORY = $out/reference"
) | doxygen - 2>&1)" || die "$warnings"
[ -z "$warnings" ] || die "Doxygen warns:
$warnings"

say "pages"
# Links between the pages, and to programs and headers, stay what they are in the tree.
git ls-files -z -- '*.md' docs examples vcg_ext filter_mcfskel/CMakeLists.txt meshes/README.md |
	xargs -0 cp --parents -t "$pages"
mv "$out/reference/html" "$pages/reference"
quietly "$python" -m mkdocs build --strict --config-file docs/mkdocs.yml || die "MkDocs: see above"
rm -rf "$pages" "$out/reference"
names="$("$python" - <<'END'
import ast
for line in ast.parse(open("python/mcfskel/__init__.py").read()).body:
    if isinstance(line, ast.Assign) and line.targets[0].id == "__all__":
        print(*ast.literal_eval(line.value), "__version__")
END
)"
for name in ${names:?}; do
	grep -q "id=\"mcfskel\.$name\"" "$out/site/docs/python_reference.html" ||
		die "$name is not in the Python reference: it has no docstring, or is not in __all__ of mcfskel"
done
echo "$out/site/index.html"
