# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that runs jobs on hostile meshes, one after the other, as hostile.py tells it to.

Reads one JSON object a line: {"family", "seed"} or {"file"} (a mesh as saved by hostile.py), "jobs",
"skip" (steps not to be run again), "full" (all steps, or the quick ones) and perhaps "only" (of the tools
this one). Answers with lines:

  {"begin": step}                          a filter is about to run: from now on the clock counts
  {"judging": step}                        it has ended
  {"end": step, "outcome", "findings", "seconds", "error"}
  {"done": true, "memory"}                 the mesh is finished; memory: MB that the process holds
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

import pymeshlab  # noqa: E402

from filter_names import (BALLS, COLLAPSE, COMPARE, FULL, LOAD_STAGE, MEASURE, MEDIAL_AXIS,  # noqa: E402
                          PARTS, POLES, PRUNE, REFINE, RESAMPLE, SAVE, SAVE_STAGE, SMOOTH, STEP)
from hostile import EITHER, REFUSED, Hostile, make  # noqa: E402
from hostile.primitives import compact, component_of_vertices, genus  # noqa: E402
from hostile_cases import read_case  # noqa: E402
from hostile_judge import (MEMORY, Finding, Judge, graph_components, message_findings,  # noqa: E402
                           numbers_findings)

ATTRIBUTES = ["mcfskel_pole_radius", "mcfskel_fixed", "mcfskel_held", "mcfskel_radius", "mcfskel_node",
              "mcfskel_kind", "mcfskel_part"]
MESH = "hostile"
TARGET_LENGTH = 0.03  # of the job that resamples; of the diagonal


class Stop(Exception):
    """The rest of the job has nothing to work on."""


def digest(array: np.ndarray) -> str:
    return hashlib.blake2b(np.ascontiguousarray(array).tobytes(), digest_size=12).hexdigest()


def scalars(mesh: pymeshlab.Mesh, name: str) -> np.ndarray | None:
    """The attribute of the vertices, if the layer has it."""
    try:
        return mesh.vertex_custom_scalar_attribute_array(name)
    except pymeshlab.PyMeshLabException:
        return None


def layer_state(mesh: pymeshlab.Mesh, attributes: bool) -> tuple:
    """A layer as it is; `attributes`: with everything that a filter that ran may have added."""
    state: list[Any] = [mesh.id(), mesh.label(), digest(mesh.vertex_matrix()), digest(mesh.face_matrix()),
                        digest(mesh.edge_matrix()), digest(mesh.transform_matrix())]
    if attributes:
        state += [mesh.is_visible(), mesh.selected_vertex_number(), mesh.selected_face_number()]
        if mesh.has_vertex_scalar():
            state.append(digest(mesh.vertex_scalar_array()))
        if mesh.has_vertex_color():
            state.append(digest(mesh.vertex_color_matrix()))
        for name in ATTRIBUTES:
            values = scalars(mesh, name)
            if values is not None:
                state.append((name, digest(values)))
        try:
            state.append(digest(mesh.vertex_custom_point_attribute_matrix("mcfskel_pole")))
        except pymeshlab.PyMeshLabException:
            pass
    return tuple(state)


def document_state(layers: pymeshlab.MeshSet, attributes: bool = True) -> tuple:
    """The document: its layers in order, and which is current."""
    return (layers.current_mesh_id() if attributes else -1,
            *(layer_state(mesh, attributes) for mesh in layers))


