# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/upstream.sh: what the patches against MeshLab's tree hold. That a plugin built from one gives the same bits
is tested where MCFSKEL_UPSTREAM_PLUGIN names one (scripts/upstream.sh --build WHICH double)."""

import hashlib
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import filter_names
from conftest import MESHES, ROOT

PLACE = "src/meshlabplugins/filter_mcfskel"
FIRST = {filter_names.RESAMPLE, filter_names.POLES, filter_names.STEP, filter_names.COLLAPSE, filter_names.FULL}


@pytest.fixture(scope="module")
def sources() -> Path:
    """MeshLab's source tree, which the plugin under test was built with."""
    return Path(os.environ["MCFSKEL_VCG"]).parents[1]


@pytest.fixture(scope="module", params=["whole", "first"])
def patched(request, sources, tmp_path_factory) -> tuple[str, Path, str]:
    """Which patch, MeshLab's tree with it (of the rest only what it changes), and the patch."""
    tree = tmp_path_factory.mktemp(request.param)
    options = ["--first"] if request.param == "first" else []
    patch = subprocess.run([sys.executable, str(ROOT / "scripts/upstream/make_patch.py"), "--meshlab", str(sources),
                            *options], capture_output=True, text=True, check=True).stdout
    (tree / "src").mkdir()
    (tree / "src/CMakeLists.txt").write_bytes((sources / "src/CMakeLists.txt").read_bytes())
    (tree / "src/.clang-format").write_bytes((sources / "src/.clang-format").read_bytes())
    (tree / "a.patch").write_text(patch)
    subprocess.run(["git", "apply", "--whitespace=error-all", "a.patch"], cwd=tree, check=True,
                   env=os.environ | {"GIT_CEILING_DIRECTORIES": str(tree.parent)})
    return request.param, tree, patch


def test_changes_one_folder_and_one_line(patched):
    which, tree, patch = patched
    changed = re.findall(r"^diff --git a/(\S+) b/(\S+)$", patch, re.M)
    others = {a for a, b in changed if not b.startswith(PLACE + "/")}
    assert others == {"src/CMakeLists.txt"} and len(changed) > 100
    listing = re.search(r"^diff --git a/src/CMakeLists.txt.*?(?=^diff|\Z)", patch, re.M | re.S)[0]
    lines = [line for line in listing.splitlines() if re.match(r"[+-](?![+-])", line)]
    assert [line.split() for line in lines] == [["+", "meshlabplugins/filter_mcfskel"]]
    assert lines[0].startswith("+\t\t")
    names = re.findall(r"meshlabplugins/(filter_[m]\w+)", (tree / "src/CMakeLists.txt").read_text())
    assert names.index("filter_mcfskel") == names.index("filter_measure") - 1


def test_every_file_is_built_and_every_include_is_there(patched):
    _, tree, _ = patched
    folder = tree / PLACE
    files = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.suffix in (".h", ".cpp")}
    cmake = (folder / "CMakeLists.txt").read_text()
    assert files == set(re.findall(r"[\w/.]+\.(?:h|cpp)\b", cmake))
    for name in files:
        text = (folder / name).read_text()
        for quoted, angled in re.findall(r'#include (?:"([^"]+)"|<(skeleton/[^>]+)>)', text):
            path = (folder / name).parent / quoted if quoted else folder / angled
            assert path.is_file(), f"{name} includes {quoted or angled}"
    assert "cxx_std_17" in cmake and "external-qhull" in cmake and "objcopy" not in cmake
    # What only some compilers or systems know is asked for by name.
    for flag in ("-ffp-contract=off", "-Wl,-z,nodelete"):
        line = cmake[:cmake.index(flag)].rsplit("\n", 4)[1:]
        assert any("GNU" in text or "UNIX" in text for text in line), flag


def test_nothing_of_other_hosts_is_left(patched):
    _, tree, _ = patched
    folder = tree / PLACE
    assert not (folder / "adapters").exists()
    for path in folder.rglob("*.*"):
        text = path.read_text()
        found = re.findall(r"^\s*#\s*(?:el)?if.*MCFSKEL_(?!HAS_QHULL|PORTABLE_FILES)\w+(?<!_H)\b.*$", text, re.M)
        assert not found, f"{path.name}: {found}"
        assert "link.h" not in text and "pymeshlab_log" not in text
        assert "SPDX-License-Identifier: GPL-3.0-or-later" in text


def test_the_filters_are_those_that_are_asked_for(patched):
    which, tree, _ = patched
    texts = [p.read_text() for p in (tree / PLACE).rglob("*.cpp")]
    # The catalogue's entries are the functions that are defined, and they have these names in scripts.
    catalogue = (tree / PLACE / "filters.cpp").read_text()
    functions = re.findall(r"(\w+Filter)\(\)", catalogue[catalogue.index("& catalogue()"):])
    defined = [name for text in texts for name in re.findall(r"^FilterSpec (\w+Filter)\(\)\s*$", text, re.M)]
    assert sorted(functions) == sorted(defined) and functions
    names = {name for text in texts for name in re.findall(r'"(\w+_mcf)"', text)}
    if which == "whole":
        assert FIRST < names and len(functions) == len(names)
    else:
        assert len(functions) == len(FIRST) and FIRST <= names
        assert not any("keep_sheets" in text or "IOPlugin" in text for text in texts)
        assert not (tree / PLACE / "io").exists() and not (tree / PLACE / "skeleton/measure").exists()


def test_is_laid_out_as_meshlab_lays_out_its_own(patched):
    _, tree, _ = patched
    files = sorted(str(p) for p in (tree / PLACE).rglob("*") if p.suffix in (".h", ".cpp"))
    subprocess.run(["clang-format", "--dry-run", "-Werror", "--sort-includes=0", *files], cwd=tree / "src", check=True)


BITS = """
import hashlib, sys, numpy, pymeshlab
pymeshlab.load_plugin(sys.argv[1])
digest = hashlib.sha256()
def add(layers):
    for mesh in layers:
        for values in (mesh.vertex_matrix(), mesh.face_matrix(), mesh.edge_matrix(), mesh.vertex_scalar_array()):
            digest.update(numpy.ascontiguousarray(values).tobytes())
for name, options in (("animal450", {}), ("plate3", {"pole_method": 1})):
    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(f"{sys.argv[2]}/{name}.off")
    layers.apply_filter("generate_curve_skeleton_mcf", **options)
    add(layers)
layers = pymeshlab.MeshSet()
layers.load_new_mesh(f"{sys.argv[2]}/hand.off")
layers.apply_filter("meshing_isotropic_resampling_mcf")
layers.apply_filter("compute_medial_poles_mcf")
layers.apply_filter("generate_meso_skeleton_mcf", steps=3)
layers.apply_filter("generate_curve_skeleton_from_meso_mcf")
add(layers)
print(digest.hexdigest())
"""


@pytest.mark.skipif("MCFSKEL_UPSTREAM_PLUGIN" not in os.environ, reason="MCFSKEL_UPSTREAM_PLUGIN names no plugin")
def test_gives_the_same_bits(plugin):
    def bits(path: str) -> str:
        return subprocess.run([sys.executable, "-c", BITS, path, str(MESHES)], check=True, capture_output=True,
                              text=True).stdout.splitlines()[-1]

    assert len(bits(str(plugin))) == hashlib.sha256().digest_size * 2
    assert bits(os.environ["MCFSKEL_UPSTREAM_PLUGIN"]) == bits(str(plugin))
