# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package, installed with pip into a fresh virtual environment."""

import filecmp
import json
import os
import re
import shutil
import subprocess
import textwrap
import venv
from pathlib import Path
from typing import Any

import pytest

from conftest import MESHES, ROOT


@pytest.fixture(scope="module")
def python(plugin, tmp_path_factory) -> Path:
    """The interpreter of an environment that has the package, built the way a checkout builds it."""
    folder = tmp_path_factory.mktemp("package")
    shutil.copytree(ROOT / "python", folder / "project" / "python",
                    ignore=shutil.ignore_patterns("build", "*.egg-info", "__pycache__"))
    # The package asks the project's scripts/build.sh for the plugin. Here that is the checkout's own,
    # which finds its work done; or, for tests of a plugin built elsewhere, one that names that.
    build = ROOT / "scripts" / "build.sh"
    if ROOT / "build" / "pymeshlab" in plugin.parents:
        command = f'exec "{build}" "$@"'
    else:
        command = f'[ "$1" = pymeshlab ] || exit 1\necho building\necho "{plugin}"'
    script = folder / "project" / "scripts" / "build.sh"
    script.parent.mkdir()
    script.write_text(f"#!/bin/sh\n{command}\n")
    script.chmod(0o755)
    venv.create(folder / "env", with_pip=True)
    interpreter = folder / "env" / "bin" / "python"
    environment = {name: value for name, value in os.environ.items() if name != "MCFSKEL_PLUGIN"}
    subprocess.run([str(interpreter), "-m", "pip", "install", "-q", "--disable-pip-version-check",
                    str(folder / "project" / "python") + "[networkx,trimesh]"],
                   check=True, env=environment)
    shutil.rmtree(folder / "project")  # nothing of it is needed any more
    return interpreter


@pytest.fixture
def run(python, tmp_path):
    """Runs a script with the package; returns what it left in `answer`."""
    def run_script(script: str) -> Any:
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("MCFSKEL_PLUGIN", "PYTHONPATH")}
        text = ("import json, sys\nimport numpy as np\nMESHES = sys.argv[1]\n"
                + textwrap.dedent(script) + "\nprint('ANSWER' + json.dumps(answer))\n")
        done = subprocess.run([str(python), "-c", text, str(MESHES)], cwd=tmp_path, env=environment,
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.rpartition("ANSWER")[2])
    return run_script


def test_import_binds_every_filter(run, plugin):
    answer = run("""
        import mcfskel, pymeshlab
        answer = [mcfskel.FILTERS, str(mcfskel.PLUGIN),
                  [hasattr(pymeshlab.MeshSet, name) for name in mcfskel.FILTERS]]
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(MESHES + "/torus.off")
        answer.append(layers.generate_meso_skeleton_mcf(steps=2)["iterations"])
    """)
    names, carried, bound, iterations = answer
    assert {"generate_curve_skeleton_mcf", "load_stage_mcf", "save_stage_mcf"} <= set(names)
    assert "site-packages" in carried and filecmp.cmp(carried, plugin, shallow=False)
    assert all(bound)
    assert iterations == 2


def test_skeletonize_arrays_and_trimesh_alike(run):
    answer = run("""
        import mcfskel, trimesh
        mesh = trimesh.load(MESHES + "/plate3.off", process=False)
        s = mcfskel.skeletonize(mesh.vertices, mesh.faces, target_length="1.2%")
        t = mcfskel.skeletonize(mesh, target_length="1.2%")
        extent = float(np.linalg.norm(mesh.extents))
        u = mcfskel.skeletonize(mesh.vertices.tolist(), mesh.faces.tolist(),
                                target_length=0.012 * extent)
        same = all(np.array_equal(getattr(s, k), getattr(t, k))
                   for k in ("nodes", "edges", "radius", "correspondence"))
        answer = {"same": same, "units": len(u.nodes) / len(s.nodes),
                  "shapes": [s.nodes.shape, s.edges.shape, s.radius.shape, s.correspondence.shape],
                  "vertices": len(mesh.vertices), "results": s.results,
                  "range": [int(s.correspondence.min()), int(s.correspondence.max())],
                  "radius": [float(s.radius.min()), float(s.radius.max()), extent],
                  "sources": sum(map(len, s.surface_vertices())),
                  "inverse": all((s.correspondence[v] == n).all()
                                 for n, v in enumerate(s.surface_vertices()))}
    """)
    assert answer["same"]
    assert answer["units"] == pytest.approx(1, rel=0.2)
    nodes, edges, radius, correspondence = answer["shapes"]
    assert nodes == [radius[0], 3] and edges[1] == 2
    assert edges[0] - nodes[0] + 1 == 3 == answer["results"]["cycles"]
    assert correspondence == [answer["vertices"]] and answer["sources"] == answer["vertices"]
    assert 0 <= answer["range"][0] and answer["range"][1] < nodes[0]
    assert answer["inverse"]
    low, high, extent = answer["radius"]
    assert 0 < low <= high < extent / 2


