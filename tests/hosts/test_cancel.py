# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancel: at whatever report of progress it comes, the document stays as it was."""

import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from conftest import MESHES
from host_programs import host

PREFIX = "Mean Curvature Skeleton: "
STEPS = {
    "stage by stage": ("bent_tube", [
        ("Resample", {"target_length": ("RichFloat", 0.08)}), ("Medial Poles", {}),
        ("Contraction Step", {"steps": ("RichInt", 2)}),
        ("Contraction Step", {"steps": ("RichInt", 40)}), ("Collapse to Curve", {}),
        ("Refine Skeleton", {}), ("Save Skeleton", {"file": ("RichSaveFile", "FOLDER/s.json")}),
        ("Save Skeleton", {"file": ("RichSaveFile", "FOLDER/s.glb")}),
        ("Prune Skeleton", {}), ("Resample and Smooth Skeleton", {}),
        ("Compare Skeletons", {"other": ("RichMesh", 1)}), ("Measure Skeleton", {}),
        ("Parts of the Surface", {}), ("Medial Balls", {})]),
    "poles by balls": ("bent_tube", [
        ("Medial Poles", {"pole_method": ("RichEnum", 1)}), ("Medial Axis", {})]),
    "files": ("bent_tube", [
        ("Contraction Step", {"steps": ("RichInt", 2)}),
        ("Save Stage", {"file": ("RichSaveFile", "FOLDER/s.ply")}),
        ("Load Stage", {"file": ("RichOpenFile", "FOLDER/s.ply")})]),
    "tubes": ("bent_tube", [
        ("Contraction Step", {"steps": ("RichInt", 40)}), ("Collapse to Curve", {}),
        ("Skeleton to Tubes", {})]),
    "solid": ("bent_tube", [("Make Solid", {})]),
    "project": ("bent_tube", [
        ("Contraction Step", {"steps": ("RichInt", 40)}), ("Collapse to Curve", {}),
        ("Save Project", {"file": ("RichSaveFile", "FOLDER/p.mlp")}),
        ("Save Project", {"file": ("RichSaveFile", "FOLDER/new.mlp")})]),
    "at once": ("bent_tube", [("Full Skeletonize", {})]),
    "stages kept": ("bent_tube", [("Full Skeletonize", {"keep_stages": ("RichInt", 1)})]),
    "sheets": ("slab", [("Full Skeletonize", {"keep_sheets": ("RichBool", "true")})]),
}


def script(filters: list[tuple[str, dict]], path: Path) -> Path:
    tree = ElementTree.Element("FilterScript")
    for name, parameters in filters:
        step = ElementTree.SubElement(tree, "filter", name=PREFIX + name)
        for parameter, (kind, value) in parameters.items():
            ElementTree.SubElement(step, "Param", name=parameter, type=kind,
                                   value=str(value).replace("FOLDER", str(path.parent)),
                                   exts_cardinality="0")
    path.write_text("<!DOCTYPE FilterScript>\n" + ElementTree.tostring(tree, encoding="unicode"))
    return path


@pytest.mark.parametrize("name", STEPS)
def test_nothing_is_changed(name, tmp_path):
    meshlab = host("meshlab-2025.07")
    mesh, filters = STEPS[name]
    (tmp_path / "p_layers").mkdir()
    for file in ["s.json", "s.glb", "s.ply", "p.mlp", "p_layers/bent_tube.ply", "p_layers/other.ply"]:
        (tmp_path / file).write_text("what was there before")
    run = subprocess.run(
        [meshlab.plugin.parents[1] / "tests/hosts/run_script",
         meshlab.folder / "bin/plugins/libio_base.so", meshlab.plugin,
         script(filters, tmp_path / "script.mlx"), MESHES / f"{mesh}.off", "--cancel"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    assert run.returncode == 0, run.stdout[-2000:]
    cancelled = [line.removeprefix(PREFIX).rpartition(": ")
                 for line in run.stdout.splitlines() if line.startswith(PREFIX)]
    assert [step for step, _, _ in cancelled] == [step for step, _ in filters]
    counts = [(step, int(count)) for step, _, count in cancelled]
    assert all(count > 0 for step, count in counts if step != "Save Skeleton")
    # A skeleton is written at once, but for the weights of a .glb file.
    assert [count > 0 for step, count in counts if step == "Save Skeleton"] in ([], [False, True])
    assert not list(tmp_path.rglob(".mcfskel-*"))
