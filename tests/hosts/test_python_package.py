# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package, installed with pip into a fresh virtual environment."""

import filecmp
import json
import math
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
                    str(folder / "project" / "python") + "[networkx,trimesh,pyvista,plot,points]"],
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
                + textwrap.dedent(script) + "\nprint('ANSWER' + json.dumps(answer, default=lambda v: v.item()))\n")
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
                  "shapes": [s.nodes.shape, s.edges.shape, s.radius.shape, s.correspondence.shape,
                             s.significance.shape],
                  "vertices": len(mesh.vertices), "results": s.results,
                  "range": [int(s.correspondence.min()), int(s.correspondence.max())],
                  "radius": [float(s.radius.min()), float(s.radius.max()), extent],
                  "sources": sum(map(len, s.surface_vertices())),
                  "inverse": all((s.correspondence[v] == n).all()
                                 for n, v in enumerate(s.surface_vertices()))}
    """)
    assert answer["same"]
    assert answer["units"] == pytest.approx(1, rel=0.2)
    nodes, edges, radius, correspondence, significance = answer["shapes"]
    assert significance == radius
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
        g, a = s.to_networkx(), s.to_networkx(arrays=True)
        node = a.nodes[5]
        for name in ("graphml", "gml", "gexf", "adjlist", "multiline_adjlist", "edgelist",
                     "weighted_edgelist"):
            getattr(networkx, "write_" + name)(g, "s." + name)
        again = networkx.read_graphml("s.graphml", node_type=int)
        s.save("ours.graphml")
        ours = networkx.read_graphml("ours.graphml", node_type=int)
        answer = {"cycles": len(networkx.cycle_basis(g)), "connected": networkx.is_connected(g),
                  "position": node["position"] == tuple(s.nodes[5].tolist()),
                  "radius": node["radius"] == s.radius[5],
                  "sources": node["surface_vertices"] == s.surface_vertices()[5].tolist(),
                  "same": all(dict(again.nodes[n]) == dict(g.nodes[n]) for n in g),
                  "as_the_file": all({k: v or "" for k, v in ours.nodes[n].items()} == dict(g.nodes[n])
                                     for n in g),
                  "length": g.size("length"), "expected": s.results["skeleton_length"]}
    """)
    assert answer["cycles"] == 1 and answer["connected"]
    assert answer["position"] and answer["radius"] and answer["sources"]
    assert answer["same"] and answer["as_the_file"]
    assert answer["length"] == pytest.approx(answer["expected"])


def test_tips_junctions_and_branches_are_those_of_the_filter(run):
    answer = run("""
        import mcfskel
        answer = []
        for name in ("animal450", "plate3", "torus"):
            s = mcfskel.skeletonize(MESHES + f"/{name}.off", target_length="1.5%", refine=False)
            r = s.results
            chains = [np.sort(np.column_stack([b[:-1], b[1:]]), axis=1) for b in s.branches]
            edges = np.unique(np.concatenate(chains), axis=0)
            answer.append({"counts": [len(s.leafs), len(s.junctions), len(s.branches)],
                           "filter": [r["terminals"], r["junctions"], r["branches"]],
                           "each edge once": len(np.concatenate(chains)) == len(edges)
                                             and bool((edges == s.edges).all()),
                           "inner": all((s.degree[b[1:-1]] == 2).all() for b in s.branches),
                           "closed": [bool(b[0] == b[-1]) for b in s.branches]})
    """)
    for skeleton in answer:
        assert skeleton["counts"] == skeleton["filter"]
        assert skeleton["each edge once"] and skeleton["inner"]
    assert answer[2]["closed"] == [True]


def test_shown_in_a_notebook_and_plotted(run):
    answer = run("""
        import mcfskel, re, matplotlib
        from base64 import b64decode
        from xml.etree import ElementTree
        matplotlib.use("Agg")
        s = mcfskel.skeletonize(MESHES + "/torus.off", target_length="1.5%", refine=False)
        page = s._repr_html_()
        ElementTree.fromstring(page.replace("<br>", "<br/>"))
        image = b64decode(re.search('base64,([^"]*)', page)[1])
        open("s.png", "wb").write(image)
        import matplotlib.image
        pixels = matplotlib.image.imread("s.png")
        ax = s.plot()
        ax.figure.savefig("plot.png")
        lines = [c for c in ax.collections if type(c).__name__ == "Line3DCollection"]
        answer = {"repr": repr(s), "html": len(page), "lines": page.count("<path"),
                  "covered": float((pixels[..., 3] > 0).mean()), "alpha": float(pixels[0, 0, 3]),
                  "segments": len(lines[0].get_array()), "edges": len(s.edges),
                  "without": repr(mcfskel.Skeleton(s.nodes, s.edges, s.radius, s.correspondence))}
    """)
    assert answer["repr"] == answer["without"] and len(answer["repr"]) < 120
    assert f"{answer['edges']} edges, 1 branch" in answer["repr"]
    assert answer["html"] < 400_000 and answer["lines"] >= 1
    # A ring seen along its axis: there is a hole in the middle and nothing in the corners.
    assert 0.2 < answer["covered"] < 0.75 and answer["alpha"] == 0
    assert answer["segments"] == answer["edges"]