def test_options_reach_the_filter(run):
    answer = run("""
        import mcfskel, pymeshlab, trimesh
        mesh = trimesh.load(MESHES + "/capsule.off", process=False)
        coarse = dict(target_length="1.2%", refine=False)
        answer = [len(mcfskel.skeletonize(mesh, epsilon=e, **coarse).nodes)
                  for e in ("0.2%", "0.6%", pymeshlab.PercentageValue(0.6))]
        answer.append(mcfskel.skeletonize(mesh, max_iterations=2, **coarse).results["iterations"])
    """)
    assert answer[0] > 1.5 * answer[1] and answer[1] == answer[2]
    assert answer[3] == 2


def test_networkx(run):
    answer = run("""
        import mcfskel, networkx, trimesh
        s = mcfskel.skeletonize(trimesh.load(MESHES + "/torus.off", process=False), target_length="1.2%")
        g = s.to_networkx()
        node = g.nodes[5]
        answer = {"cycles": len(networkx.cycle_basis(g)), "connected": networkx.is_connected(g),
                  "position": bool(np.array_equal(node["position"], s.nodes[5])),
                  "radius": bool(node["radius"] == s.radius[5]),
                  "sources": node["surface_vertices"] == s.surface_vertices()[5].tolist(),
                  "length": g.size("length"), "expected": s.results["skeleton_length"]}
    """)
    assert answer["cycles"] == 1 and answer["connected"]
    assert answer["position"] and answer["radius"] and answer["sources"]
    assert answer["length"] == pytest.approx(answer["expected"])


def test_save_and_load(run, tmp_path):
    answer = run("""
        import mcfskel, networkx, pickle, trimesh, warnings
        s = mcfskel.skeletonize(trimesh.load(MESHES + "/torus.off", process=False), target_length="1.2%")
        s = pickle.loads(pickle.dumps(s))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for kind in ("swc", "cg", "graphml", "json", "ply"):
                s.save("s." + kind)
        cg, swc = mcfskel.load("s.cg"), mcfskel.load("s.swc")
        g = networkx.node_link_graph(json.load(open("s.json")), edges="edges")
        answer = {"warnings": [str(w.message) for w in caught],
                  "cg": bool(np.array_equal(cg.nodes, s.nodes) and np.array_equal(cg.edges, s.edges)),
                  "swc": [len(swc.nodes) == len(s.nodes), len(s.edges) - len(swc.edges)],
                  "radius": bool(np.array_equal(np.sort(swc.radius), np.sort(s.radius))),
                  "json": [g.nodes[n]["surface_vertices"] for n in g]
                          == [v.tolist() for v in s.surface_vertices()]}
    """)
    assert len(answer["warnings"]) == 1 and "cycle cut between" in answer["warnings"][0]
    assert answer["cg"] and answer["swc"] == [True, 1] and answer["radius"] and answer["json"]
    assert (tmp_path / "s.ply").is_file()


def test_errors_are_one_sentence_with_the_cure(run):
    answer = run("""
        import mcfskel, os, trimesh
        mesh = trimesh.load(MESHES + "/torus.off", process=False)
        def reason(call):
            try:
                call()
            except mcfskel.SkeletonError as error:
                return str(error)
        open("bad.swc", "w").write("1 0 0 0 0 1 -1\\n2 0 x 0 0 1 1\\n")
        here = os.getcwd()
        answer = [reason(call) for call in [
            lambda: mcfskel.skeletonize(mesh.vertices, mesh.faces[:-1]),
            lambda: mcfskel.skeletonize(mesh, epsilom=0.2),
            lambda: mcfskel.skeletonize(mesh, epsilon="much"),
            lambda: mcfskel.skeletonize(mesh.vertices[:, :2], mesh.faces),
            lambda: mcfskel.skeletonize(mesh.vertices, mesh.faces + 1),
            lambda: mcfskel.skeletonize(mesh.vertices, mesh.faces / 2),
            lambda: mcfskel.skeletonize("mesh.off"),
            lambda: mcfskel.load("bad.swc"),
            lambda: mcfskel.load("bad.json"),
        ]] + [os.getcwd() == here, len(mcfskel.skeletonize(mesh, target_length="1.5%").nodes)]
    """)
    words = ["Close Holes", "no option epsilom", "is no length", "shape (n, 3)", "not one of the",
             "ids must be integers", "vertices and faces", "Line 2", "does not end with"]
    for text, word in zip(answer, words, strict=False):
        assert text is not None and word in text, (text, word)
    assert answer[-2] is True
    assert answer[-1] > 0, "after all these errors the next mesh is done"


def test_without_a_plugin_the_import_says_what_to_do(python, tmp_path):
    done = subprocess.run([str(python), "-c", "import mcfskel"], capture_output=True, text=True,
                          env=os.environ | {"MCFSKEL_PLUGIN": str(tmp_path / "none.so")})
    assert done.returncode != 0 and "pip install ./python" in done.stderr


def test_the_examples_of_the_docs_run(run):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), re.DOTALL)
    answer = run("\n".join(blocks).replace('"meshes/', 'MESHES + "/')
                 + "\nanswer = [len(skeleton.nodes), len(fine.nodes), len(again.nodes), len(graph)]")
    assert answer[0] == answer[2] == answer[3] < answer[1]
