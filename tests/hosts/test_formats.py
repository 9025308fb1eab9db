# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons and stages in files: other programs read them, nothing is lost, bad files are refused."""

import json
import os
import re
import struct
import subprocess
import sys
import warnings

import morphio
import networkx
import numpy as np
import pymeshlab
import pytest
import trimesh
from plyfile import PlyData

from conftest import (COLLAPSE, FULL, MESHES, ROOT, STEP, attributes, document, labels, layer,
                      opened, scalars)

COARSE = {"target_length": pymeshlab.PercentageValue(1.2)}


@pytest.fixture(scope="module")
def plate():
    """The skeleton of the plate with three holes, and the document it is in."""
    layers = opened("plate3")
    results = layers.apply_filter(FULL, **COARSE)
    assert results["cycles"] == 3
    return layers, results


@pytest.fixture
def skeleton(plate):
    layers, _ = plate
    current = layer(layers, "plate3_skeleton")
    layers.set_current_mesh(current.id())
    return current


def sorted_edges(edges: np.ndarray) -> np.ndarray:
    edges = np.sort(np.asarray(edges).reshape(-1, 2), axis=1)
    return edges[np.lexsort((edges[:, 1], edges[:, 0]))]


def sources_of(surface: pymeshlab.Mesh) -> list[list[int]]:
    """For each node the surface vertices that belong to it."""
    node = scalars(surface, "mcfskel_node").astype(int)
    return [np.flatnonzero(node == n).tolist() for n in range(node.max() + 1)]