def test_other_packages(run):
    answer = run("""
        import mcfskel, trimesh, pyvista
        s = mcfskel.skeletonize(MESHES + "/plate3.off", target_length="1.5%", refine=False)
        lines, path = s.to_pyvista(), s.to_trimesh()
        scene, plotter = s.plot(backend="trimesh"), s.plot(backend="pyvista")
        answer = {"length": float(s.lengths().sum()), "branches": len(s.branches),
                  "shown": [sorted(scene.geometry), len(plotter.actors), float(np.abs(scene.bounds - np.array(
                      [s.surface.vertices.min(axis=0), s.surface.vertices.max(axis=0)])).max())],
                  "pyvista": [lines.n_lines, float(lines.compute_cell_sizes()["Length"].sum()),
                              bool((lines["radius"] == s.radius).all())],
                  "trimesh": [len(path.entities), float(path.length)]}
    """)
    assert answer["pyvista"] == [answer["branches"], pytest.approx(answer["length"]), True]
    assert answer["trimesh"] == [answer["branches"], pytest.approx(answer["length"])]
    assert answer["shown"][0] == ["skeleton", "surface"] and answer["shown"][1] >= 2
    assert answer["shown"][2] == pytest.approx(0, abs=1e-6)


def test_a_neuron_of_navis_has_all_nodes_and_its_units(run):
    """navis in the place of which a stand-in reads the file: the real reader's part is in test_losses.py."""
    answer = run("""
        import mcfskel, sys, types
        def read_swc(path):
            rows = [line.split() for line in open(path) if not line.startswith("#")]
            return types.SimpleNamespace(count=len(rows), units="1 dimensionless")
        sys.modules["navis"] = types.SimpleNamespace(read_swc=read_swc)
        s = mcfskel.skeletonize(MESHES + "/capsule.off", target_length="3%")
        neuron = s.to_navis(units="nm")
        answer = [neuron.count, len(s.nodes), neuron.units, s.to_navis().units]
    """)
    assert answer[0] == answer[1] and answer[2:] == ["nm", "1 dimensionless"]


def test_vtk_reads_vtp(run):
    """VTK's own reader, through PyVista: each branch one polyline, VMTK's names, no bit lost."""
    answer = run("""
        import mcfskel, pyvista
        s = mcfskel.skeletonize(MESHES + "/plate3.off", target_length="1.5%", refine=False)
        s.save("s.vtp")
        t = mcfskel.load("s.vtp")
        v = pyvista.read("s.vtp")
        chains, at = [], 0
        while at < len(v.lines):
            chains.append(v.lines[at + 1:at + 1 + v.lines[at]].tolist())
            at += v.lines[at] + 1
        answer = {"branches": chains == [b.tolist() for b in s.branches],
                  "points": bool(np.array_equal(v.points, s.nodes)),
                  "radius": bool(np.array_equal(v["MaximumInscribedSphereRadius"], s.radius)),
                  "groups": v["GroupIds"].tolist(), "count": len(s.branches),
                  "names": sorted(v.cell_data.keys()),
                  "node": bool(np.array_equal(v.field_data["mcfskel_node"], s.correspondence)),
                  "again": all(np.array_equal(getattr(s, k), getattr(t, k)) for k in
                               ("nodes", "edges", "radius", "correspondence", "significance"))}
    """)
    assert answer["branches"] and answer["points"] and answer["radius"] and answer["node"]
    assert answer["groups"] == list(range(answer["count"])) and answer["again"]
    assert answer["names"] == ["Blanking", "CenterlineIds", "GroupIds", "TractIds"]