class Job:
    """One document, and the steps that are made in it."""

    def __init__(self, mesh: Hostile, judge: Judge, name: str, skip: set[str], full: bool,
                 only: str | None, answer: Callable[[dict[str, Any]], None]) -> None:
        self.mesh, self.judge, self.name, self.skip, self.full = mesh, judge, name, skip, full
        self.only = only
        self.failed = False  # has a filter?
        # The steps whose results are wrong: what follows from these is asked for less.
        self.wrong: set[str] = set()
        self.answer = answer
        self.layers = pymeshlab.MeshSet()
        # Something that no filter is told about, and that must stay as it is.
        self.layers.add_mesh(pymeshlab.Mesh(np.eye(4, 3), np.array([[0, 2, 1], [0, 1, 3]])), "bystander")
        try:
            self.layers.add_mesh(pymeshlab.Mesh(
                np.asarray(mesh.vertices, float).reshape(-1, 3),
                np.asarray(mesh.faces, np.int32).reshape(-1, 3)), MESH)
        except Exception as error:  # the host has refused the mesh: nothing reaches the plugin
            self.layers = None
            self.host_error = str(error)
            return
        self.surface = self.layers.current_mesh_id()

    def step(self, name: str, filter_name: str, judge: Callable[[dict[str, Any]], list[Finding]],
             may_refuse: bool = False, **parameters: Any) -> dict[str, Any]:
        """Runs one filter and judges it. @raise Stop if it has left nothing."""
        step = f"{self.name}/{name}" if name else self.name
        if step in self.skip:
            raise Stop
        expected = self.mesh.expected.answer
        if filter_name in (FULL, STEP, RESAMPLE):
            parameters = {"repair": "off"} | parameters  # what is refused is part of the answer
        before = document_state(self.layers)
        geometry = document_state(self.layers, attributes=False)
        labels = [mesh.label() for mesh in self.layers]
        error = results = None
        self.answer({"begin": step})
        start = time.process_time()
        try:
            results = self.layers.apply_filter(filter_name, **parameters)
        except pymeshlab.PyMeshLabException as caught:
            error = str(caught)
        except MemoryError as caught:
            error = f"MemoryError {caught}"
        seconds = time.process_time() - start
        self.answer({"judging": step})
        findings: list[Finding] = []
        if error is not None:
            details = error.split("Details: ", 1)[-1]  # without: the host itself has refused the layer
            if MEMORY.search(details):
                findings.append(("memory", details))
            findings += message_findings(details)
            self.failed = True
            if document_state(self.layers) != before:
                after = [mesh.label() for mesh in self.layers]
                findings.append(("document changed", f"{labels} before, {after} after an error"))
            if expected not in (REFUSED, EITHER) and not may_refuse:
                findings.append(("good refused", details))
            outcome = "refused"
        else:
            now = document_state(self.layers, attributes=False)[: len(geometry)]
            if now != geometry:
                findings.append(("document changed", "a layer that was there before"))
            findings += numbers_findings(results)
            if expected == REFUSED:
                findings.append(("accepted", f"by {filter_name}: {short(results)}"))
            else:
                try:
                    findings += judge(results)
                except Exception:
                    findings.append(("wrong", "cannot be judged: " + traceback.format_exc(limit=-2)))
            outcome = "right"
        if findings:
            self.wrong.add(name)
        self.answer({"end": step, "outcome": "failed" if findings else outcome,
                     "findings": findings, "seconds": seconds,
                     "error": error.split("Details: ", 1)[-1] if error is not None else None})
        if error is not None or expected == REFUSED:
            raise Stop
        return results

    def try_step(self, name: str, *arguments: Any, **parameters: Any) -> None:
        """A step after which the job goes on in any case."""
        if self.only and name != "refine" and f"{self.name}/{name}" != self.only:
            return
        try:
            self.step(name, *arguments, **parameters)
        except Stop:
            pass

    # What the steps leave, judged.

    def curve(self, results: dict[str, Any] | None = None, inside: bool = True,
              topology: bool = True) -> list[Finding]:
        mesh = self.layers.current_mesh()
        nodes, edges = mesh.vertex_matrix(), mesh.edge_matrix()
        surface = self.layers.mesh(self.surface)
        # Where the surface is resampled it is by nearest points, which may be another body's.
        node_of_vertex = scalars(surface, "mcfskel_node") if not any(
            layer.label().endswith("_resampled") for layer in self.layers) else None
        findings = self.judge.skeleton(nodes, edges, mesh.face_matrix(), node_of_vertex, inside, topology)
        if results and "skeleton_vertices" in results:
            if (int(results["skeleton_vertices"]), int(results["skeleton_edges"])) != (
                    len(nodes), len(edges)):
                findings.append(("wrong", "the numbers of nodes and edges returned"))
        radius = scalars(mesh, "mcfskel_radius")
        if radius is not None:
            if not np.isfinite(radius).all() or (radius < 0).any():
                findings.append(("not finite", "radius: not finite, or negative"))
        return findings

    def stage(self, _: dict[str, Any] | None = None) -> list[Finding]:
        """A surface or stage: within the bounding box, of the right topology."""
        mesh = self.layers.current_mesh()
        findings = self.judge.points(mesh.vertex_matrix(), "stage", self.margin())
        faces = mesh.face_matrix()
        if not findings and len(faces):
            vertices, faces = compact(mesh.vertex_matrix(), faces)
            count, _ = component_of_vertices(len(vertices), faces)
            expected = self.mesh.expected
            # A component of a stage may have become a curve, and has no faces then.
            if count > expected.components or (
                    count == expected.components and genus((vertices, faces)) > expected.genus):
                findings.append(("topology", f"stage: {count} components"))
        return findings

    def poles(self, results: dict[str, Any]) -> list[Finding]:
        mesh = self.layers.mesh(self.surface)
        radius = mesh.vertex_custom_scalar_attribute_array("mcfskel_pole_radius")
        pole = mesh.vertex_custom_point_attribute_matrix("mcfskel_pole")
        return self.judge.points(pole[radius >= 0], "poles", self.margin())

    def margin(self) -> float:
        """How far poles and stages may be beyond the bounding box, in diagonals. Balls of a part that is
        inside out, as there may be where a surface meets itself, are on its other side."""
        return 0.01 if self.mesh.expected.embedded else 1.0

    # The jobs.

    def run(self) -> None:
        if self.layers is None:
            step = f"{self.name}/host"
            outcome = "refused" if self.mesh.expected.answer == REFUSED else "failed"
            self.answer({"end": step, "outcome": outcome, "seconds": 0.0, "error": self.host_error,
                         "findings": [] if outcome == "refused" else [("good refused", self.host_error)]})
            return
        try:
            getattr(self, "job_" + self.name)()
        except Stop:
            pass

    def job_default(self) -> None:
        self.step("", FULL, self.curve)

    def job_raw(self) -> None:
        """As it is, unrefined; then the tools on it."""
        self.step("", FULL, self.curve, resample=False, refine=False)
        raw = self.layers.current_mesh_id()
        own = polyline_length(self.layers.current_mesh())
        self.try_step("refine", REFINE, self.curve, surface=self.surface)
        refined = self.layers.current_mesh_id()
        if refined != raw:
            self.try_step("compare", COMPARE, self.distances, other=raw, surface=self.surface)
        self.layers.set_current_mesh(refined)
        self.try_step("parts", PARTS, self.parts, surface=self.surface)
        if self.full:
            self.layers.set_current_mesh(refined)
            self.try_step("measure", MEASURE, self.measures, surface=self.surface)
            self.layers.set_current_mesh(refined)
            self.try_step("balls", BALLS, self.balls, surface=self.surface,
                          voxel=pymeshlab.PercentageValue(3))
        self.layers.set_current_mesh(raw)
        self.try_step("prune", PRUNE, lambda _: self.shorter(own), surface=self.surface,
                      min_length=pymeshlab.PercentageValue(5))
        self.layers.set_current_mesh(raw)
        self.try_step("smooth", SMOOTH, lambda _: self.shorter(own),
                      longest_edge=pymeshlab.PercentageValue(0.5))
        self.layers.set_current_mesh(raw)
        self.files()

    def job_sheets(self) -> None:
        self.step("", FULL, self.curve, keep_sheets=True, resample=False, refine=self.full)

    def job_sheets_default(self) -> None:
        self.step("", FULL, self.curve, keep_sheets=True)

    def job_steps(self) -> None:
        """The stages one by one; the last one saved, loaded and carried on."""
        self.step("poles", POLES, self.poles, pole_method="balls")
        self.try_step("medial_axis", MEDIAL_AXIS, lambda _: self.judge.points(
            self.layers.current_mesh().vertex_matrix(), "medial axis", self.margin()),
            may_refuse=True)  # a shape may have no pole with an angle of 60 degrees
        self.layers.set_current_mesh(self.surface)
        self.step("step", STEP, self.stage, steps=2)
        stage = self.layers.current_mesh().vertex_matrix()
        with tempfile.TemporaryDirectory() as folder:
            file = str(Path(folder) / "stage.ply")
            self.step("save_stage", SAVE_STAGE, lambda _: [], file=file)
            self.step("load_stage", LOAD_STAGE, lambda _: [] if np.array_equal(
                stage, self.layers.current_mesh().vertex_matrix()) else [
                    ("wrong", "a stage is not the same when it is read back")], file=file)
        self.try_step("on", STEP, self.stage, steps=10)
        self.step("collapse", COLLAPSE, self.curve)

    def job_voronoi(self) -> None:
        self.step("poles", POLES, self.poles, pole_method="voronoi")
        self.step("full", FULL, self.curve, pole_method="voronoi", resample=False)

    def job_resample(self) -> None:
        self.step("", RESAMPLE, self.resampled, target_length=pymeshlab.PercentageValue(100 * TARGET_LENGTH))

    # Judges of single tools.

    def resampled(self, results: dict[str, Any]) -> list[Finding]:
        findings = self.stage()
        # Each body is asked to be covered with triangles of a part of its own diagonal.
        asked = self.judge.relative_area / (np.sqrt(0.75) * TARGET_LENGTH**2)
        if int(results["vertices"]) > max(200_000, 4 * asked):
            findings.append(("explosion", f"{results['vertices']} vertices"))
        return findings

    def shorter(self, before: float) -> list[Finding]:
        """What prunes or smooths makes nothing much longer (junctions move), and keeps the topology."""
        if self.wrong & {""}:
            return []
        length = polyline_length(self.layers.current_mesh())
        findings = self.curve(inside=False)
        if not findings and length > 2 * before + 1e-12 * self.mesh.expected.extent:
            findings.append(("explosion", f"length {before:.4g} before, {length:.4g} after"))
        return findings

    def distances(self, results: dict[str, Any]) -> list[Finding]:
        values = [results[name] for name in ("distance_mean", "distance_max", "distance_mean_back",
                                             "distance_max_back")]
        if self.wrong & {"", "refine"}:
            return []
        bad = not all(0 <= value <= 1.001 for value in values)  # of the diagonal: both are inside
        return [("wrong", f"distances {values}")] if bad else []

    def parts(self, results: dict[str, Any]) -> list[Finding]:
        findings = []
        quality = self.layers.mesh(self.surface).face_scalar_array()
        branches = int(results["branches"])
        if not np.isfinite(quality).all() or quality.min() < -1 or quality.max() >= max(branches, 1):
            findings.append(("wrong", f"parts from {quality.min()} to {quality.max()}, "
                             f"{branches} branches"))
        return findings

    def measures(self, results: dict[str, Any]) -> list[Finding]:
        inside = results["inside_fraction"]
        if self.wrong & {"", "refine"}:
            return []
        if self.mesh.expected.embedded and inside < 0.999:
            return [("outside", f"inside_fraction {inside}")]
        return [] if 0 <= inside <= 1 else [("wrong", f"inside_fraction {inside}")]

    def balls(self, results: dict[str, Any]) -> list[Finding]:
        mesh = self.layers.current_mesh()
        if mesh.vertex_number() > 300_000:
            return [("explosion", f"{mesh.vertex_number()} vertices")]
        if self.wrong & {"", "refine"}:
            return []
        return self.judge.points(mesh.vertex_matrix(), "balls", margin=0.6)

    def files(self) -> None:
        """Each format written; those that are read, read back."""
        mesh = self.layers.current_mesh()
        skeleton = self.layers.current_mesh_id()
        nodes, edges = mesh.vertex_matrix(), mesh.edge_matrix()
        with tempfile.TemporaryDirectory() as folder:
            for form in ("swc", "cg", "graphml", "json", "ply"):
                file = Path(folder) / f"curve.{form}"
                self.layers.set_current_mesh(skeleton)
                self.try_step(f"save_{form}", SAVE, lambda _, file=file, form=form: self.read_back(
                    file, form, nodes, edges), file=str(file))

    def read_back(self, file: Path, form: str, nodes: np.ndarray, edges: np.ndarray) -> list[Finding]:
        if form == "json":
            graph = json.loads(file.read_text())
            got = np.array([node["position"] for node in graph["nodes"]], float)
            return [] if np.array_equal(got, nodes) and len(graph["edges"]) == len(edges) else [
                ("wrong", "json has other nodes or edges")]
        if form == "graphml":
            import networkx
            graph = networkx.read_graphml(file)
            return [] if (len(graph.nodes), graph.number_of_edges()) == (len(nodes), len(edges)) else [
                ("wrong", "graphml has other nodes or edges")]
        other = pymeshlab.MeshSet()
        if form == "ply":
            other.apply_filter(LOAD_STAGE, file=str(file))
        else:
            other.load_new_mesh(str(file))
        mesh = other.current_mesh()
        got, lines = mesh.vertex_matrix(), mesh.edge_matrix()
        if form == "swc":  # a forest, each node after its parent
            count, _ = graph_components(len(nodes), edges)
            same = np.array_equal(np.sort(got, axis=0), np.sort(nodes, axis=0)) and (
                len(lines) == len(nodes) - count)
        else:
            same = np.array_equal(got, nodes) and np.array_equal(lines, edges)
        return [] if same else [("wrong", f"{form} reads back otherwise")]