class TestSwc:
    def test_another_reader_finds_trees_with_the_same_nodes(self, plate, skeleton, tmp_path):
        layers, results = plate
        layers.save_current_mesh(str(tmp_path / "s.swc"))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            neuron = morphio.Morphology(str(tmp_path / "s.swc"))
        rows = np.loadtxt(tmp_path / "s.swc")
        assert len(rows) == results["skeleton_vertices"]
        # The reader keeps singles, and repeats each branching point in every section it begins.
        ours = {tuple(p) for p in np.float32(skeleton.vertex_matrix())}
        assert {tuple(p) for p in neuron.points} == ours
        tips = sum(not section.children for section in neuron.iter())
        degree = np.bincount(skeleton.edge_matrix().ravel())
        assert tips <= (degree == 1).sum() + 2 * results["cycles"]
        radius = scalars(skeleton, "mcfskel_radius")
        assert neuron.diameters.max() == pytest.approx(2 * radius.max(), rel=1e-6)

    def test_ids_in_order_and_each_cycle_cut_once(self, plate, skeleton, tmp_path):
        layers, results = plate
        path = tmp_path / "s.swc"
        layers.save_current_mesh(str(path))
        rows = np.loadtxt(path)
        assert np.array_equal(rows[:, 0], np.arange(1, len(rows) + 1))
        assert (rows[:, 6] < rows[:, 0]).all()
        assert (rows[:, 6] == -1).sum() == results["components"]
        text = path.read_text()
        cuts = [line.split()[-2:] for line in text.splitlines() if line.startswith("# cycle cut")]
        assert len(cuts) == results["cycles"] == 3
        tree = networkx.Graph((int(r[0]), int(r[6])) for r in rows if r[6] >= 0)
        tree.add_edges_from((int(a), int(b)) for a, b in cuts)
        assert tree.number_of_edges() == results["skeleton_edges"]
        original = networkx.Graph(skeleton.edge_matrix().tolist())
        assert networkx.faster_could_be_isomorphic(tree, original)

    def test_the_cuts_are_warned_about(self, tmp_path, plugin):
        script = (
            "import pymeshlab, sys\n"
            "pymeshlab.load_plugin(sys.argv[1])\n"
            "layers = pymeshlab.MeshSet(verbose=True)\n"
            "layers.load_new_mesh(sys.argv[2])\n"
            "layers.save_current_mesh(sys.argv[3])\n")
        (tmp_path / "ring.cg").write_text(
            "# D:3 NV:3 NE:3\nv 0 0 0\nv 1 0 0\nv 0 1 0\ne 1 2\ne 2 3\ne 3 1\n")
        run = subprocess.run(
            [sys.executable, "-c", script, str(plugin),
             str(tmp_path / "ring.cg"), str(tmp_path / "ring.swc")],
            capture_output=True, text=True, check=True)
        assert "a cycle was cut between the nodes" in run.stdout + run.stderr

    def test_read(self, plate, skeleton, tmp_path):
        layers, _ = plate
        layers.save_current_mesh(str(tmp_path / "s.swc"))
        again = pymeshlab.MeshSet()
        again.load_new_mesh(str(tmp_path / "s.swc"))
        mesh = again.current_mesh()
        assert {tuple(p) for p in mesh.vertex_matrix()} == {
            tuple(p) for p in skeleton.vertex_matrix()}
        assert sorted(scalars(mesh, "mcfskel_radius")) == sorted(scalars(skeleton, "mcfskel_radius"))
        assert mesh.edge_number() == skeleton.edge_number() - 3
        assert mesh.vertex_scalar_array() == pytest.approx(scalars(mesh, "mcfskel_radius"))
        # Coloured by it, as a new skeleton is: red where it is thickest.
        red, _, blue, _ = mesh.vertex_color_matrix()[mesh.vertex_scalar_array().argmax()]
        assert mesh.has_vertex_color() and red > 0.9 and blue < 0.2

    def test_a_file_from_elsewhere(self, tmp_path):
        (tmp_path / "neuron.swc").write_text(
            "# a soma and two neurites\n1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 9 0 .5 2\n4 2 0 -6 0 1 1\n")
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(str(tmp_path / "neuron.swc"))
        assert np.array_equal(sorted_edges(layers.current_mesh().edge_matrix()),
                              [[0, 1], [0, 3], [1, 2]])
        assert scalars(layers.current_mesh(), "mcfskel_radius").tolist() == [5, 1, 0.5, 1]


    @pytest.mark.parametrize("soma", ["none", "auto", "thickest"])
    def test_one_root_a_component_and_one_soma_for_morphio(self, tmp_path, soma):
        """A ball with a stalk beside a body of its own: two components, one of them with a soma."""
        (tmp_path / "cell.swc").write_text("".join(
            f"{i} 0 {i} 0 0 {8 if i == 1 else 1} {i - 1 if i > 1 else -1}\n" for i in range(1, 20))
            + "20 0 0 90 0 1 -1\n21 0 9 90 0 1 20\n")
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(str(tmp_path / "cell.swc"))
        path = tmp_path / "s.swc"
        layers.apply_filter("save_skeleton_mcf", file=str(path), soma=soma, scale=1000.0, units="nm")
        rows = np.loadtxt(path)
        assert "lengths in nm, mesh units times 1000" in path.read_text()
        assert (rows[:, 6] == -1).sum() == 2
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            neuron = morphio.Morphology(str(path))
        if soma == "none":
            assert (rows[:, 1] == 0).all()
            assert neuron.soma_type == morphio.SomaType.SOMA_UNDEFINED
        else:
            assert rows[rows[:, 1] == 1].tolist() == [[1, 1, 1000, 0, 0, 8000, -1]]
            assert neuron.soma_type == morphio.SomaType.SOMA_SINGLE_POINT
            assert neuron.soma.diameters.tolist() == [16000]
            assert {s.type for s in neuron.iter()} == {morphio.SectionType.basal_dendrite}
        assert neuron.points[:, 0].max() == 19000


class TestCg:
    def test_round_trip_is_exact(self, plate, skeleton, tmp_path):
        layers, _ = plate
        path = tmp_path / "s.cg"
        layers.save_current_mesh(str(path))
        assert path.read_text().splitlines()[0] == (
            f"# D:3 NV:{skeleton.vertex_number()} NE:{skeleton.edge_number()}")
        again = pymeshlab.MeshSet()
        again.load_new_mesh(str(path))
        assert np.array_equal(again.current_mesh().vertex_matrix(), skeleton.vertex_matrix())
        assert np.array_equal(sorted_edges(again.current_mesh().edge_matrix()),
                              sorted_edges(skeleton.edge_matrix()))

    def test_another_reader(self, plate, skeleton, tmp_path):
        plate[0].save_current_mesh(str(tmp_path / "s.cg"))
        rows = [line.split() for line in (tmp_path / "s.cg").read_text().splitlines()[1:]]
        nodes = np.array([row[1:] for row in rows if row[0] == "v"], float)
        graph = networkx.parse_edgelist([" ".join(row[1:]) for row in rows if row[0] == "e"],
                                        nodetype=int)
        assert np.array_equal(nodes, skeleton.vertex_matrix())
        assert np.array_equal(sorted_edges(np.array(list(graph.edges)) - 1),
                              sorted_edges(skeleton.edge_matrix()))