def test_branch_measures_of_known_curves(run):
    """A half circle, a helix, a Y with right angles, and a tree whose orders Strahler's rule gives."""
    answer = run("""
        import mcfskel
        def skeleton(nodes, edges, radius=None):
            nodes, edges = np.array(nodes, float), np.sort(np.array(edges), axis=1)
            radius = np.full(len(nodes), 0.1) if radius is None else np.array(radius, float)
            return mcfskel.Skeleton(nodes, edges, radius, np.empty(0, int))
        def chain(points, closed=False):
            n = len(points)
            return skeleton(points, [(i, (i + 1) % n) for i in range(n if closed else n - 1)])
        t = np.linspace(0, np.pi, 400)
        half = chain(3 * np.column_stack([np.cos(t), np.sin(t), 0 * t])).branch_measures()
        ring = chain(3 * np.column_stack([np.cos(2 * t), np.sin(2 * t), 0 * t])[:-1], True)
        u = np.linspace(0, 6 * np.pi, 3000)
        helices = [chain(np.column_stack([2 * np.cos(u), 2 * np.sin(u), pitch * u])).branch_measures()
                   for pitch in (0.5, -0.5)]
        # Bent at once behind the junction, within its ball: the angle is that outside.
        y = skeleton([[0, 0, 0], [.05, .05, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0]],
                     [(0, 1), (1, 2), (0, 3), (0, 4)], [.5, .1, .2, .3, .4]).branch_measures()
        #     0 - 1 - 2 - 3   side branches 4 at 1, 5 at 2, and 6, 7 on 5: orders by hand
        tree = skeleton(np.random.default_rng(1).random((8, 3)),
                        [(0, 1), (1, 2), (2, 3), (1, 4), (2, 5), (5, 6), (5, 7)], [9] + 7 * [1])
        orders = {f"{a}-{b}": o for a, b, o in zip(*(tree.branch_measures()[k].tolist()
                                                     for k in ("first", "last", "strahler")))}
        answer = {"half": {k: float(v[0]) for k, v in half.items()},
                  "ring": {k: float(v[0]) for k, v in ring.branch_measures().items()},
                  "helices": [[float(h[k][0]) for k in ("curvature", "torsion")] for h in helices],
                  "y": {k: v.tolist() for k, v in y.items()}, "orders": orders}
    """)
    half, ring, y = answer["half"], answer["ring"], answer["y"]
    assert half["length"] == pytest.approx(3 * math.pi, rel=1e-4)
    assert half["chord"] == pytest.approx(6)
    assert half["tortuosity"] == pytest.approx(math.pi / 2 - 1, rel=1e-3)
    assert half["curvature"] == pytest.approx(1 / 3, rel=0.005)
    assert ring["curvature"] == pytest.approx(1 / 3, rel=1e-4) and ring["tortuosity"] == math.inf
    # A helix of radius a and pitch 2 pi b has curvature a and torsion b over a^2 + b^2, right-handed for b > 0.
    for hand, (curvature, torsion) in zip((1, -1), answer["helices"]):
        assert curvature == pytest.approx(2 / (2 ** 2 + 0.5 ** 2), rel=0.002)
        assert torsion == pytest.approx(hand * 0.5 / (2 ** 2 + 0.5 ** 2), rel=0.002)
    assert half["torsion"] == pytest.approx(0, abs=1e-9) == ring["torsion"]
    assert math.isnan(half["section_area"]), "there is no surface"
    assert y["angle_first"] == pytest.approx([90, 90, 90]) and all(map(math.isnan, y["angle_last"]))
    assert y["radius_min"][1:] == [0.3, 0.4] and y["radius_max"] == [0.5] * 3
    assert y["radius_mean"][1] == pytest.approx(0.4)
    assert answer["orders"] == {"0-1": 2, "1-2": 2, "2-3": 1, "1-4": 1, "2-5": 2, "5-6": 1, "5-7": 1}


def test_sections_of_known_surfaces(run):
    """Elliptic tubes of 2 by 1, straight and bent beside a second tube that the planes cut as well; then a
    skeleton of round limbs whose radius is known."""
    answer = run("""
        import mcfskel
        def tube(centre, u, v, n=240):
            m, t = len(centre), np.arange(n) * 2 * np.pi / n
            points = (centre[:, None] + 2 * np.cos(t)[:, None] * u[:, None] + np.sin(t)[:, None] * v[:, None])
            j, i = (k.ravel() for k in np.meshgrid(np.arange(m - 1), np.arange(n), indexing="ij"))
            p, q, r, s = j * n + i, j * n + (i + 1) % n, (j + 1) * n + i, (j + 1) * n + (i + 1) % n
            i = np.arange(n)
            faces = np.concatenate([np.stack(f, 1) for f in (
                (p, q, s), (p, s, r), (np.full(n, m * n), (i + 1) % n, i),
                (np.full(n, m * n + 1), (m - 1) * n + i, (m - 1) * n + (i + 1) % n))])
            return np.vstack([points.reshape(-1, 3), centre[[0, -1]]]), faces
        def measured(centre, *tubes):
            points, faces, first = [], [], 0
            for p, f in tubes:
                points.append(p); faces.append(f + first); first += len(p)
            n = len(centre)
            edges = np.stack([np.arange(n - 1), np.arange(1, n)], 1)
            surface = mcfskel.Surface(np.vstack(points), np.vstack(faces))
            s = mcfskel.Skeleton(centre, edges, np.ones(n), np.empty(0, int), surface=surface)
            return {k: float(v[0]) for k, v in s.branch_measures().items() if k.startswith("section")}
        z, x, y = np.eye(3)[[2, 0, 1]]
        centre = np.linspace(-9, 9, 90)[:, None] * z
        one = np.ones((90, 3))
        straight = measured(centre, tube(centre, x * one, y * one))
        turn = np.linspace(0, np.pi, 90)
        way = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
        arc, beside = 10 * way, 20 * way
        # Cut by the same planes, and half as wide: not around the curve.
        bent = measured(arc, tube(arc, z * one, way), tube(beside, z * one / 2, way / 2))
        y_tube = mcfskel.skeletonize(MESHES + "/y_tube.off").branch_measures()
        answer = {"straight": straight, "bent": bent,
                  "y": {k: v.tolist() for k, v in y_tube.items()}}
    """)
    h = (1 / 3) ** 2
    perimeter = math.pi * 3 * (1 + 3 * h / (10 + math.sqrt(4 - 3 * h)))  # Ramanujan 1914
    for shape in ("straight", "bent"):
        section = answer[shape]
        assert section["section_area"] == pytest.approx(2 * math.pi, rel=0.003)
        assert section["section_perimeter"] == pytest.approx(perimeter, rel=0.003)
        assert section["section_diameter_min"] == pytest.approx(2, rel=0.003)
        assert section["section_diameter_max"] == pytest.approx(4, rel=0.003)
    y = answer["y"]
    for k in range(3):  # tubes of radius 0.25
        assert y["section_area"][k] == pytest.approx(math.pi * 0.25 ** 2, rel=0.02)
        assert y["section_diameter_min"][k] == pytest.approx(0.5, rel=0.02)
        assert y["section_diameter_max"][k] == pytest.approx(0.5, rel=0.02)


