# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hundreds of jobs in one process: memory, errors that are caught, threads. Each in a process of its own,
since what goes wrong there may end it."""

import json
import subprocess
import sys
import textwrap

import numpy as np
import pymeshlab
import pytest

from conftest import COLLAPSE, FULL, MESHES, POLES, STEP, attributes, labels, layer, opened

PRELUDE = """
import gc, json, sys, threading
import numpy as np
import pymeshlab
pymeshlab.load_plugin(sys.argv[1])
PATH = sys.argv[2] + "/animal450.off"
loaded = pymeshlab.MeshSet()
loaded.load_new_mesh(PATH)
V, F = loaded.current_mesh().vertex_matrix(), loaded.current_mesh().face_matrix()
SHORT = dict(resample=False, denoise=False, refine=False, max_iterations=4)

def opened(faces=F, **options):
    layers = pymeshlab.MeshSet(**options)
    layers.add_mesh(pymeshlab.Mesh(V, faces), "mesh")
    return layers

def failing(layers, name="generate_curve_skeleton_mcf", **parameters):
    try:
        layers.apply_filter(name, **parameters)
    except pymeshlab.PyMeshLabException as error:
        assert "Details: " in str(error)
        return 1
    raise AssertionError(name + " did not fail")

def resident():
    gc.collect()
    with open("/proc/self/status") as lines:
        return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024