class TestGraphs:
    """GraphML and JSON, both read by networkx."""

    def check(self, graph: networkx.Graph, positions: np.ndarray, plate, skeleton,
              sources: list[list[int]]) -> None:
        layers, _ = plate
        assert np.array_equal(positions, skeleton.vertex_matrix())
        nodes = [graph.nodes[n] for n in graph]
        assert [n["radius"] for n in nodes] == scalars(skeleton, "mcfskel_radius").tolist()
        edges = sorted_edges(np.array(list(graph.edges), int))
        assert np.array_equal(edges, sorted_edges(skeleton.edge_matrix()))
        lengths = sum(data["length"] for _, _, data in graph.edges(data=True))
        assert lengths == pytest.approx(plate[1]["skeleton_length"])
        surface = layer(layers, graph.graph["surface"])
        expected = sources_of(surface)
        assert sources[:len(expected)] == expected
        assert not any(sources[len(expected):])
        assert sum(map(len, sources)) == surface.vertex_number()

    def test_graphml(self, plate, skeleton, tmp_path):
        plate[0].save_current_mesh(str(tmp_path / "s.graphml"))
        graph = networkx.read_graphml(tmp_path / "s.graphml", node_type=int)
        positions = np.array([[d["x"], d["y"], d["z"]] for _, d in graph.nodes(data=True)])
        sources = [list(map(int, (d["surface_vertices"] or "").split()))
                   for _, d in graph.nodes(data=True)]
        self.check(graph, positions, plate, skeleton, sources)

    def test_json(self, plate, skeleton, tmp_path):
        plate[0].apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.json"))
        content = json.loads((tmp_path / "s.json").read_text())
        graph = networkx.node_link_graph(content, edges="edges")
        positions = np.array([d["position"] for _, d in graph.nodes(data=True)])
        sources = [d["surface_vertices"] for _, d in graph.nodes(data=True)]
        self.check(graph, positions, plate, skeleton, sources)
        assert content["graph"]["cycles"] == 3

    def test_json_in_export_is_the_hosts(self, plugin, tmp_path):
        """As it is without the plugin, to the last byte and with the same parameters."""
        script = ("import pymeshlab, sys\n"
                  "mesh, file, plugin = sys.argv[1:]\n"
                  "if plugin:\n"
                  "    pymeshlab.load_plugin(plugin)\n"
                  "layers = pymeshlab.MeshSet()\n"
                  "layers.load_new_mesh(mesh)\n"
                  "layers.compute_normal_per_vertex()\n"
                  "layers.save_current_mesh(file + '.json')\n"
                  "layers.save_current_mesh(file + '_bare.json', save_vertex_normal=False)\n"
                  "layers.generate_simplified_point_cloud(samplenum=9)\n"
                  "layers.save_current_mesh(file + '_points.json')\n")
        for name, path in [("with", str(plugin)), ("without", "")]:
            subprocess.run([sys.executable, "-c", script, str(MESHES / "box8.off"),
                            str(tmp_path / name), path], check=True, stdout=subprocess.DEVNULL)
        for kind in ["", "_bare", "_points"]:
            ours = (tmp_path / f"with{kind}.json").read_bytes()
            assert ours == (tmp_path / f"without{kind}.json").read_bytes()
            assert b"MeshLab JSON Exporter" in ours

    def test_source_vertices_of_a_layer_of_choice(self, plate, skeleton, tmp_path):
        layers, _ = plate
        layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.json"), surface=0)
        content = json.loads((tmp_path / "s.json").read_text())
        assert content["graph"]["surface"] == layers.mesh(0).label()
        sources = [node["surface_vertices"] for node in content["nodes"]]
        expected = sources_of(layers.mesh(0))
        assert sources[:len(expected)] == expected