def test_nothing_optional_is_imported_before_it_is_used(run):
    answer = run("""
        import mcfskel
        s = mcfskel.skeletonize(MESHES + "/box8.off", target_length="4%", refine=False)
        s._repr_html_()
        answer = [name for name in ("networkx", "trimesh", "pyvista", "navis", "matplotlib")
                  if name in sys.modules]
        sys.modules["navis"] = None
        try:
            s.to_navis()
        except mcfskel.SkeletonError as error:
            answer.append(str(error))
    """)
    assert len(answer) == 1 and "pip install navis" in answer[0]


def test_sheets_are_kept(run):
    answer = run("""
        import mcfskel, networkx, warnings
        s = mcfskel.skeletonize(MESHES + "/cup.off", keep_sheets=True, target_length="1.5%")
        s.save("s.ply")
        t = mcfskel.load("s.ply")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            s.save("s.json")
        sides = np.unique(np.sort(s.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        graph = s.to_networkx()
        answer = {"faces": [len(s.faces), s.results["sheet_faces"]], "b0": s.results["b0"],
                  "pieces": networkx.number_connected_components(graph),
                  "same": all(np.array_equal(getattr(s, k), getattr(t, k)) for k in
                              ("nodes", "edges", "radius", "correspondence", "faces")),
                  "warnings": [str(w.message) for w in caught],
                  "edges": [graph.number_of_edges(), len(s.edges), len(sides)],
                  "tips": [len(s.leafs), bool(np.isin(s.leafs, s.faces).any())]}
    """)
    assert answer["faces"][0] == answer["faces"][1] > 0
    assert answer["pieces"] == answer["b0"] == 1
    assert answer["edges"][0] == answer["edges"][1] + answer["edges"][2]
    assert answer["same"]
    assert len(answer["warnings"]) == 1 and "triangles of the sheets" in answer["warnings"][0]
    assert not answer["tips"][1]


def test_a_file_of_sheets_replaces_what_it_may(run, tmp_path):
    (tmp_path / "real.ply").write_text("old")
    (tmp_path / "real.ply").chmod(0o640)
    (tmp_path / "link.ply").symlink_to("real.ply")
    os.mkfifo(tmp_path / "pipe.ply")
    answer = run("""
        import mcfskel, os, threading
        triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
        s = mcfskel.Skeleton(triangle, np.empty((0, 2), int), np.ones(3), np.zeros(2, int), {}, np.array([[0, 1, 2]]))
        s.save("link.ply")
        piped = []
        reader = threading.Thread(target=lambda: piped.append(open("pipe.ply", "rb").read()))
        reader.start()
        s.save("pipe.ply")
        reader.join()
        answer = {"faces": mcfskel.load("real.ply").faces.tolist(), "link": os.path.islink("link.ply"),
                  "mode": os.stat("real.ply").st_mode & 0o777, "same": piped[0] == open("real.ply", "rb").read(),
                  "files": sorted(os.listdir("."))}
    """)
    assert answer == {"faces": [[0, 1, 2]], "link": True, "mode": 0o640, "same": True,
                      "files": ["link.ply", "pipe.ply", "real.ply"]}


def test_pictures_of_what_has_no_edges_and_of_stray_vertices(run):
    answer = run("""
        import mcfskel, matplotlib
        matplotlib.use("Agg")
        s = mcfskel.skeletonize(MESHES + "/torus.off", target_length="3%", refine=False)
        stray = np.vstack([s.surface.vertices, [[np.nan] * 3]])
        s = mcfskel.skeletonize(stray, s.surface.faces, target_length="3%", refine=False)
        sheet = mcfskel.Skeleton(np.eye(3), np.empty((0, 2), int), np.ones(3), np.empty(0, int), {},
                                 np.array([[0, 1, 2]]))
        limits = s.plot().get_xlim()
        sheet.plot().figure.savefig("sheet.png")
        answer = ["<image" in s._repr_html_(), bool(np.isfinite(limits).all()), "<path" in sheet._repr_html_()]
    """)
    assert answer == [True, True, True]


