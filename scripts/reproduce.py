#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes Table 1 and the figures of the paper again: see reproduce_options.py."""

from __future__ import annotations

import argparse
import datetime
import hashlib
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts" / "bench"))
sys.path.insert(0, str(ROOT / "scripts"))

from curve import Curve, read_curve  # noqa: E402
from document import fill  # noqa: E402
from meshes import read_mesh, write_mesh  # noqa: E402
from meshgen.thin import THIN  # noqa: E402
from paper_figures import PALE, RED, Mesh, Panel, draw_rows  # noqa: E402
from quality import Shape, distance_to_medial_axis, measure  # noqa: E402
from reproduce_options import parse_arguments  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402
from tables import markdown, number  # noqa: E402

SPACING = 0.001
#: What judges a result: when any of it changes, results are judged again.
JUDGES = (Path(__file__).resolve(), *(ROOT / f"scripts/bench/{name}.py" for name in ("curve", "meshes", "quality")))
SHEET = np.array([86, 180, 233]) / 255
# Table 1 of the paper: vertices; its distances to its reference, of ATC08 and of the paper.
PAPER = {"cuboid": ("Cuboid", 37_000, 0.02820, 0.00449), "animal": ("Dragon", 72_000, 0.01589, 0.00769),
         "hand": ("Hand", 35_000, 0.01027, 0.00476), "letters": ("SGP", 60_000, 0.03067, 0.00381),
         "embrace": ("Fertility", 36_000, 0.01202, 0.00447)}
# Fig. 5: iterations by w_L, at w_H = 20 and w_M = 0.
PAPER_ITERATIONS = {1.5: 26, 3: 12, 6: 6, 12: 3, 24: 2}
# What `paper` has otherwise than `default`, one by one; without the refinement, which hides much of it.
UNREFINED = ("--no-refine",)
SWITCHES = {
    "default": (),
    "no refinement": UNREFINED,
    "Voronoi poles": (*UNREFINED, "--pole-method", "voronoi"),
    "noise is not smoothed": (*UNREFINED, "--no-denoise"),
    "the same lengths everywhere": (*UNREFINED, "--no-adaptive"),
    "no coarsening": (*UNREFINED, "--no-coarsen"),
    "w_L in the published unit": (*UNREFINED, "--cotangent-factor", "1"),
    "outward poles pull": (*UNREFINED, "--keep-outward-poles"),
    "direct solver": (*UNREFINED, "--direct-solver"),
    "the curve as collapsed": (*UNREFINED, "--no-tidy"),
    "all of them: paper": ("--preset", "paper"),
}
QUICK_VERTICES = 4_000
QUICK_AXIS, AXIS = 8_000, 40_000
FLAT = ("slab", "plate3", "cup", "twin_ears")  # of meshes/, in the table of steady states


class Work:
    """Runs the programs, keeps what they said, and shows how far all of it is."""

    def __init__(self, program: Path, folder: Path, steps: int) -> None:
        self.program, self.folder, self.steps = program, folder, steps
        self.done = 0
        self.begin = time.monotonic()
        folder.mkdir(parents=True, exist_ok=True)

    def show(self, what: str) -> None:
        part = min(1.0, self.done / self.steps)
        bar = "#" * round(24 * part)
        seconds = time.monotonic() - self.begin
        end = "\r" if sys.stderr.isatty() else "\n"
        print(f"[{bar:<24}] {100 * part:3.0f} % {seconds:5.0f} s  {what:<40.40}", end=end, file=sys.stderr, flush=True)

    def kept(self, what: str, key: tuple, source: Path | tuple[Path, ...], make: Callable[[Path], dict]) -> dict:
        """What make(path) returned, now or in an earlier run with the same source: the files that make() depends on.

        path: what the names of the files begin with that it may write.
        """
        self.show(what)
        sources = [digest(file) for file in ([source] if isinstance(source, Path) else source)]
        name = hashlib.sha256(repr((sources, key)).encode()).hexdigest()[:16]
        report = self.folder / f"{name}.json"
        if not report.exists():
            found = make(self.folder / name)
            unfinished = report.with_suffix(".part")
            unfinished.write_text(json.dumps(found))
            unfinished.rename(report)
        self.done += 1
        return {**json.loads(report.read_text()), "path": self.folder / name}

    def run(self, what: str, mesh: Path, *options: str) -> dict:
        """The program's report on a mesh; its files are PATH.obj, PATH_surface.ply and PATH_stage.ply."""
        def make(path: Path) -> dict:
            files = ["--surface", f"{path}_surface.ply"]
            if "--resample-only" not in options:
                files += ["--skeleton", f"{path}.obj", "--stage", f"{path}_stage.ply"]
            return report_of([str(self.program), str(mesh), *files, *options])

        return self.kept(what, (digest(mesh), options), self.program, make)

    def peer(self, name: str, what: str, mesh: Path) -> dict:
        """The report of atc08 or ds06; its skeleton is PATH.obj."""
        program = ROOT / f"scripts/bench/{name}.py"
        return self.kept(what, (name, digest(mesh)), program, lambda path: report_of(
            [sys.executable, str(program), str(mesh), "--skeleton", f"{path}.obj"]))


