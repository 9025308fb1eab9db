#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes the curve skeleton of a mesh and draws it."""

import argparse
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
DEFAULT_MESH = ROOT / "meshes" / "animal.off"
FILTER = "generate_curve_skeleton_mcf"
INT_MAX = 2**31 - 1  # the filter's numbers
#: What the log says of a skeleton that is not all that was asked for.
LESS_THAN_ASKED = ("not refined", "was far outside")
FORMATS = ("ply", "obj", "swc", "cg", "graphml", "json", "vtp", "glb")


class UserError(Exception):
    """What went wrong, in one line for the user."""


def length(text: str) -> tuple[str, float]:
    """A length as the command line takes it: "0.2%" of the bounding box diagonal, or mesh units."""
    kind, number = ("percent", text[:-1]) if text.endswith("%") else ("units", text)
    try:
        value = float(number)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a percentage nor a number") from None
    if not 0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a length")
    if kind == "percent" and value > 100:
        raise argparse.ArgumentTypeError(f"'{text}' is more than 100%, which is the bounding box diagonal")
    return kind, value


def whole_number(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number") from None
    if abs(value) > INT_MAX:
        raise argparse.ArgumentTypeError(f"'{text}' is too large")
    return value


def parse_arguments(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/skeletonize.sh", description=__doc__, allow_abbrev=False,
        epilog="Lengths are mesh units, or with a % sign percent of the bounding box diagonal. "
               "What is not given takes the plugin's own default. Files of the same mesh that are there are "
               "replaced; where another mesh's begin with the same name, as of y.stl and y.ply, those of the "
               "second begin with y_ply.")
    parser.add_argument("mesh", nargs="?", type=Path, default=DEFAULT_MESH, metavar="MESH",
                        help="triangle mesh, or points with normals, any format that MeshLab opens; or "
                             f"voxels, .npy, .npz or .nrrd (default: meshes/{DEFAULT_MESH.name})")
    parser.add_argument("output", nargs="?", type=Path, default=Path("out"), metavar="OUTPUT_FOLDER",
                        help="where the results go (default: out)")
    voxels = parser.add_argument_group("voxels")
    voxels.add_argument("--spacing", type=float, nargs="+", metavar="S",
                        help="distance of the voxels' middles, one number or three (the file's own, or 1)")
    voxels.add_argument("--level", type=float, metavar="VALUE",
                        help="what is above is inside (0.5)")
    flow = parser.add_argument_group("the skeletonization")
    flow.add_argument("--preset", choices=["default", "paper"],
                      help="paper: the paper's algorithm and nothing else, to compare with")
    flow.add_argument("--w-l", type=float, metavar="W", help="smoothness weight (1)")
    flow.add_argument("--w-h", type=float, metavar="W", help="velocity weight (20)")
    flow.add_argument("--w-m", type=float, metavar="W", help="medial weight (40)")
    flow.add_argument("--epsilon", type=length, metavar="LENGTH",
                      help="edges shorter than this are collapsed (0.2%%)")
    flow.add_argument("--split-angle", type=float, metavar="DEGREES",
                      help="edges opposite wider angles are split (110)")
    flow.add_argument("--no-resample", dest="resample", action="store_const", const=False,
                      help="contract the mesh as it is")
    flow.add_argument("--target-length", type=length, metavar="LENGTH",
                      help="edge length of the resampling (chosen from the mesh)")
    flow.add_argument("--resample-iterations", type=whole_number, metavar="N", help="rounds of it (5)")
    flow.add_argument("--no-denoise", dest="denoise", action="store_const", const=False,
                      help="resample without smoothing the noise first")
    flow.add_argument("--repair", choices=["auto", "mend", "off"],
                      help="what is done with a mesh that does not bound a solid (auto)")
    flow.add_argument("--min-component", type=float, metavar="PART",
                      help="pieces of a smaller part of the largest one's volume get no skeleton (0)")
    flow.add_argument("--join", action="store_const", const=True,
                      help="join the skeletons of all pieces by bridges over the narrowest gaps")
    flow.add_argument("--no-adaptive", dest="adaptive", action="store_const", const=False,
                      help="the same lengths everywhere, however thin the shape is")
    flow.add_argument("--relative-length", type=float, metavar="K",
                      help="longest edge in local thicknesses (0.6)")
    flow.add_argument("--no-refine", dest="refine", action="store_const", const=False,
                      help="leave the curve as the contraction made it")
    flow.add_argument("--detail", type=float, metavar="D",
                      help="how small branches may be, from 0, the trunk alone, to 1, all (0.9)")
    flow.add_argument("--pole-method", choices=["voronoi", "balls"], help="how poles are found")
    flow.add_argument("--max-iterations", type=whole_number, metavar="N", help="cap of the contraction (500)")
    results = parser.add_argument_group("the results")
    results.add_argument("--keep-stages", type=whole_number, metavar="K",
                         help="also write every K-th stage of the contraction, NAME_meso_K.ply")
    results.add_argument("--formats", nargs="+", choices=FORMATS, default=["ply"], metavar="FORMAT",
                         help=f"formats of the skeleton: {', '.join(FORMATS)} (ply); obj has lines, glb "
                              "an armature in the surface")
    results.add_argument("--no-picture", dest="picture", action="store_false", help="draw nothing; the picture takes most of the time")
    results.add_argument("--colour", choices=["radius", "branch"], default="radius",
                         help="what the skeleton's colour means in the picture")
    results.add_argument("--up", choices=["auto", "x", "y", "z"], default="auto",
                         help="the axis that points upwards in the picture")
    results.add_argument("--verbose", action="store_true", help="print the plugin's log")
    parser.add_argument("--plugin", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--only-check", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.keep_stages is not None and options.keep_stages < 1:
        parser.error("argument --keep-stages: must be at least 1")
    if options.spacing is not None and len(options.spacing) not in (1, 3):
        parser.error("argument --spacing: one number, or three")
    return options


def check_files(options: argparse.Namespace) -> None:
    """Finds out before the work what cannot be read or written."""
    if options.mesh.is_dir():
        raise UserError(f"'{options.mesh}' is a folder, not a mesh: examples/skeletonize_folder.py does "
                        "folders")
    if not options.mesh.is_file():
        raise UserError(f"there is no file '{options.mesh}'")
    output = options.output.absolute()
    there = next(folder for folder in [output, *output.parents] if folder.exists())
    try:
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise UserError(f"nothing can be written into '{options.output}': {error.strerror}") from None


def filter_parameters(options: argparse.Namespace) -> dict[str, Any]:
    """The filter's parameters that were given, as pymeshlab takes them."""
    import pymeshlab
    kinds = {"percent": pymeshlab.PercentageValue, "units": pymeshlab.PureValue}
    parameters = {}
    for name in ["preset", "w_l", "w_h", "w_m", "epsilon", "split_angle", "resample", "target_length",
                 "resample_iterations", "denoise", "adaptive", "relative_length", "refine", "repair",
                 "min_component", "join", "detail", "pole_method", "max_iterations",
                 "keep_stages"]:
        value = getattr(options, name)
        if isinstance(value, tuple):
            value = kinds[value[0]](value[1])
        if value is not None:
            parameters[name] = value
    return parameters


def use_package(plugin: Path) -> None:
    """Makes this checkout's Python package importable: it reads meshes and runs filters the same way for both."""
    os.environ["MCFSKEL_PLUGIN"] = str(plugin.absolute())
    sys.path.insert(0, str(ROOT / "python"))


def read_surface(options: argparse.Namespace) -> Any:
    """A document with the mesh as its current layer."""
    from mcfskel._run import SkeletonError
    from mcfskel._skeleton import document

    try:
        return document(options.mesh, spacing=options.spacing, level=options.level)
    except SkeletonError as error:
        raise UserError(str(error)) from None


def apply_filter(layers: Any, name: str, parameters: dict[str, Any]) -> dict[str, float]:
    """Runs a filter and returns its numbers; Ctrl-C ends it."""
    from mcfskel._run import SkeletonError, apply

    try:
        return apply(layers, name, parameters)
    except SkeletonError as error:
        raise UserError(str(error)) from None


def run_filter(options: argparse.Namespace) -> tuple[Any, Any, dict[str, float]]:
    """Loads the mesh and runs the filter with a progress bar.

    Returns:
        The document, its layer that was contracted, and the numbers.
    """
    from mcfskel._skeleton import contracted_layer
    from tqdm import tqdm

    from host_progress import host_output, terminal

    messages: list[str] = []
    error: UserError | None = None
    results: dict[str, float] = {}
    parameters = filter_parameters(options)
    with terminal() as stream, tqdm(
            total=100, file=stream, leave=False, desc="Reading", mininterval=0, disable=None,
            bar_format="{desc:<32.32} {bar} {percentage:3.0f} % {elapsed}") as bar:

        def on_progress(percent: int, what: str) -> None:
            bar.set_description_str(what, refresh=False)
            bar.update(max(0, percent - bar.n))

        with host_output(on_progress, messages.append):
            layers = read_surface(options)
            mesh = layers.current_mesh_id()
            layers.set_verbosity(True)
            bar.reset()
            try:
                results = apply_filter(layers, FILTER, parameters)
            except UserError as exception:
                error = exception
    if not options.verbose and (error is not None or results["converged"]):
        messages = [text for text in messages if any(words in text for words in LESS_THAN_ASKED)]
    for text in messages:
        print(text, file=sys.stderr)
    if error is not None:
        raise UserError(f"{options.mesh}: {error}")
    return layers, contracted_layer(layers, mesh), results


def layer_named(layers: Any, ending: str) -> Any:
    """The newest layer whose name ends so, or None."""
    found = [mesh for mesh in layers if mesh.label().endswith(ending)]
    return found[-1] if found else None


def vertex_attribute(mesh: Any, name: str, kind: str = "scalar") -> Any:
    """A custom attribute as an array, or None; pymeshlab has no way to ask."""
    import pymeshlab
    reader = {"scalar": mesh.vertex_custom_scalar_attribute_array,
              "point": mesh.vertex_custom_point_attribute_matrix}[kind]
    try:
        return reader(name)
    except pymeshlab.PyMeshLabException:
        return None


def surface_attributes(mesh: Any) -> dict[str, Any]:
    """The attributes of a surface or stage as columns of a PLY file."""
    import numpy as np
    types = {"mcfskel_node": np.int32, "mcfskel_fixed": np.int32, "mcfskel_held": np.int32,
             "mcfskel_kind": np.int32, "mcfskel_radius": np.float32, "mcfskel_pole_radius": np.float64}
    found = {name: vertex_attribute(mesh, name) for name in types}
    columns = {name: values.astype(types[name]) for name, values in found.items() if values is not None}
    pole = vertex_attribute(mesh, "mcfskel_pole", "point")
    if pole is not None:
        columns |= {f"mcfskel_pole_{axis}": pole[:, k] for k, axis in enumerate("xyz")}
    return columns


def write_obj(path: Path, nodes: Any, edges: Any) -> None:
    """Two-index lines, the only edges that survive MeshLab's own reading and writing."""
    from whole_file import write_whole

    lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in nodes] + [f"l {a} {b}\n" for a, b in edges + 1]
    write_whole(path, "".join(lines).encode())


def name_of_results(mesh: Path, folder: Path) -> str:
    """What the files of a mesh begin with: y of y.stl; y_stl where those of another mesh begin with y."""
    from ply_files import mesh_of_skeleton

    name, other = mesh.stem, f"{mesh.stem}_{mesh.suffix[1:]}"
    skeleton = folder / f"{name}_skeleton.ply"
    made_of = mesh_of_skeleton(skeleton)
    if made_of in (None, mesh.name):
        return name
    print(f"{skeleton} is of {made_of}: the files of {mesh.name} begin with {other}", file=sys.stderr)
    return other


def write_results(options: argparse.Namespace, layers: Any, surface: Any) -> dict[Path, str]:
    """Writes every file; returns their names, and for each whether it was "wrote" or "replaced"."""
    from host_progress import host_output
    from picture import draw
    from ply_files import write_skeleton, write_surface

    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    name = name_of_results(options.mesh, folder)
    written = {}

    def place(ending: str) -> Path:
        path = folder / f"{name}{ending}"
        written[path] = "replaced" if path.exists() else "wrote"
        return path

    skeleton = layer_named(layers, "_skeleton")
    nodes, edges = skeleton.vertex_matrix(), skeleton.edge_matrix()
    radius = vertex_attribute(skeleton, "mcfskel_radius")
    vertices, faces = surface.vertex_matrix(), surface.face_matrix()

    write_skeleton(place("_skeleton.ply"), nodes, edges, radius, options.mesh.name)
    if "obj" in options.formats:
        write_obj(place("_skeleton.obj"), nodes.tolist(), edges)
    layers.set_current_mesh(skeleton.id())
    for kind in sorted(set(options.formats) - {"ply", "obj"}):
        path = place(f"_skeleton.{kind}")
        messages: list[str] = []
        with host_output(lambda percent, what: None, messages.append):
            # Not resolve(): what a link leads to may end otherwise, and the ending is the format.
            apply_filter(layers, "save_skeleton_mcf", {"file": str(path.absolute()), "surface": surface.id()})
        for message in messages:
            if "Warning:" in message:  # a cycle was cut, say
                print(message[message.index("Warning:"):], file=sys.stderr)
    write_surface(place("_surface.ply"), vertices, faces, surface_attributes(surface))
    if options.keep_stages:
        for mesh in layers:
            base, _, iteration = mesh.label().rpartition("_meso_")
            if base:
                write_surface(place(f"_meso_{iteration}.ply"), mesh.vertex_matrix(), mesh.face_matrix(),
                              surface_attributes(mesh))
    if options.picture:
        draw(vertices, faces, nodes, edges, radius, place(".png"), options.colour, options.up)
    return written


def summary(results: dict[str, float], written: dict[Path, str]) -> str:
    seconds = sum(value for key, value in results.items() if key.startswith("seconds_"))
    ending = "converged" if results["converged"] else "did NOT converge"
    lines = [
        f"skeleton: {results['skeleton_vertices']} nodes, {results['branches']} branches, "
        f"{results['terminals']} tips, {results['junctions']} junctions, "
        f"{results['components']} components, {results['cycles']} cycles",
        f"contraction: {ending} after {results['iterations']} iterations; {seconds:.2f} s in all",
    ]
    return "\n".join(lines + [f"{verb} {path}" for path, verb in written.items()])


def main() -> int:
    options = parse_arguments()
    try:
        check_files(options)
        if options.only_check:
            return 0
        use_package(options.plugin)
        layers, surface, results = run_filter(options)
        written = write_results(options, layers, surface)
    except UserError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"error: {error.filename or options.output}: {error.strerror or error}", file=sys.stderr)
        return 1
    print(summary(results, written))
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(130)