def test_ctrl_c_ends_a_job(run):
    answer = run("""
        import mcfskel, os, signal, threading, time
        mcfskel.skeletonize(MESHES + "/box8.off", target_length="4%", refine=False)
        answer = []
        for wait in (0.2, 1.0, 3.0):
            sent = []
            def send():
                sent.append(time.monotonic())
                os.kill(os.getpid(), signal.SIGINT)
            timer = threading.Timer(wait, send)
            timer.start()
            try:
                mcfskel.skeletonize(MESHES + "/animal.off", target_length="0.25%")
                timer.join()
                answer.append("not interrupted")
            except KeyboardInterrupt:
                answer.append(time.monotonic() - sent[0])
        again = mcfskel.skeletonize(MESHES + "/box8.off", target_length="4%", refine=False)
        answer.append(len(again.nodes))
    """)
    # 0.2 seconds where a processor is free; the tests run beside each other.
    assert all(isinstance(seconds, float) and seconds < 2 for seconds in answer[:3]), answer
    assert answer[3] > 0


def test_a_contraction_that_is_cut_short_warns(run):
    answer = run("""
        import mcfskel, warnings
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mcfskel.skeletonize(MESHES + "/torus.off", target_length="1.5%", max_iterations=2)
            short = len(caught)
            mcfskel.skeletonize(MESHES + "/torus.off", target_length="1.5%")
        answer = [short, len(caught), str(caught[0].message), caught[0].category.__name__]
    """)
    assert answer[:2] == [1, 1]
    assert "not converged after 2 iterations" in answer[2] and answer[3] == "SkeletonWarning"


def test_components_that_are_not_refined_are_told(run):
    answer = run("""
        import mcfskel, warnings
        apply = mcfskel._skeleton.apply
        mcfskel._skeleton.apply = lambda *arguments: apply(*arguments) | {"refined": 0.5}
        answer = []
        for options in [{}, {"refine": False}, {"keep_sheets": True}, {"preset": "paper"}]:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                mcfskel.skeletonize(MESHES + "/torus.off", target_length="3%", **options)
            answer.append([str(warning.message) for warning in caught])
    """)
    assert len(answer[0]) == 1 and "50% of the components are not refined" in answer[0][0]
    assert answer[1:] == [[], [], []], "where no refinement was asked for"


def test_save_and_load(run, tmp_path):
    answer = run("""
        import mcfskel, networkx, pickle, trimesh, warnings
        s = mcfskel.skeletonize(trimesh.load(MESHES + "/torus.off", process=False), target_length="1.2%")
        s = pickle.loads(pickle.dumps(s))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for kind in ("swc", "cg", "graphml", "json", "vtp", "ply"):
                s.save("s." + kind)
        cg, swc = mcfskel.load("s.cg"), mcfskel.load("s.swc")
        all_of_it = [np.array_equal(getattr(s, k), getattr(mcfskel.load("s." + kind), k))
                     for kind in ("graphml", "json", "vtp", "ply")
                     for k in ("nodes", "edges", "radius", "correspondence", "significance")]
        g = networkx.node_link_graph(json.load(open("s.json")), edges="edges")
        answer = {"warnings": [str(w.message) for w in caught], "all": all_of_it,
                  "cg": bool(np.array_equal(cg.nodes, s.nodes) and np.array_equal(cg.edges, s.edges)),
                  "swc": [len(swc.nodes) == len(s.nodes), len(s.edges) - len(swc.edges)],
                  "radius": bool(np.array_equal(np.sort(swc.radius), np.sort(s.radius))),
                  "json": [g.nodes[n]["surface_vertices"] for n in g]
                          == [v.tolist() for v in s.surface_vertices()]}
    """)
    assert len(answer["warnings"]) == 1 and "cycle cut between" in answer["warnings"][0]
    assert answer["cg"] and answer["swc"] == [True, 1] and answer["radius"] and answer["json"]
    assert all(answer["all"]) and len(answer["all"]) == 20


def test_glb_of_a_repaired_mesh(run):
    """The mesh itself if it bounds a solid, though it crosses itself; else the solid that it was made into."""
    answer = run("""
        import mcfskel, pickle, trimesh
        mesh = trimesh.load(MESHES + "/capsule.off", process=False)
        away = mesh.copy().apply_translation(0.3 * mesh.extents)
        soup = trimesh.util.concatenate([mesh, away])
        answer = []
        for made_of, faces, resample in [(mesh, mesh.faces[1:], False), (mesh, mesh.faces[1:], True),
                                         (soup, soup.faces[1:], False), (soup, soup.faces, True)]:
            s = mcfskel.skeletonize(made_of.vertices, faces, resample=resample)
            pickle.loads(pickle.dumps(s)).save("s.glb")
            skin = trimesh.load("s.glb", process=False, force="mesh")
            answer.append([s.results["repaired"], skin.is_watertight, len(skin.faces) == len(made_of.faces),
                           bool(np.allclose(skin.bounds, made_of.bounds, atol=0.01))])
    """)
    assert answer == [[1, True, True, True], [1, True, False, True], [2, True, False, True], [2, True, True, True]]