class Posed:
    """A .glb read by itself: its surface, its joints, and the surface as they move it."""

    def __init__(self, path) -> None:
        content = path.read_bytes()
        magic, version, size, json_size, kind = struct.unpack_from("<4sIII4s", content)
        assert (magic, version, size, kind) == (b"glTF", 2, len(content), b"JSON")
        self.gltf = json.loads(content[20:20 + json_size])
        self.binary = content[28 + json_size:]
        primitive = self.gltf["meshes"][0]["primitives"][0]
        of = primitive["attributes"]
        self.vertices, self.joints, self.weights = (
            self.array(of[name]) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
        self.faces = self.array(primitive["indices"]).reshape(-1, 3)
        skin = self.gltf["skins"][0]
        self.skin_joints = skin["joints"]
        self.inverse = self.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)

    def array(self, index: int) -> np.ndarray:
        accessor = self.gltf["accessors"][index]
        view = self.gltf["bufferViews"][accessor["bufferView"]]
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor["type"]]
        values = np.frombuffer(self.binary, kind, accessor["count"] * width, view["byteOffset"])
        return values.reshape(-1, width) if width > 1 else values

    def matrices(self, turned: dict[int, np.ndarray]) -> np.ndarray:
        """Of all nodes, with some of them turned in place."""
        nodes = self.gltf["nodes"]
        result = np.zeros((len(nodes), 4, 4))

        def place(node: int, above: np.ndarray) -> None:
            local = np.eye(4)
            local[:3, 3] = nodes[node].get("translation", [0, 0, 0])
            local[:3, :3] = turned.get(node, np.eye(3))
            result[node] = above @ local
            for child in nodes[node].get("children", []):
                place(child, result[node])

        for node in self.gltf["scenes"][0]["nodes"]:
            place(node, np.eye(4))
        return result

    def posed(self, turned: dict[int, np.ndarray]) -> np.ndarray:
        of_joint = self.matrices(turned)[self.skin_joints] @ self.inverse
        blend = np.einsum("vk,vkij->vij", self.weights, of_joint[self.joints])
        return np.einsum("vij,vj->vi", blend, np.column_stack([self.vertices, np.ones(len(self.vertices))])
                         )[:, :3]


@pytest.fixture(scope="module")
def limbs(tmp_path_factory):
    """The armature of an animal: eight limbs and a body."""
    layers = opened("animal450")
    layers.apply_filter(FULL)
    path = tmp_path_factory.mktemp("glb") / "animal.glb"
    layers.apply_filter("save_skeleton_mcf", file=str(path), surface=0)
    return layers, Posed(path)