"""


@pytest.fixture
def run(plugin, tmp_path):
    """Runs a script after the prelude; returns what it left in `answer`."""
    def run_script(script: str):
        text = PRELUDE + textwrap.dedent(script) + "\nprint('ANSWER' + json.dumps(answer))\n"
        done = subprocess.run([sys.executable, "-c", text, str(plugin), str(MESHES)], cwd=tmp_path,
                              capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, f"{done.returncode}: {done.stderr}"
        return json.loads(done.stdout.rpartition("ANSWER")[2])
    return run_script


class TestMemory:
    """After 1000 jobs no more than 20 MB beyond what 50 take; here on 130, in proportion."""

    JOBS = {
        "new documents": """
            def job():
                opened().apply_filter("generate_curve_skeleton_mcf", keep_stages=2, **SHORT)
        """,
        "resampled and refined": """
            def job():
                opened().apply_filter("generate_curve_skeleton_mcf", target_length=pymeshlab.PercentageValue(8))
        """,
        "one document, cleared": """
            layers = pymeshlab.MeshSet()
            def job():
                layers.clear()
                layers.add_mesh(pymeshlab.Mesh(V, F), "mesh")
                layers.apply_filter("generate_curve_skeleton_mcf", **SHORT)
        """,
        "one document, layers deleted": """
            layers = opened()
            def job():
                layers.set_current_mesh(0)
                layers.apply_filter("generate_curve_skeleton_mcf", **SHORT)
                while layers.mesh_number() > 1:
                    layers.set_current_mesh(max(mesh.id() for mesh in layers))
                    layers.delete_current_mesh()
        """,
        "stage by stage": """
            def job():
                layers = opened()
                layers.apply_filter("compute_medial_poles_mcf", create_layer=True)
                layers.set_current_mesh(0)
                layers.apply_filter("generate_meso_skeleton_mcf", steps=2)
                layers.apply_filter("generate_curve_skeleton_from_meso_mcf")
                layers.apply_filter("generate_pruned_skeleton_mcf")
        """,
        "stages from files": """
            layers = opened()
            layers.apply_filter("generate_meso_skeleton_mcf", steps=2)
            layers.apply_filter("save_stage_mcf", file="stage.ply")
            def job():
                layers = opened()
                layers.apply_filter("load_stage_mcf", file="stage.ply")
        """,
        "errors": """
            def job():
                failing(opened(F[1:]), repair="off")
                layers = opened()
                failing(layers, "generate_meso_skeleton_mcf", w_l=0.0)
                layers.apply_filter("generate_meso_skeleton_mcf")
                failing(layers, "compute_medial_poles_mcf")
        """,
    }

    @pytest.mark.parametrize("kind", JOBS)
    def test_does_not_grow(self, run, kind):
        first, last = run(textwrap.dedent(self.JOBS[kind]) + textwrap.dedent("""
            for _ in range(30):
                job()
            first = resident()
            for _ in range(100):
                job()
            answer = [first, resident()]
        """))
        assert last - first <= 20 * 100 / 950


class TestAttributesOfLiveLayers:
    """What a layer shows stays with it, whatever becomes of the layer that it was made from."""

    def test_of_a_copy(self):
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        expected = attributes(layers.current_mesh())
        layers.add_mesh(layers.current_mesh(), "copy")
        copy = layers.current_mesh_id()
        layers.set_current_mesh(layer(layers, "capsule_meso_2").id())
        layers.delete_current_mesh()
        layers.apply_filter("create_cube")
        found = attributes(layers.mesh(copy))
        assert expected.keys() == found.keys() and len(expected) >= 4
        for name, values in expected.items():
            assert np.array_equal(found[name], values), name

    def test_of_a_surface_whose_stages_are_deleted(self):
        layers, untouched = opened("capsule"), opened("capsule")
        layers.apply_filter(POLES)
        poles = attributes(layers.current_mesh())
        layers.apply_filter(STEP, steps=3)
        while layers.mesh_number() > 1:
            layers.set_current_mesh(max(mesh.id() for mesh in layers))
            layers.delete_current_mesh()
        for name, values in poles.items():
            assert np.array_equal(attributes(layers.current_mesh())[name], values), name
        for document in (layers, untouched):
            document.apply_filter(FULL, resample=False, refine=False)
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              untouched.current_mesh().vertex_matrix())

    def test_vertices_removed_from_a_stage(self):
        """Attributes follow the vertices; the stage is none any more."""
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        before = attributes(layers.current_mesh())["mcfskel_radius"]
        x = layers.current_mesh().vertex_matrix()[:, 0]
        middle = float(np.median(x))
        layers.compute_selection_by_condition_per_vertex(condselect=f"x > {middle!r}")
        layers.meshing_remove_selected_vertices()
        rest = layers.current_mesh()
        assert 0 < rest.vertex_number() < len(x)
        kept = attributes(rest)["mcfskel_radius"]
        assert len(kept) == rest.vertex_number() and np.isin(kept, before).all()
        with pytest.raises(pymeshlab.PyMeshLabException, match="were changed"):
            layers.apply_filter(COLLAPSE)

    def test_cleared_while_others_live(self):
        first, second = opened("capsule"), opened("capsule")
        for document in (first, second):
            document.apply_filter(STEP, steps=2)
        first.clear()
        second.apply_filter(STEP)
        second.apply_filter(COLLAPSE)
        assert labels(second)[-1] == "capsule_skeleton"


class TestAfterErrors:
    """A script catches the error, drops the document, and goes on, a hundred times."""

    @pytest.mark.parametrize("verbose", [False, True])
    def test_document_dropped(self, run, verbose):
        errors, length = run(f"""
            errors, lengths = 0, set()
            for i in range(100):
                layers = opened(F[1:], verbose={verbose})
                errors += failing(layers, repair="off")
                del layers
                gc.collect()
                junk = [bytearray(b"\\xff" * size) for size in range(200, 4000, 50)]
                layers = pymeshlab.MeshSet()
                layers.load_new_mesh(PATH)
                errors += failing(layers, "generate_meso_skeleton_mcf", w_l=0.0)
                layers = pymeshlab.MeshSet()
                layers.load_new_mesh(PATH)
                layers.meshing_invert_face_orientation()
                layers.apply_filter("compute_medial_poles_mcf")
                errors += failing(layers, "save_stage_mcf", file="x.ply")
                layers.save_current_mesh("surface.ply")
                if i % 10 == 0:
                    numbers = layers.apply_filter("generate_curve_skeleton_mcf", **SHORT)
                    lengths.add(numbers["skeleton_length"])
            answer = [errors, list(lengths)]
        """)
        assert errors == 300
        assert len(length) == 1 and length[0] > 0

    def test_failed_saving(self, run):
        """Of a verbose document, whose log the plugin would write into."""
        assert run("""
            count = 0
            for _ in range(100):
                layers = pymeshlab.MeshSet(verbose=True)
                layers.add_mesh(pymeshlab.Mesh(V, edge_matrix=np.array([[0, 1], [1, 2], [2, 0]])), "c")
                try:
                    layers.save_current_mesh("no such folder/c.swc")
                except pymeshlab.PyMeshLabException:
                    count += 1
                del layers
                gc.collect()
                junk = [bytearray(b"\\xff" * size) for size in range(200, 4000, 50)]
                layers = pymeshlab.MeshSet()
                layers.add_mesh(pymeshlab.Mesh(V[:3], edge_matrix=np.array([[0, 1], [1, 2], [2, 0]])), "c")
                layers.save_current_mesh("c.swc")  # warns: a cycle is cut
            answer = count
        """) == 100

    def test_messages_are_still_printed(self, plugin, tmp_path):
        """Of a document that prints them, after others have failed."""
        script = PRELUDE + textwrap.dedent("""
            failing(opened(F[1:]), repair="off")
            opened(verbose=True).apply_filter("compute_medial_poles_mcf")
        """)
        done = subprocess.run([sys.executable, "-c", script, str(plugin), str(MESHES)],
                              capture_output=True, text=True, timeout=120)
        assert done.returncode == 0
        assert "Checking the surface    [" in done.stderr and "poles = 450" in done.stderr


    def test_pymeshlab_still_prints(self, plugin):
        """What it writes itself, after two filters of one document have failed."""
        script = PRELUDE + textwrap.dedent("""
            layers = opened(F[1:])
            failing(layers, repair="off")
            failing(layers, "generate_meso_skeleton_mcf", repair="off")
            layers.print_status()
        """)
        done = subprocess.run([sys.executable, "-c", script, str(plugin), str(MESHES)],
                              capture_output=True, text=True, timeout=120)
        assert done.returncode == 0
        assert "Number meshes: 1" in done.stdout


class TestThreads:
    def test_errors_among_them(self, run):
        """Four threads, each with documents of its own, a third of whose jobs fail."""
        errors, lengths = run("""
            errors, lengths = [], []

            def work(number):
                for i in range(12):
                    if (i + number) % 3 == 0:
                        errors.append(failing(opened(F[1:]), repair="off"))
                    else:
                        numbers = opened().apply_filter("generate_curve_skeleton_mcf", **SHORT)
                        lengths.append(numbers["skeleton_length"])

            threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            answer = [sum(errors), lengths]
        """)
        assert errors == 16
        assert len(lengths) == 32 and len(set(lengths)) == 1