def test_bridges_are_kept_in_files(run):
    answer = run("""
        import mcfskel
        s = mcfskel.skeletonize(MESHES + "/capsule.off", target_length="2%").surface
        width = np.ptp(s.vertices, axis=0).max()
        three = [s.vertices + [0, 0.6 * k * width, 0] for k in range(3)]
        faces = np.vstack([s.faces + k * len(s.vertices) for k in range(3)])
        s = mcfskel.skeletonize(np.vstack(three), faces, target_length="2%", join=True)
        answer = [int(s.bridges.sum())]
        for kind in ("graphml", "json", "vtp", "ply"):
            s.save("s." + kind)
            t = mcfskel.load("s." + kind)
            answer.append(bool(np.array_equal(t.bridges, s.bridges) and np.array_equal(t.edges, s.edges)))
        s.save("s.cg")
        answer.append(len(mcfskel.load("s.cg").bridges))
    """)
    assert answer == [4, True, True, True, True, 0]


ERRORS = {
    "mesh.vertices, mesh.faces[:-1], repair='off'": "Close Holes",
    "mesh, epsilom=0.2": "no option epsilom",
    "mesh, epsilon='much'": "epsilon='much' is no length",
    "mesh, epsilon='-1%'": "epsilon='-1%' is not between 0% and 100%",
    "mesh, epsilon='150%'": "epsilon='150%' is not between 0% and 100%",
    "mesh, epsilon=-1": "Parameter epsilon must be between",
    "mesh, epsilon='0.5'": "epsilon='0.5' is no length: write 0.01 (mesh units) or '0.2%'",
    "mesh, epsilon=10**400": "epsilon is too large",
    "mesh, w_m='20%'": "w_m='20%' is no number",
    "mesh, w_m=10**400": "w_m is too large",
    "mesh, max_iterations=10**400": "max_iterations is too large",
    "mesh, refine=np.array([1, 2])": "is no truth value",
    "mesh, w_h=float('nan')": "Parameter w_h must be",
    "mesh, w_l='a'": "w_l='a' is no number",
    "mesh, resample='no'": "resample='no' is no truth value",
    "mesh, max_iterations=2.5": "max_iterations=2.5 is no whole number",
    "mesh, max_iterations=2**40": "max_iterations=1099511627776 is too large",
    "mesh, max_iterations='x'": "max_iterations='x' is no whole number",
    "mesh, max_iterations=float('nan')": "max_iterations=nan is no whole number",
    "mesh, max_iterations=float('inf')": "max_iterations=inf is no whole number",
    "mesh, pole_method='x'": "pole_method='x' is none of 'voronoi', 'balls'.",
    "mesh, pole_method=-1": "pole_method=-1 is none of the choices, 0 to 1.",
    "mesh, repair=7": "repair=7 is none of the choices, 0 to 2.",
    "mesh, preset='old'": "preset='old' is none of",
    "mesh, w_m=-1": "w_m",
    "mesh.vertices[:, :2], mesh.faces": "vertices must have the shape (n, 3)",
    "mesh.vertices, mesh.faces + 1": "not one of the",
    "mesh.vertices, mesh.faces + 2**32": "faces is no array of numbers: ids must be between",
    "mesh.vertices, mesh.faces / 2": "ids must be integers",
    "np.empty((0, 3)), mesh.faces": "vertices is empty",
    "mesh.vertices, np.empty((0, 3), int)": "faces is empty",
    "5": "vertices and faces",
    "'none.off'": "There is no file 'none.off'",
    "'.'": "is a folder",
    "'a\\0.off'": "zero byte",
    "os.fsdecode(b'm\\xfc.off')": "is not UTF-8",
    "'none.npy', spacing=2": "There is no file 'none.npy'",
    "np.ones((3, 3, 3)), level='0.5'": "level='0.5' is no finite number",
    "np.ones((3, 3, 3)), level=float('-inf')": "level=-inf is no finite number",
    "'text.off'": "'text.off' cannot be read: Invalid file",
    "'text.ply'": "'text.ply' cannot be read: Header not found",
    "'text.xyzw'": "does not end like a mesh's: .off, .ply",
    "'mesh.off', mesh.faces": "faces must not be given",
}
SAVED = {
    "'x.json', scale=2": "'x.json': scale is for .swc only",
    "'x.glb', bone_tolerance='-1%'": "bone_tolerance='-1%' is not between",
    "5": "path=5 is no path",
    "None": "path=None is no path",
}
FILES = {
    "bad.swc": ("1 0 0 0 0 1 -1\n2 0 x 0 0 1 1\n", "Line 2"),
    "bad.xyz": ("", "does not end with"),
    "none.json": (None, "No such file"),
    "bad.json": ("{", "cannot be read"),
    "half.json": ('{"nodes": [{"id": 0}], "edges": []}', "'position' is missing"),
    "twice.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0], "surface_vertices": [1]},'
                   ' {"id": 1, "position": [1, 0, 0], "surface_vertices": [1]}], "edges": []}',
                   "belongs to two nodes"),
    "list.json": ("[1]", "cannot be read"),
    "null.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0]}], "edges": [], "graph": null}', "cannot be read"),
    "ragged.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0]}, {"id": 1, "position": [0]}], "edges": []}',
                    "cannot be read"),
    "radii.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0], "radius": [1, 2]}], "edges": []}',
                   "the radius of a node is more than one number"),
    "far.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0], "surface_vertices": [100000000000000]}],'
                 ' "edges": []}', "a surface vertex does not exist"),
    "huge.json": ('{"nodes": [{"id": 0, "position": [0, 0, 0], "surface_vertices": [1%s]}], "edges": []}'
                  % ("0" * 30), "out of range"),
    "deep.json": ("[" * 100_000, "cannot be read"),
    "far.vtp": ('<VTKFile><PolyData><Piece><Points><DataArray format="ascii">0 0 0 1 0 0</DataArray></Points><Lines>'
                '<DataArray Name="connectivity" format="ascii">0 1</DataArray>'
                '<DataArray Name="offsets" format="ascii">9 10</DataArray></Lines></Piece></PolyData></VTKFile>',
                "out of range"),
    "short.ply": ("ply\nformat binary_little_endian 1.0\ncomment mcfskel skeleton 1\nelement vertex\nend_header\n",
                  "cut short"),
    "bad.graphml": ("<graphml>", "cannot be read"),
    "bad.ply": ("ply\nend_header\n", "no PLY file of a skeleton"),
    "empty.cg": ("", "Line 1"),
}