def report_of(command: list[str]) -> dict:
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"ended with status {done.returncode}"]
        raise SystemExit(f"error: {' '.join(command)}: {said[-1]}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def seconds(report: dict, *phases: str) -> str:
    return " + ".join(number(report["seconds"][phase]["cpu"], 2) for phase in phases)


def diagonal(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def percent_for(mesh: Path, vertices: int) -> str:
    """The edge length, percent of the diagonal, at which even triangles have so many vertices."""
    points, triangles = read_mesh(mesh)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    parts = trimesh.graph.connected_components(
        np.vstack([triangles[:, :2], triangles[:, 1:]]), nodes=np.unique(triangles))
    size = np.mean([diagonal(points[part]) for part in parts])  # lengths are of each component's own
    return f"{100 * math.sqrt(area / vertices * 2 / math.sqrt(3)) / size:.4g}"


def letters(folder: Path) -> Path:
    """The letters S, G and P side by side, one mesh."""
    path = folder / "letters.ply"
    places, faces, right, count = [], [], 0.0, 0
    for name in "sgp":
        points, triangles = read_mesh(ROOT / f"meshes/letter_{name}.off")
        points = points - points.min(axis=0) + [right, 0, 0]
        right = points[:, 0].max() + 0.1 * np.ptp(points[:, 0])
        places.append(points)
        faces.append(triangles + count)
        count += len(points)
    return write_mesh(path, np.vstack(places), np.vstack(faces))


class Reference:
    """The exact medial axis of a mesh, and where it is given another curve to compare with."""

    def __init__(self, mesh: Path, samples: int, other: Path | None = None) -> None:
        self.shape = Shape.read(mesh)
        self.axis = self.shape.medial_axis(samples)
        self.other = None
        if other:
            curve = read_curve(other).transformed(self.shape.origin, self.shape.diagonal)
            self.other = np.vstack([curve.sampled(SPACING)[0], curve.points])

    def distances(self, curve: Curve) -> dict[str, float]:
        """To the reference and back, over the diagonal of the mesh and over that of the reference."""
        unit = curve.transformed(self.shape.origin, self.shape.diagonal)
        samples, lengths = unit.sampled(SPACING)
        there = distance_to_medial_axis(self.shape, self.axis, samples)
        ours = cKDTree(np.vstack([samples, unit.points]))
        back = ours.query(self.axis)[0]
        found = {"there": float((there * lengths).sum() / lengths.sum()), "back": float(back.mean())}
        if self.other is not None:
            near = cKDTree(self.other).query(samples)[0]
            found |= {"to": float((near * lengths).sum() / lengths.sum()), "unit": diagonal(self.other),
                      "from": float(ours.query(self.other)[0].mean())}
        return found | measure(self.shape, self.axis, curve)


def size_of(options: argparse.Namespace, paper: int) -> int:
    """How many vertices a mesh gets that has so many in the paper."""
    if options.vertices:
        return options.vertices
    return QUICK_VERTICES if options.quick else paper


def table_1(work: Work, shapes: dict[str, Path], options: argparse.Namespace) -> tuple[str, dict]:
    """The table, and for each shape the mesh and the curves of Fig. 8."""
    head = ["shape", "vertices", "method", "seconds", "to DS06", "of its box", "paper", "back", "to the axis", "back",
            "inside", "tips", "turning"]
    body, found = [], {}
    ratios = {(of, method): [] for of in ("to", "there") for method in ("paper", "default")}
    for name, source in shapes.items():
        paper = PAPER.get(name)
        vertices = size_of(options, paper[1] if paper else 36_000)
        even = work.run(f"{name}: resampling", source, "--resample-only", "--no-denoise", "--no-adaptive",
                        "--target-length", percent_for(source, vertices))
        mesh = Path(f"{even['path']}_surface.ply")
        runs = {"DS06": work.peer("ds06", f"{name}: DS06", mesh),
                "ATC08": work.peer("atc08", f"{name}: ATC08", mesh),
                "paper": work.run(f"{name}: paper", mesh, "--preset", "paper", "--no-resample"),
                "default": work.run(f"{name}: default", mesh)}
        reference: list[Reference] = []

        def judged(path: Path) -> dict:
            if not reference:
                reference.append(Reference(mesh, QUICK_AXIS if options.quick else AXIS,
                                           Path(f"{runs['DS06']['path']}.obj")))
            np.save(f"{path}.npy", reference[0].axis * reference[0].shape.diagonal + reference[0].shape.origin)
            return {n: reference[0].distances(read_curve(Path(f"{r['path']}.obj"))) for n, r in runs.items()}

        curves = [digest(Path(f"{run['path']}.obj")) for run in runs.values()]
        result = work.kept(f"{name}: distances", ("judged", digest(mesh), *curves, options.quick), JUDGES,
                           judged)
        phases = {"DS06": ("geodesic", "erosion"), "ATC08": ("contraction", "conversion"),
                  "paper": ("poles", "contraction", "conversion"),
                  "default": ("resample", "poles", "contraction", "conversion", "refine")}
        theirs = {"ATC08": f"{paper[2]:.5f}", "paper": f"{paper[3]:.5f}"} if paper else {}
        for method, run in runs.items():
            r = result[method]
            body.append([name, str(run["vertices"]), method, seconds(run, *phases[method]),
                         *(["-"] * 4 if method == "DS06" else
                           [f"{r['to']:.5f}", f"{r['to'] / r['unit']:.5f}", theirs.get(method, "-"), f"{r['from']:.5f}"]),
                         f"{r['there']:.5f}", f"{r['back']:.5f}", f"{r['inside']:.3f}", str(r["tips"]),
                         number(r["turning"], 2)])
        for (of, method), ratio in ratios.items():
            ratio.append(result["ATC08"][of] / result[method][of])
        found[name] = (mesh, {n: Path(f"{r['path']}.obj") for n, r in runs.items()},
                       np.load(f"{result['path']}.npy"))
    times = {key: f"{number(min(ratio), 2)} to {number(max(ratio), 2)}" for key, ratio in ratios.items()}
    return (markdown(head, body) + f"\n\nATC08's distance to DS06 is {times['to', 'paper']} times that of `paper` (in "
            f"the paper: 2.1 to 8.0), and {times['to', 'default']} times that of `default`; to the axis "
            f"{times['there', 'paper']} and {times['there', 'default']} times.", found)


def curve_of(path: Path) -> tuple[np.ndarray, np.ndarray]:
    curve = read_curve(path)
    return curve.points, curve.simple_edges


def coloured(mesh: Mesh, colour: np.ndarray) -> tuple[Mesh, np.ndarray]:
    return mesh, np.tile(colour, (len(mesh[1]), 1))


def with_sheets(path: Path) -> tuple[Mesh, tuple[np.ndarray, np.ndarray]]:
    """The sheets of a skeleton in a file, and its curves."""
    faces = [[int(x) - 1 for x in line.split()[1:]] for line in path.read_text().splitlines()
             if line.startswith("f ")]
    points, edges = curve_of(path)
    return (points, np.array(faces, int).reshape(-1, 3)), (points, edges)


def stage_panel(work: Work, mesh: Path, surface: Mesh | None, iterations: int, *options: str) -> Panel:
    run = work.run(f"stage {iterations}", mesh, "--max-iterations", str(iterations), "--no-refine", *options)
    stage = read_mesh(Path(f"{run['path']}_stage.ply"))
    count = run["iterations"]
    return Panel(f"after {count} iteration{'s' * (count > 1)}", surface, [coloured(stage, PALE * 1.3)], lines=True)


def figure_1(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> None:
    mesh, curves, axis = found["hand"]
    surface = read_mesh(mesh)
    stage = stage_panel(work, mesh, surface, 6, "--preset", "paper", "--no-resample")
    stage.title, stage.lines = "(c) meso-skeleton", False
    draw_rows(folder / "figure_1.png", [(surface[0], [
        Panel("(a) surface", opaque=[coloured(surface, PALE * 1.3)]), Panel("(b) medial axis", surface, points=axis),
        stage, Panel("(d) curve skeleton", surface, curves=[curve_of(curves["default"])])], {})])


def figure_2(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> None:
    source = read_mesh(ROOT / "meshes/hand.off")
    mesh, curves, axis = found["hand"]
    surface = read_mesh(mesh)
    paper = ("--preset", "paper", "--no-resample")
    stages = [stage_panel(work, mesh, None, k, *paper) for k in (1, 3, 6, 500)]
    stages[-1].title = "(e) the last stage"
    draw_rows(folder / "figure_2.png", [
        (source[0], [Panel("(a) input", opaque=[coloured(source, PALE * 1.3)], lines=True),
                     Panel("(b) resampled", opaque=[coloured(surface, PALE * 1.3)], lines=True),
                     Panel("(c) medial axis", surface, points=axis), stages[0]], {}),
        (source[0], [*stages[1:], Panel("(f) curve", surface, curves=[curve_of(curves["paper"])])], {})])


def figure_3(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> None:
    source = ROOT / "meshes/cup.off"
    even = work.run("cup: resampling", source, "--resample-only", "--no-denoise", "--no-adaptive", "--target-length",
                    percent_for(source, size_of(options, 20_000)))
    mesh = Path(f"{even['path']}_surface.ply")
    surface = read_mesh(mesh)
    theirs = work.peer("atc08", "cup: ATC08", mesh)
    ours = work.run("cup: curve", mesh)
    sheets = work.run("cup: sheets", mesh, "--keep-sheets")
    faces, curve = with_sheets(Path(f"{sheets['path']}.obj"))
    used, numbered = np.unique(curve[1], return_inverse=True)  # without the nodes of the sheets
    lines = (curve[0][used], numbered.reshape(-1, 2))
    panels = [Panel("ATC08", surface, curves=[curve_of(Path(f"{theirs['path']}.obj"))]),
              Panel("default", surface, curves=[curve_of(Path(f"{ours['path']}.obj"))]),
              Panel("keep_sheets", surface, [coloured(faces, SHEET)], curves=[lines])]
    draw_rows(folder / "figure_3.png", [(surface[0], panels, {"up": "z"})])


def figure_5(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> str:
    """Fig. 5, and its table: iterations by w_L."""
    given = [p for p in options.meshes if p.stem == "elephant"]
    sources = [*given, ROOT / "meshes/animal.off"]
    weights = [1.5, 6, 24] if options.quick else list(PAPER_ITERATIONS)
    body, panels = [], []
    for source in sources:
        surface = read_mesh(source)
        for w in weights:
            run = work.run(f"{source.stem}: w_L {w:g}", source, "--preset", "paper", "--no-resample", "--w-m", "0",
                           "--w-l", f"{w:g}")
            ours = work.run(f"{source.stem}: w_L {w:g}", source, "--no-refine", "--no-resample", "--w-m", "0",
                            "--w-l", f"{w:g}")
            body.append([source.stem, str(run["input_vertices"]), f"{w:g}", str(PAPER_ITERATIONS[w]),
                         str(run["iterations"]), str(ours["iterations"]), number(run["skeleton_length"] / diagonal(surface[0]))])
            if source is sources[0]:
                panels.append(Panel(f"w_L {w:g}: {run['iterations']} iterations", surface,
                                    curves=[curve_of(Path(f"{run['path']}.obj"))]))
    draw_rows(folder / "figure_5.png", [(read_mesh(sources[0])[0], panels, {})])
    return markdown(["mesh", "vertices", "w_L", "iterations in Fig. 5", "paper", "default's flow", "length of the curve / diagonal"], body)


def figure_6(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> str:
    """The gallery, and what a smaller w_M leaves."""
    names = ["animal", "twin_ears", "head", "knot"] if options.quick else [
        "animal", "twin_ears", "head", "knot", "tree", "horn", "torus_capsule", "letter_g"]
    gallery = []
    for name in names:
        source = ROOT / f"meshes/{name}.off"
        run = work.run(f"{name}: gallery", source)
        gallery.append((name, read_mesh(source), curve_of(Path(f"{run['path']}.obj"))))
    for name, surface, curve in gallery:
        draw_rows(folder / "figure_6" / f"{name}.png", [(surface[0], [Panel(name, surface, curves=[curve])], {})])
    join(folder / "figure_6.png", [folder / "figure_6" / f"{name}.png" for name, _, _ in gallery])
    body = []
    sources = [p for p in options.meshes if p.stem == "elephant"] or [ROOT / "meshes/animal.off"]
    for source in sources:
        for w in (20, 40) if options.quick else (10, 20, 40, 80):
            row = [source.stem, str(w)]
            for preset in (("--preset", "paper", "--no-resample"), ("--no-resample", "--no-refine")):
                run = work.run(f"{source.stem}: w_M {w}", source, *preset, "--w-m", str(w))
                row += [str(run["terminals"]), number(run["skeleton_length"] / diagonal(read_mesh(source)[0]))]
            body.append(row)
    return markdown(["mesh", "w_M", "tips, paper", "length / diagonal", "tips, default unrefined", "length / diagonal"], body)


def join(path: Path, pictures: list[Path]) -> None:
    """Pictures in rows of four, one below the other; the parts are removed."""
    import io

    from PIL import Image

    from whole_file import write_whole
    images = [Image.open(p).convert("RGB") for p in pictures]
    rows = [images[k:k + 4] for k in range(0, len(images), 4)]
    width = max(sum(i.width for i in row) for row in rows)
    heights = [max(i.height for i in row) for row in rows]
    sheet = Image.new("RGB", (width, sum(heights)), "white")
    for k, row in enumerate(rows):
        left = 0
        for image in row:
            sheet.paste(image, (left, sum(heights[:k]) + (heights[k] - image.height) // 2))
            left += image.width
    content = io.BytesIO()
    sheet.quantize(192).save(content, format="PNG", optimize=True)
    write_whole(path, content.getvalue())
    for p in pictures:
        p.unlink()
    pictures[0].parent.rmdir()


def figure_7(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> None:
    source = ROOT / "meshes/slab.off"
    points, _ = read_mesh(source)
    noisy = noisy_copy(source, work.folder, 0.001)
    surface = read_mesh(noisy)

    def axis(path: Path) -> dict:
        shape = Shape.read(noisy)
        np.save(f"{path}.npy", shape.medial_axis(QUICK_AXIS) * shape.diagonal + shape.origin)
        return {}

    at = work.kept("slab: medial axis", ("axis", digest(noisy)), JUDGES, axis)
    sheets = work.run("slab: sheets", noisy, "--keep-sheets")
    curve = work.run("slab: curve", noisy)
    faces, _ = with_sheets(Path(f"{sheets['path']}.obj"))
    draw_rows(folder / "figure_7.png", [(points, [
        Panel("noisy medial axis", surface, points=np.load(f"{at['path']}.npy")),
        Panel("keep_sheets", surface, [coloured(faces, RED)]),
        Panel("curve", surface, curves=[curve_of(Path(f"{curve['path']}.obj"))])], {"up": "z"})])


def figure_8(work: Work, found: dict, folder: Path, options: argparse.Namespace) -> None:
    rows = []
    for name, (mesh, curves, axis) in found.items():
        surface = read_mesh(mesh)
        for angles in [{}, {"turn": 0, "tilt": 88}] if name == "letters" else [{}]:
            panels = [Panel(f"{name}: ATC08", surface, curves=[curve_of(curves["ATC08"])]),
                      Panel("DS06", surface, curves=[curve_of(curves["DS06"])]),
                      Panel("medial axis", surface, points=axis),
                      Panel("paper", surface, curves=[curve_of(curves["paper"])]),
                      Panel("default", surface, curves=[curve_of(curves["default"])])]
            rows.append((surface[0], panels, angles))
    draw_rows(folder / "figure_8.png", rows)


def noisy_copy(source: Path, folder: Path, part: float) -> Path:
    """A mesh with Gaussian noise on every coordinate, so large a part of the diagonal; made once."""
    path = folder / f"{source.stem}_noisy.ply"
    if not path.exists():
        points, triangles = read_mesh(source)
        bumps = np.random.default_rng(0).normal(size=points.shape) * part * diagonal(points)
        write_mesh(path, points + bumps, triangles)
    return path


def switches(work: Work, options: argparse.Namespace) -> str:
    """Means over some shapes for each switch of the preset alone. Against the clean shapes."""
    names = ["animal", "hand"] if options.quick else ["animal", "hand", "head", "tree", "letter_g"]
    clean = [ROOT / f"meshes/{name}.off" for name in names]
    meshes = [(path, path) for path in [*clean, *options.meshes]]
    meshes.append((noisy_copy(clean[0], work.folder, 0.002), clean[0]))
    shapes: dict[Path, Reference] = {}
    body = []
    for title, flags in SWITCHES.items():
        rows = []
        for mesh, of in meshes:
            run = work.run(f"{mesh.stem}: {title}", mesh, "--target-length", "1.2" if options.quick else "0.8", *flags)
            path = Path(f"{run['path']}.obj")

            def judged(_: Path) -> dict:
                if of not in shapes:
                    shapes[of] = Reference(of, QUICK_AXIS)
                return measure(shapes[of].shape, shapes[of].axis, read_curve(path))

            found = work.kept(f"{mesh.stem}: {title}", ("switch", digest(path), digest(of)), JUDGES, judged)
            rows.append({**found, "iterations": run["iterations"], "contraction": run["seconds"]["contraction"]["cpu"]})
        mean = {key: float(np.mean([row[key] for row in rows])) for key in
                ("iterations", "contraction", "tips", "spurs", "medial", "reconstruction", "turning", "inside")}
        body.append([title, f"{mean['iterations']:.0f}", number(mean["contraction"], 2), f"{mean['tips']:.1f}",
                     f"{mean['spurs']:.1f}", number(mean["medial"], 2), number(mean["reconstruction"], 2),
                     number(mean["turning"], 2), f"{mean['inside']:.3f}"])
    return markdown(["otherwise than default", "iterations", "contraction s", "tips", "spurs", "medial %", "reconstruction %",
                     "turning", "inside"], body)


def flat_shapes(folder: Path, quick: bool) -> dict[str, tuple[Path, tuple[int, int, int]]]:
    """Meshes of thin shapes with the Betti numbers of their solids."""
    found = {}
    for name in FLAT:
        known = json.loads((ROOT / f"meshes/{name}.json").read_text())
        found[name] = (ROOT / f"meshes/{name}.off", (known["components"], known["genus"], 0))
    for name, make in THIN.items():
        shape = make()
        path = folder / f"{name.replace(' ', '_').replace('_%', '')}.ply"
        if not path.exists():
            write_mesh(path, shape.vertices, shape.faces)
        found[name] = (path, shape.betti)
    return dict(list(found.items())[::4]) if quick else found


def steady_states(work: Work, options: argparse.Namespace) -> str:
    """The meso-skeletons at which the flow stops where sheets are kept."""
    body = []
    for name, (mesh, right) in flat_shapes(work.folder, options.quick).items():
        run = work.run(f"{name}: sheets", mesh, "--keep-sheets")
        path = Path(f"{run['path']}.obj")

        def judged(_: Path) -> dict:
            shape = Shape.read(mesh)
            axis = shape.medial_axis(QUICK_AXIS)
            (points, faces), (_, edges) = with_sheets(path)
            points = (points - shape.origin) / shape.diagonal
            a, b, c = (points[faces[:, k]] for k in range(3))
            areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
            lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
            at = np.vstack([points[faces].mean(axis=1), points[edges].mean(axis=1)])
            # Where there are sheets, they are what counts.
            weights = np.concatenate([areas, lengths * (0 if len(faces) else 1)])
            far = distance_to_medial_axis(shape, axis, at)
            return {"far": float((far * weights).sum() / weights.sum()), "inside": float(
                        (shape.contains(at) * weights).sum() / weights.sum()),
                    "walls": float(areas.sum() / (shape.areas.sum() / shape.diagonal ** 2 / 2)),
                    "curves": float(lengths.sum())}

        found = work.kept(f"{name}: steady state", ("steady", digest(path), digest(mesh)), JUDGES, judged)
        # What has nothing flat is contracted to a curve.
        betti = (run.get("b0", run["components"]), run.get("b1", run["cycles"]), run.get("b2", 0))
        sheets, given_up = run.get("sheets", 0), run.get("sheets_given_up", 0)
        body.append([name, str(run["iterations"]), "yes" if run["converged"] else "no", " ".join(map(str, betti)),
                     "yes" if betti == right else "no: " + " ".join(map(str, right)),
                     str(sheets - given_up), str(given_up), f"{found['walls']:.2f}",
                     number(found["curves"], 2), f"{100 * found['far']:.3f}", f"{found['inside']:.3f}"])
    return markdown(["shape", "iterations", "stops", "b0 b1 b2", "right", "sheets", "given up", "area / half surface",
                     "curves / diagonal", "to the axis %", "inside"], body)


FIGURES = {1: figure_1, 2: figure_2, 3: figure_3, 5: figure_5, 6: figure_6, 7: figure_7, 8: figure_8}


def main() -> int:
    options = parse_arguments()
    folder = ROOT / "build" / "reproduce"
    shapes = {name: ROOT / f"meshes/{name}.off" for name in ("cuboid", "hand", "embrace", "animal")}
    work = Work(options.program, folder, 1)
    shapes["letters"] = letters(folder)
    shapes |= {p.stem: p for p in options.meshes if p.stem != "elephant"}
    work.steps = 6 * len(shapes) + (96 if options.quick else 215)
    docs = options.docs or (None if options.quick else ROOT / "docs")
    pictures = docs / "paper" if docs else folder / "pictures"
    blocks = {"run": "Made by `scripts/reproduce.sh" + (" --quick" if options.quick else "")
              + (f" --vertices {options.vertices}" if options.vertices else "")
              + f"` on {datetime.date.today():%d %B %Y}."}
    blocks["table 1"], found = table_1(work, shapes, options)
    blocks["switches"] = switches(work, options)
    blocks["steady states"] = steady_states(work, options)
    for n, make in FIGURES.items():
        text = make(work, found, pictures, options)
        if text:
            blocks[f"figure {n}"] = text
    work.done = work.steps
    work.show("done")
    print(file=sys.stderr)
    for title, block in blocks.items():
        print(f"\n{title}\n\n{block}")
    if docs:
        page = docs / "paper.md"
        page.write_text(fill(page.read_text(), blocks))
    print(f"\npictures: {pictures}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