def polyline_length(mesh: pymeshlab.Mesh) -> float:
    nodes, edges = mesh.vertex_matrix(), mesh.edge_matrix()
    if not len(edges):
        return 0.0
    return float(np.linalg.norm(nodes[edges[:, 0]] - nodes[edges[:, 1]], axis=1).sum())


def short(results: dict[str, Any]) -> str:
    names = ("skeleton_vertices", "components", "cycles", "skeleton_length", "vertices", "poles")
    return ", ".join(f"{name} {results[name]:.6g}" for name in names if name in results)


def limit_memory(megabytes: int) -> None:
    """Lets this process have that much more address space than it has now."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * os.sysconf("SC_PAGE_SIZE") + megabytes * 2 ** 20
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))


def end_with_parent() -> None:
    """Whoever kills the one who reads the answers need not look for this process."""
    set_death_signal = 1
    ctypes.CDLL(None).prctl(set_death_signal, signal.SIGKILL)


def main() -> None:
    end_with_parent()
    plugin, megabytes = sys.argv[1], int(sys.argv[2])
    # What the host prints is not for the one who reads the answers.
    channel = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)

    def answer(message: dict[str, Any]) -> None:
        channel.write(json.dumps(message) + "\n")

    pymeshlab.load_plugin(plugin)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    alive = []  # documents in which a filter has failed have to outlive those that follow
    for line in sys.stdin:
        order = json.loads(line)
        mesh = read_case(Path(order["file"])) if "file" in order else make(order["family"], order["seed"])
        judge = Judge(mesh)
        for name in order["jobs"]:
            job = Job(mesh, judge, name, set(order["skip"]), order["full"], order.get("only"), answer)
            limit_memory(megabytes)
            job.run()
            if job.failed:
                alive.append(job.layers)
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        answer({"done": True, "memory": pages * os.sysconf("SC_PAGE_SIZE") // 2 ** 20})


if __name__ == "__main__":
    main()