def test_errors_are_one_sentence_with_the_cure(run, tmp_path):
    for name, (content, _) in FILES.items():
        if content is not None:
            (tmp_path / name).write_text(content)
    for name in ["text.off", "text.ply"]:
        (tmp_path / name).write_text("not a mesh")
    (tmp_path / "text.xyzw").write_text("not a mesh")
    calls = [f"mcfskel.skeletonize({arguments})" for arguments in ERRORS]
    calls += [f"mcfskel.load({name!r})" for name in [*FILES, 5]]
    calls += [f"skeleton.save({arguments})" for arguments in SAVED]
    calls += ["skeleton.branch_measures(sections='a')", "mcfskel.check_options(epsilon=-1)",
              "mcfskel.check_options(target_length=np.nan)", "skeleton.plot(backend=['x'])"]
    answer = run(f"""
        import mcfskel, os, trimesh
        mesh = trimesh.load(MESHES + "/torus.off", process=False)
        here = os.getcwd()
        skeleton = mcfskel.skeletonize(mesh, target_length="3%")
        answer = []
        for call in {calls}:
            try:
                eval(call)
                answer.append("no error")
            except mcfskel.SkeletonError as error:
                answer.append(str(error))
        answer += [os.getcwd() == here, len(mcfskel.skeletonize(mesh, target_length="1.5%").nodes)]
    """)
    words = [*ERRORS.values(), *(word for _, word in FILES.values()), "path=5 is no path", *SAVED.values(),
             "sections='a' is no whole number", "epsilon=-1 is no length", "target_length=nan is no length",
             "backend=['x'] is none of"]
    for call, text, word in zip(calls, answer, words):
        assert word in text and "\n" not in text, (call, text, word)
    assert answer[-2] is True
    assert answer[-1] > 0, "after all these errors the next mesh is done"


def test_a_package_that_is_missing_is_named_as_pip_knows_it(run):
    answer = run("""
        import importlib, mcfskel
        skeleton = mcfskel.skeletonize(MESHES + "/torus.off", target_length="3%")
        def none(name):
            raise ImportError(f"No module named {name!r}")
        importlib.import_module = none
        answer = []
        for action in [skeleton.plot, skeleton.to_navis]:
            try:
                action()
            except mcfskel.SkeletonError as error:
                answer.append(str(error))
    """)
    assert ["pip install matplotlib (" in answer[0], "pip install navis (" in answer[1]] == [True, True]