class TestGlb:
    def test_the_surface_is_that_of_the_layer(self, limbs):
        layers, armature = limbs
        assert np.array_equal(armature.vertices, np.float32(layers.mesh(0).vertex_matrix()))
        assert np.array_equal(armature.faces, layers.mesh(0).face_matrix())

    def test_another_reader_finds_the_surface(self, limbs, tmp_path):
        layers, armature = limbs
        layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "a.glb"), surface=0)
        mesh = trimesh.load(tmp_path / "a.glb", force="mesh", process=False)
        assert mesh.is_watertight and len(mesh.vertices) == len(armature.vertices)

    def test_at_rest_nothing_moves(self, limbs):
        layers, armature = limbs
        size = np.ptp(armature.vertices, axis=0).max()
        assert np.abs(armature.posed({}) - armature.vertices).max() < 1e-5 * size

    def test_no_vertex_is_left_behind(self, limbs):
        """Whatever moves all roots moves every vertex, and weights add up to one."""
        _, armature = limbs
        assert np.allclose(armature.weights.sum(axis=1), 1, atol=1e-6)
        assert armature.joints.max() < len(armature.skin_joints)
        turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        nodes = armature.gltf["nodes"]
        root, = (n for n in nodes if n["name"] == "armature")
        moved = armature.posed({child: turn for child in root["children"]})
        centre = armature.matrices({})[root["children"][0]][:3, 3]
        expected = (armature.vertices - centre) @ turn.T + centre
        assert np.abs(moved - expected).max() < 1e-4 * np.ptp(armature.vertices, axis=0).max()

    @pytest.mark.parametrize("surface", ["opened", "resampled"])
    def test_a_bone_that_turns_bends_the_surface_smoothly(self, limbs, surface, tmp_path):
        """Each joint in turn by 45 degrees: no edge of the surface is torn, nothing far away moves."""
        layers, armature = limbs
        if surface == "resampled":
            layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "r.glb"))
            armature = Posed(tmp_path / "r.glb")
            assert len(armature.vertices) != layers.mesh(0).vertex_number()
        c = np.sqrt(0.5)
        edges = np.unique(np.sort(armature.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        lengths = np.linalg.norm(np.subtract(*armature.vertices[edges].transpose(1, 0, 2)), axis=1)
        size = np.ptp(armature.vertices, axis=0).max()
        moving = 0
        for joint in armature.skin_joints:
            for turn in ([[c, -c, 0], [c, c, 0], [0, 0, 1]], [[1, 0, 0], [0, c, -c], [0, c, c]]):
                posed = armature.posed({joint: np.array(turn)})
                after = np.linalg.norm(np.subtract(*posed[edges].transpose(1, 0, 2)), axis=1)
                assert (after / lengths).max() < 4
            moving += bool((np.linalg.norm(posed - armature.vertices, axis=1) > 1e-3 * size).any())
        assert moving > len(armature.skin_joints) / 2

    def test_without_its_surface_it_cannot_be(self, tmp_path):
        layers = pymeshlab.MeshSet()
        (tmp_path / "s.cg").write_text("# D:3 NV:2 NE:1\nv 0 0 0\nv 1 0 0\ne 1 2\n")
        layers.load_new_mesh(str(tmp_path / "s.cg"))
        with pytest.raises(pymeshlab.PyMeshLabException, match="surface"):
            layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.glb"))
        assert not (tmp_path / "s.glb").exists()


class TestPly:
    def test_edges_radius_and_correspondence(self, plate, skeleton, tmp_path):
        layers, _ = plate
        layers.apply_filter("save_stage_mcf", file=str(tmp_path / "s.ply"))
        ply = PlyData.read(str(tmp_path / "s.ply"))
        positions = np.column_stack([ply["vertex"][axis] for axis in "xyz"])
        assert np.array_equal(positions, skeleton.vertex_matrix())
        edges = np.column_stack([ply["edge"]["vertex1"], ply["edge"]["vertex2"]])
        assert np.array_equal(sorted_edges(edges), sorted_edges(skeleton.edge_matrix()))
        assert np.array_equal(ply["vertex"]["mcfskel_radius"], scalars(skeleton, "mcfskel_radius"))
        assert set(ply["mcfskel_surface"]["node"]) <= set(range(skeleton.vertex_number()))

    def test_the_host_reads_the_edges(self, plate, skeleton, tmp_path):
        plate[0].apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.ply"))
        again = pymeshlab.MeshSet()
        again.load_new_mesh(str(tmp_path / "s.ply"))
        assert again.current_mesh().edge_number() == skeleton.edge_number()

    def test_load_stage_gives_the_skeleton_back(self, plate, skeleton, tmp_path):
        plate[0].apply_filter("save_stage_mcf", file=str(tmp_path / "mine.ply"))
        again = pymeshlab.MeshSet()
        results = again.apply_filter("load_stage_mcf", file=str(tmp_path / "mine.ply"))
        assert results["cycles"] == 3
        assert labels(again) == ["mine"]
        assert np.array_equal(again.current_mesh().vertex_matrix(), skeleton.vertex_matrix())
        assert np.array_equal(scalars(again.current_mesh(), "mcfskel_radius"),
                              scalars(skeleton, "mcfskel_radius"))

    def test_a_stage_is_a_mesh_to_others(self, tmp_path):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=3)
        stage = layers.current_mesh()
        layers.apply_filter("save_stage_mcf", file=str(tmp_path / "stage.ply"))
        mesh = trimesh.load(tmp_path / "stage.ply", process=False)
        assert np.array_equal(mesh.vertices, stage.vertex_matrix())
        assert np.array_equal(mesh.faces, stage.face_matrix())
        ply = PlyData.read(str(tmp_path / "stage.ply"))
        assert np.array_equal(ply["vertex"]["mcfskel_pole_radius"],
                              scalars(stage, "mcfskel_pole_radius"))
        assert np.array_equal(ply["mcfskel_surface"]["node"],
                              scalars(layers.mesh(0), "mcfskel_node"))


CARRY_ON = """
import sys
import numpy as np
import pymeshlab
plugin, stage, surface, result = sys.argv[1:]
pymeshlab.load_plugin(plugin)
layers = pymeshlab.MeshSet()
if surface:
    layers.load_new_mesh(surface)
layers.apply_filter("load_stage_mcf", file=stage)
layers.apply_filter("generate_meso_skeleton_mcf", steps=2)
stage = layers.current_mesh()
label = stage.label()
layers.apply_filter("generate_curve_skeleton_from_meso_mcf")
curve = layers.current_mesh()
scalar = "vertex_custom_scalar_attribute_array"
np.savez(result, label=label, vertices=stage.vertex_matrix(), faces=stage.face_matrix(),
         fixed=getattr(stage, scalar)("mcfskel_fixed"), poles=getattr(stage, scalar)("mcfskel_pole_radius"),
         nodes=curve.vertex_matrix(), edges=curve.edge_matrix(),
         radius=getattr(curve, scalar)("mcfskel_radius"),
         node=getattr(layers.mesh(0), scalar)("mcfskel_node") if surface else [])
"""


class TestStageOverARestart:
    @pytest.mark.parametrize("with_surface", [True, False])
    @pytest.mark.parametrize("mesh", ["animal450", "torus"])
    def test_steps_in_a_new_process_are_the_same_bits(self, tmp_path, plugin, mesh, with_surface):
        layers = opened(mesh)
        layers.apply_filter(STEP, steps=3)
        saved = layers.apply_filter("save_stage_mcf", file=str(tmp_path / f"{mesh}_meso_3.ply"))
        assert saved["iterations"] == 3
        layers.apply_filter(STEP, steps=2)
        stage = layers.current_mesh()
        layers.apply_filter(COLLAPSE)
        curve = layers.current_mesh()

        surface = str(MESHES / f"{mesh}.off") if with_surface else ""
        subprocess.run([sys.executable, "-c", CARRY_ON, str(plugin), str(tmp_path / f"{mesh}_meso_3.ply"),
                        surface, str(tmp_path / "result.npz")], check=True)
        other = np.load(tmp_path / "result.npz")
        assert str(other["label"]) == stage.label() == f"{mesh}_meso_5"
        for name, mine in [("vertices", stage.vertex_matrix()), ("faces", stage.face_matrix()),
                           ("fixed", scalars(stage, "mcfskel_fixed")),
                           ("poles", scalars(stage, "mcfskel_pole_radius")),
                           ("nodes", curve.vertex_matrix()), ("edges", curve.edge_matrix()),
                           ("radius", scalars(curve, "mcfskel_radius"))]:
            assert other[name].tobytes() == np.ascontiguousarray(mine).astype(other[name].dtype).tobytes(), name
        if with_surface:
            assert np.array_equal(other["node"], scalars(layers.mesh(0), "mcfskel_node"))

    def test_the_surface_gets_its_correspondence_again(self, tmp_path):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=2)
        layers.apply_filter("save_stage_mcf", file=str(tmp_path / "t.ply"))
        node = scalars(layers.mesh(0), "mcfskel_node")
        again = opened("torus")
        again.apply_filter("load_stage_mcf", file=str(tmp_path / "t.ply"))
        assert np.array_equal(scalars(again.mesh(0), "mcfskel_node"), node)
        other = opened("animal450")
        other.apply_filter("load_stage_mcf", file=str(tmp_path / "t.ply"))
        assert "mcfskel_node" not in attributes(other.mesh(0)), "another mesh is not its surface"


class TestRefusals:
    """Bad files and wrong layers: one clear error, the document as it was."""

    @pytest.mark.parametrize("name, content, words", [
        ("a.swc", "1 0 0 0 0 1 -1\n2 0 x 0 0 1 1\n", "Line 2"),
        ("b.swc", "1 0 0 0 0 1 -1\n2 0 1 0 0 1 7\n", "Line 2: parent 7 does not exist"),
        ("c.swc", "# nothing\n", "no nodes"),
        ("d.cg", "v 0 0 0\n", "Line 1"),
        ("e.cg", "# D:3 NV:2 NE:1\nv 0 0 0\nv 0 0 nan\ne 1 2\n", "Line 3"),
        ("f.cg", "# D:3 NV:2 NE:1\nv 0 0 0\nv 0 0 1\n", "the file ends after 0 of 1 edges"),
    ])
    def test_malformed(self, tmp_path, name, content, words):
        (tmp_path / name).write_text(content)
        layers = opened("torus")
        folder = os.getcwd()
        with pytest.raises(pymeshlab.PyMeshLabException, match=words):
            layers.load_new_mesh(str(tmp_path / name))
        os.chdir(folder)
        assert labels(layers) == ["torus.off"]

    def test_stages_cut_short(self, tmp_path):
        layers = opened("torus")
        layers.apply_filter(STEP)
        path = tmp_path / "stage.ply"
        layers.apply_filter("save_stage_mcf", file=str(path))
        content = path.read_bytes()
        for size in [0, 3, 100, len(content) // 2, len(content) - 1]:
            path.write_bytes(content[:size])
            with pytest.raises(pymeshlab.PyMeshLabException, match="Line|Byte"):
                layers.apply_filter("load_stage_mcf", file=str(path))
        assert layers.mesh_number() == 2

    def test_wrong_layers(self, tmp_path):
        layers = opened("torus")
        for name in ["s.swc", "s.cg", "s.graphml"]:
            with pytest.raises(pymeshlab.PyMeshLabException, match="has faces"):
                layers.save_current_mesh(str(tmp_path / name))
        with pytest.raises(pymeshlab.PyMeshLabException, match="neither a stage"):
            layers.apply_filter("save_stage_mcf", file=str(tmp_path / "s.ply"))
        cloud = document((np.eye(3), np.empty((0, 3))))
        with pytest.raises(pymeshlab.PyMeshLabException, match="no edges"):
            cloud.save_current_mesh(str(tmp_path / "s.swc"))
        assert not list(tmp_path.iterdir())

    def test_files_that_cannot_be(self, plate, skeleton, tmp_path):
        layers, _ = plate
        with pytest.raises(pymeshlab.PyMeshLabException, match="must end with"):
            layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.xyz"))
        with pytest.raises(pymeshlab.PyMeshLabException, match="must name the file"):
            layers.apply_filter("save_skeleton_mcf")
        with pytest.raises(pymeshlab.PyMeshLabException, match="Cannot write"):
            layers.save_current_mesh(str(tmp_path / "nowhere" / "s.swc"))
        with pytest.raises(pymeshlab.PyMeshLabException, match="Cannot read"):
            pymeshlab.MeshSet().apply_filter("load_stage_mcf", file=str(tmp_path / "none.ply"))

    def test_an_edited_skeleton_is_written_as_it_is(self, tmp_path):
        layers = opened("capsule")
        layers.apply_filter(FULL, **COARSE)
        layers.compute_matrix_from_translation(axisx=5.0)
        moved = layers.current_mesh().vertex_matrix()
        layers.save_current_mesh(str(tmp_path / "s.cg"))
        rows = [line.split()[1:] for line in (tmp_path / "s.cg").read_text().splitlines()
                if line.startswith("v ")]
        assert np.array_equal(np.array(rows, float), moved)


def test_the_examples_of_the_docs_run(plugin, tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "formats.md").read_text(), re.DOTALL)
    script = "\n".join(blocks).replace('"PLUGIN"', repr(str(plugin))).replace(
        '"meshes/', f'"{MESHES}/')
    script += "\nassert graph.graph['cycles'] == 3"
    script += "\nassert layers.current_mesh().label() == 'animal_meso_5'\n"
    run = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