def test_voxels_and_points_go_through_the_same_door(run):
    """A torus as voxels, in a file, and as points with normals, as arrays and in a file: each one its circle."""
    answer = run("""
        import mcfskel
        grid = np.stack(np.meshgrid(*[np.arange(30)] * 3, indexing="ij"), axis=-1) - 14.5
        voxels = np.hypot(np.hypot(grid[..., 0], grid[..., 1]) - 9, grid[..., 2]) < 3.5
        np.savez("torus.npz", volume=voxels, spacing=[0.5, 0.5, 0.5], origin=[-7.25] * 3)
        turn, tilt = np.random.default_rng(1).random((2, 2000)) * 2 * np.pi
        normals = np.column_stack([np.cos(turn) * np.cos(tilt), np.sin(turn) * np.cos(tilt), np.sin(tilt)])
        points = 3 * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn]) + normals
        np.savetxt("torus.xyz", np.hstack([points, normals]))
        answer = []
        for made, scale in [(mcfskel.skeletonize(voxels, spacing=0.5), 4.5), (mcfskel.skeletonize("torus.npz"), 4.5),
                            (mcfskel.skeletonize(points, normals=normals), 3), (mcfskel.skeletonize("torus.xyz"), 3)]:
            nodes = made.nodes - made.nodes.mean(axis=0)
            away = np.hypot(np.hypot(nodes[:, 0], nodes[:, 1]) - scale, nodes[:, 2]).max() / scale
            answer.append([made.results["components"], made.results["cycles"], made.results["terminals"],
                           float(away), made.nodes.mean(axis=0).tolist()])
        for wrong in [lambda: mcfskel.skeletonize(voxels, level=2), lambda: mcfskel.skeletonize(points, spacing=1),
                      lambda: mcfskel.skeletonize(points, normals=0 * normals)]:
            try:
                wrong()
                answer.append("no error")
            except mcfskel.SkeletonError as error:
                answer.append(str(error))
    """)
    for components, cycles, terminals, away, _ in answer[:4]:
        assert (components, cycles, terminals) == (1, 1, 0)
        assert away < 0.05
    assert answer[0][4] == pytest.approx([7.25] * 3, abs=0.1)
    assert answer[1][4] == pytest.approx([0] * 3, abs=0.1)
    assert "level" in answer[4] and "voxels" in answer[5] and "normals" in answer[6]


def test_a_file_is_read_as_meshlab_reads_it(run):
    answer = run("""
        import mcfskel, pathlib, pymeshlab
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(MESHES + "/torus.off")
        mesh = layers.current_mesh()
        options = dict(target_length="1.5%", refine=False)
        s = mcfskel.skeletonize(pathlib.Path(MESHES, "torus.off"), **options)
        t = mcfskel.skeletonize(mesh.vertex_matrix(), mesh.face_matrix(), **options)
        answer = [bool(np.array_equal(s.nodes, t.nodes)), len(s.correspondence) == mesh.vertex_number(),
                  bool(np.array_equal(s.surface.vertices, mesh.vertex_matrix()))]
    """)
    assert answer == [True, True, True]


def test_a_mesh_is_where_its_node_of_a_scene_puts_it(run):
    answer = run("""
        import mcfskel, trimesh
        mesh = trimesh.load(MESHES + "/capsule.off", process=False)
        box = mesh.bounds
        answer = []
        for x in (10, -10):  # mirrored, too: it still faces outward
            place = np.diag([x, 10, 10, 1.0])
            place[:3, 3] = [100, 0, 0]
            scene = trimesh.Scene()
            scene.add_geometry(mesh, transform=place)
            scene.export("placed.glb")
            s = mcfskel.skeletonize("placed.glb", target_length="3%", repair="off")
            there = np.sort(trimesh.transform_points(box, place), axis=0)
            answer.append([bool(np.allclose([s.surface.vertices.min(axis=0), s.surface.vertices.max(axis=0)], there,
                                            atol=1e-3)),
                           bool(((s.nodes > there[0]) & (s.nodes < there[1])).all()),
                           float(s.radius.max() / (there[1] - there[0]).min())])
    """)
    for surface, inside, radius in answer:
        assert surface and inside and 0.4 < radius < 0.6


def test_reading_in_threads_leaves_the_folder_as_it_was(run):
    answer = run("""
        import os, shutil
        from concurrent.futures import ThreadPoolExecutor
        from mcfskel._run import SkeletonError, open_mesh
        for k in range(4):
            os.mkdir(str(k))
            shutil.copy(MESHES + "/torus.off", f"{k}/torus.off")
            open(f"{k}/bad.off", "w").write("no mesh")
        here = os.getcwd()

        def read(i):
            try:
                return open_mesh(f"{i % 4}/{'bad' if i % 2 else 'torus'}.off").mesh_number()
            except SkeletonError as error:
                return "no file" if "There is no file" in str(error) else "refused"

        with ThreadPoolExecutor(4) as threads:
            answer = sorted(set(map(str, threads.map(read, range(200)))))
        answer.append(os.getcwd() == here)
    """)
    assert answer == ["1", "refused", True]


def test_without_a_plugin_the_import_says_what_to_do(python, tmp_path):
    done = subprocess.run([str(python), "-c", "import mcfskel"], capture_output=True, text=True,
                          env=os.environ | {"MCFSKEL_PLUGIN": str(tmp_path / "none.so")})
    assert done.returncode != 0 and "pip install ./python" in done.stderr


def test_the_examples_of_the_docs_run(run):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), re.DOTALL)
    answer = run("\n".join(blocks).replace('"meshes/', 'MESHES + "/')
                 + "\nanswer = [len(skeleton.nodes), len(fine.nodes), len(again.nodes), len(graph)]")
    assert answer[0] == answer[2] == answer[3] < answer[1]
