# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What fails around a job: full disks, files that may not be written, kills, no memory. There is one clear
error, and files and documents are as they were."""

import contextlib
import csv
import errno
import json
import os
import random
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from conftest import FULL, MESHES, ROOT, STEP, opened
from starved import jobs

sys.path.insert(0, str(ROOT / "scripts"))
from whole_file import write_whole  # noqa: E402

HOSTS = Path(__file__).parent
COARSE = {"target_length": pymeshlab.PercentageValue(2.5)}
OLD = b"what was there before\n" * 20
NOBODY = 65534
PAGE = 4096
#: What writes files: the layer that it writes, how, and how the file's name ends.
WRITERS = {
    "export swc": ("curve", "save_current_mesh", "swc"),
    "export cg": ("curve", "save_current_mesh", "cg"),
    "export graphml": ("curve", "save_current_mesh", "graphml"),
    "save skeleton swc": ("curve", "save_skeleton_mcf", "swc"),
    "save skeleton cg": ("curve", "save_skeleton_mcf", "cg"),
    "save skeleton graphml": ("curve", "save_skeleton_mcf", "graphml"),
    "save skeleton json": ("curve", "save_skeleton_mcf", "json"),
    "save skeleton ply": ("curve", "save_skeleton_mcf", "ply"),
    "save stage of a curve": ("curve", "save_stage_mcf", "ply"),
    "save stage": ("stage", "save_stage_mcf", "ply"),
    "skeletonize.sh": (None, "", "obj"),
}
Write = Callable[[Path], str]

as_root = pytest.mark.skipif(os.geteuid() != 0, reason="needs root")


@pytest.fixture(scope="module")
def documents() -> dict[str, pymeshlab.MeshSet]:
    layers = {"curve": opened("capsule"), "stage": opened("capsule")}
    layers["curve"].apply_filter(FULL, **COARSE)
    layers["stage"].apply_filter(STEP)
    return layers


@pytest.fixture(params=WRITERS)
def writer(request, documents) -> tuple[Write, str]:
    """Writes a file, and returns what is said about it if that fails; and how the file's name ends."""
    what, how, ending = WRITERS[request.param]

    def write(path: Path) -> str:
        try:
            if what is None:
                write_whole(path, b"new content\n" * 2000)
            elif how == "save_current_mesh":
                documents[what].save_current_mesh(str(path))
            else:
                documents[what].apply_filter(how, file=str(path))
        except (pymeshlab.PyMeshLabException, OSError) as error:
            return str(error)
        return ""
    return write, ending


@contextlib.contextmanager
def mounted(folder: Path, *how: str) -> Iterator[None]:
    run = subprocess.run(["mount", *how, str(folder)], capture_output=True, text=True)
    if run.returncode != 0:
        pytest.skip(f"nothing can be mounted here: {run.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@pytest.fixture
def small_disk(tmp_path) -> Iterator[Path]:
    """A disk of 64 kB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    with mounted(folder, "-t", "tmpfs", "-o", "size=64k", "tmpfs"):
        yield folder


def fill(disk: Path, leave: int = 0) -> Path:
    """Fills a disk but for some pages."""
    filler = disk / "filler"
    with open(filler, "wb", buffering=0) as out:
        with contextlib.suppress(OSError):
            while out.write(b"x" * PAGE):
                pass
        out.truncate(max(0, out.tell() // PAGE - leave) * PAGE)
    return filler


@pytest.fixture
def nobody() -> Iterator[Path]:
    """A folder of somebody who is not root, and who this process is now."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if os.geteuid() != 0:
            yield folder
            folder.chmod(0o700)
            return
        os.chown(folder, NOBODY, NOBODY)
        os.setegid(NOBODY)
        os.seteuid(NOBODY)
        try:
            yield folder
        finally:
            os.seteuid(0)
            os.setegid(0)
            folder.chmod(0o700)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@as_root
class TestFullDisk:
    @pytest.mark.parametrize("room", ["none", "all but the last page"])
    def test_the_old_file_stays(self, writer, small_disk, tmp_path, room):
        write, ending = writer
        elsewhere = tmp_path / f"s.{ending}"
        assert write(elsewhere) == ""
        pages = -(-elsewhere.stat().st_size // PAGE)
        path = small_disk / f"s.{ending}"
        path.write_bytes(OLD)
        path.chmod(0o640)
        filler = fill(small_disk, 0 if room == "none" else pages - 1)
        text = write(path)
        assert "No space left on device" in text and str(path) in text
        filler.unlink()
        assert contents(small_disk) == {path.name: OLD}
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        if pages < 15:
            assert write(path) == ""
            assert path.read_bytes() == elsewhere.read_bytes()
            assert stat.S_IMODE(path.stat().st_mode) == 0o640

    def test_no_new_file_comes_of_it(self, writer, small_disk):
        write, ending = writer
        fill(small_disk)
        assert "No space left on device" in write(small_disk / f"s.{ending}")
        assert list(contents(small_disk)) == ["filler"]

    def test_skeletonize_sh(self, plugin, small_disk, tmp_path):
        """The first file that it writes, and with a link the last one."""
        names = ["torus_skeleton.ply", "torus_skeleton.obj", "torus_surface.ply", "torus_meso_8.ply",
                 "torus.png"]
        for name in names:
            (small_disk / name).write_bytes(OLD)
        (tmp_path / "out").mkdir()
        (tmp_path / "out" / "torus.png").symlink_to(small_disk / "torus.png")
        fill(small_disk)
        for folder, failing in [(small_disk, "torus_skeleton.ply"), (tmp_path / "out", "torus.png")]:
            run = subprocess.run(
                [sys.executable, str(ROOT / "scripts/skeletonize.py"), "--plugin", str(plugin),
                 str(MESHES / "torus.off"), str(folder), "--target-length", "2%", "--formats", "ply",
                 "obj", "--keep-stages", "8"], capture_output=True, text=True)
            assert run.returncode == 1 and "Traceback" not in run.stderr
            assert run.stderr.strip().splitlines()[-1] == (
                f"error: {folder / failing}: No space left on device")
            assert {path.read_bytes() for path in small_disk.iterdir() if path.name in names} == {OLD}
        assert (tmp_path / "out" / "torus.png").is_symlink()

    def test_the_package(self, plugin, small_disk, monkeypatch):
        monkeypatch.syspath_prepend(str(ROOT / "python"))
        monkeypatch.setenv("MCFSKEL_PLUGIN", str(plugin))
        import mcfskel
        skeleton = mcfskel.Skeleton(np.eye(3), np.array([[0, 1], [1, 2]]), np.ones(3),
                                    np.zeros(5, np.int64))
        fill(small_disk)
        for kind in ["swc", "cg", "graphml", "json", "ply"]:
            (small_disk / f"s.{kind}").touch()
            with pytest.raises(mcfskel.SkeletonError, match="No space left on device"):
                skeleton.save(small_disk / f"s.{kind}")
            assert (small_disk / f"s.{kind}").read_bytes() == b""

    def test_the_table_of_a_folder(self, plugin, small_disk, tmp_path):
        (tmp_path / "meshes").mkdir()
        (tmp_path / "meshes" / "torus.off").symlink_to(MESHES / "torus.off")
        row = {"mesh": "else.off", "status": "ok", "seconds": "1.00"}
        with open(small_disk / "results.csv", "w", newline="") as lines:
            table = csv.DictWriter(lines, ["mesh", "status", "seconds"])
            table.writeheader()
            table.writerow(row)
        before = (small_disk / "results.csv").read_bytes()
        fill(small_disk)
        run = subprocess.run(
            [sys.executable, str(ROOT / "examples/skeletonize_folder.py"), str(tmp_path / "meshes"),
             str(small_disk)], capture_output=True, text=True,
            env=os.environ | {"MCFSKEL_PLUGIN": str(plugin), "PYTHONPATH": str(ROOT / "python")})
        assert run.returncode == 1 and "Traceback" not in run.stderr
        assert "No space left on device" in run.stderr.strip().splitlines()[-1]
        assert (small_disk / "results.csv").read_bytes() == before
        assert set(contents(small_disk)) == {"results.csv", "filler"}


class TestPlaces:
    """Files and folders that may not be written, and what is no plain file."""

    def test_a_folder_of_that_name(self, writer, tmp_path):
        write, ending = writer
        path = tmp_path / f"s.{ending}"
        path.mkdir()
        assert "Is a directory" in write(path)
        assert path.is_dir() and list(tmp_path.iterdir()) == [path]

    def test_no_such_folder(self, writer, tmp_path):
        write, ending = writer
        assert "No such file or directory" in write(tmp_path / "none" / f"s.{ending}")
        assert not list(tmp_path.iterdir())

    def test_read_only_file(self, writer, nobody):
        write, ending = writer
        path = nobody / f"s.{ending}"
        path.write_bytes(OLD)
        path.chmod(0o444)
        assert "Permission denied" in write(path)
        assert contents(nobody) == {path.name: OLD}

    def test_read_only_folder(self, writer, nobody):
        write, ending = writer
        path = nobody / f"s.{ending}"
        path.write_bytes(OLD)
        path.chmod(0o444)
        nobody.chmod(0o555)
        assert "Permission denied" in write(path)
        assert "Permission denied" in write(nobody / f"new.{ending}")
        assert contents(nobody) == {path.name: OLD}

    def test_a_writable_file_in_a_read_only_folder(self, documents, nobody):
        """It can only be overwritten, with a shorter or a longer content."""
        expected = nobody / "elsewhere.cg"
        documents["curve"].save_current_mesh(str(expected))
        path = nobody / "s.cg"
        for old in [OLD, OLD * 1000]:
            nobody.chmod(0o755)
            path.write_bytes(old)
            inode = path.stat().st_ino
            nobody.chmod(0o555)
            documents["curve"].save_current_mesh(str(path))
            assert path.read_bytes() == expected.read_bytes()
            assert path.stat().st_ino == inode

    @as_root
    def test_the_same_on_a_full_disk(self, documents, small_disk, nobody, tmp_path):
        os.seteuid(0)
        for folder in [*tmp_path.parents[:2], tmp_path]:
            folder.chmod(folder.stat().st_mode | 0o011)  # so that nobody gets there
        path = small_disk / "s.cg"
        path.write_bytes(OLD)
        os.chown(path, NOBODY, NOBODY)
        small_disk.chmod(0o555)
        fill(small_disk, 1)
        os.seteuid(NOBODY)
        with pytest.raises(pymeshlab.PyMeshLabException, match="No space left on device"):
            documents["curve"].save_current_mesh(str(path))
        assert path.read_bytes() == OLD

    @as_root
    def test_a_mounted_file(self, documents, tmp_path):
        """It cannot be replaced, as those that are handed into containers."""
        outside, inside = tmp_path / "outside.cg", tmp_path / "s.cg"
        outside.write_bytes(OLD)
        inside.touch()
        with mounted(inside, "--bind", str(outside)):
            documents["curve"].save_current_mesh(str(inside))
        documents["curve"].save_current_mesh(str(tmp_path / "expected.cg"))
        assert outside.read_bytes() == (tmp_path / "expected.cg").read_bytes()
        assert set(contents(tmp_path)) == {"outside.cg", "s.cg", "expected.cg"}

    @pytest.mark.parametrize("there", [True, False])
    def test_links_stay(self, writer, tmp_path, there):
        write, ending = writer
        (tmp_path / "far").mkdir()
        target = tmp_path / "far" / "target"
        if there:
            target.write_bytes(OLD)
            target.chmod(0o604)
        link, first = tmp_path / f"s.{ending}", tmp_path / "first"
        first.symlink_to("far/target")
        link.symlink_to(first)
        assert write(link) == ""
        assert link.is_symlink() and first.is_symlink() and not target.is_symlink()
        assert target.read_bytes() not in (OLD, b"")
        assert not there or stat.S_IMODE(target.stat().st_mode) == 0o604
        assert set(contents(tmp_path / "far")) == {"target"}

    @as_root
    def test_the_owner_stays(self, writer, tmp_path):
        write, ending = writer
        path = tmp_path / f"s.{ending}"
        path.write_bytes(OLD)
        os.chown(path, NOBODY, NOBODY)
        assert write(path) == ""
        assert path.read_bytes() != OLD
        assert (path.stat().st_uid, path.stat().st_gid) == (NOBODY, NOBODY)

    def test_a_new_file_has_the_usual_permissions(self, writer, tmp_path):
        write, ending = writer
        before = os.umask(0o027)
        try:
            assert write(tmp_path / f"s.{ending}") == ""
        finally:
            os.umask(before)
        assert stat.S_IMODE((tmp_path / f"s.{ending}").stat().st_mode) == 0o640

    @as_root
    @pytest.mark.parametrize("minor, words", [(3, ""), (7, "No space left on device")])
    def test_devices(self, writer, tmp_path, minor, words):
        write, ending = writer
        path = tmp_path / f"s.{ending}"
        os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, minor))  # /dev/null, /dev/full
        try:
            text = write(path)
        except PermissionError:
            pytest.skip("devices cannot be used here")
        assert words in text and bool(text) == bool(words)
        assert path.is_char_device() and path.stat().st_rdev == os.makedev(1, minor)

    def test_pipes(self, writer, tmp_path):
        write, ending = writer
        assert write(tmp_path / f"expected.{ending}") == ""
        path = tmp_path / f"s.{ending}"
        os.mkfifo(path)
        found: list[bytes] = []
        reader = threading.Thread(target=lambda: found.append(path.read_bytes()))
        reader.start()
        assert write(path) == ""
        reader.join()
        assert found == [(tmp_path / f"expected.{ending}").read_bytes()]
        assert path.is_fifo()

    def test_a_pipe_that_nobody_reads_any_more(self, plugin, tmp_path):
        """The signal that comes with it would end a host that does not ignore it."""
        path = tmp_path / "s.ply"
        os.mkfifo(path)
        script = (
            "import pymeshlab, signal, sys\n"
            "signal.signal(signal.SIGPIPE, signal.SIG_DFL)\n"
            "pymeshlab.load_plugin(sys.argv[1])\n"
            "layers = pymeshlab.MeshSet()\n"
            "layers.load_new_mesh(sys.argv[2])\n"
            "layers.apply_filter('generate_meso_skeleton_mcf')\n"
            "try:\n"
            "    layers.apply_filter('save_stage_mcf', file=sys.argv[3])\n"
            "except pymeshlab.PyMeshLabException as error:\n"
            "    print(error)\n")
        running = subprocess.Popen([sys.executable, "-c", script, str(plugin),
                                    str(MESHES / "torus.off"), str(path)],
                                   stdout=subprocess.PIPE, text=True)
        with open(path, "rb") as pipe:
            pipe.read(1)
        text, _ = running.communicate()
        assert running.returncode == 0 and "Broken pipe" in text

    @pytest.mark.parametrize("redirected", [True, False])
    def test_the_standard_output(self, plugin, tmp_path, redirected):
        script = (
            "import os, pymeshlab, sys\n"
            "pymeshlab.load_plugin(sys.argv[1])\n"
            "layers = pymeshlab.MeshSet()\n"
            "layers.load_new_mesh(sys.argv[2])\n"
            "layers.apply_filter('generate_meso_skeleton_mcf')\n"
            "os.write(1, b'BEFORE')\n"
            "layers.apply_filter('save_stage_mcf', file='/dev/stdout')\n"
            "os.write(1, b'AFTER')\n")
        command = [sys.executable, "-c", script, str(plugin), str(MESHES / "capsule.off")]
        if redirected:
            with open(tmp_path / "output", "wb") as output:
                subprocess.run(command, stdout=output, check=True)
            text = (tmp_path / "output").read_bytes()
        else:
            text = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
        found = text.partition(b"BEFORE")[2].partition(b"AFTER")[0]
        assert found.startswith(b"ply\n") and len(found) > 10000


class TestKilled:
    def test_while_writing(self, documents, writer, tmp_path):
        """At random moments: the file is one or the other as a whole."""
        write, ending = writer
        path = tmp_path / f"s.{ending}"
        assert write(path) == ""
        new = path.read_bytes()
        rng = random.Random(ending)
        start = time.monotonic()
        assert write(path) == ""
        takes = time.monotonic() - start
        replaced = 0
        for _ in range(15):
            path.write_bytes(OLD)
            child = os.fork()
            if child == 0:
                write(path)
                os._exit(0)
            time.sleep(rng.uniform(0, 1.5 * takes))
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            found = path.read_bytes()
            assert found in (OLD, new)
            replaced += found == new
            for left in tmp_path.glob(".mcfskel-*"):
                left.unlink()
        assert set(contents(tmp_path)) == {path.name}
        assert write(path) == ""
        assert path.read_bytes() == new


@pytest.fixture(scope="module")
def faults(tmp_path_factory) -> Path:
    """The library that makes the system fail."""
    library = tmp_path_factory.mktemp("faults") / "faults.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(HOSTS / "faults.c")],
                   check=True)
    return library


class TestDisk:
    def test_errors_that_come_with_the_flush(self, plugin, faults, tmp_path):
        """As those of a disk that breaks, or of one far away that is full."""
        script = (
            "import ctypes, pymeshlab, sys\n"
            "pymeshlab.load_plugin(sys.argv[1])\n"
            "layers = pymeshlab.MeshSet()\n"
            "layers.load_new_mesh(sys.argv[2])\n"
            "layers.apply_filter('generate_meso_skeleton_mcf')\n"
            "ctypes.CDLL(None).fail_disk(int(sys.argv[4]))\n"
            "for file in sys.argv[5:]:\n"
            "    try:\n"
            "        layers.apply_filter('save_stage_mcf', file=file)\n"
            "    except pymeshlab.PyMeshLabException as error:\n"
            "        print('REFUSED', str(error).splitlines()[-1])\n")
        path = tmp_path / "s.ply"
        path.write_bytes(OLD)
        run = subprocess.run(
            [sys.executable, "-c", script, str(plugin), str(MESHES / "capsule.off"), "",
             str(errno.EIO), str(path)], env=os.environ | {"LD_PRELOAD": str(faults)},
            stdout=subprocess.PIPE, text=True, check=True)
        assert "REFUSED" in run.stdout and "Input/output error" in run.stdout
        assert contents(tmp_path) == {"s.ply": OLD}

    @as_root
    @pytest.mark.parametrize("old", [OLD, OLD * 10000], ids=["longer", "shorter"])
    def test_what_was_overwritten_is_put_back(self, plugin, faults, tmp_path, old):
        script = (
            "import ctypes, os, pymeshlab, sys\n"
            "pymeshlab.load_plugin(sys.argv[1])\n"
            "layers = pymeshlab.MeshSet()\n"
            "layers.load_new_mesh(sys.argv[2])\n"
            "layers.apply_filter('generate_meso_skeleton_mcf')\n"
            "ctypes.CDLL(None).fail_disk(5)\n"
            "os.seteuid(65534)\n"
            "try:\n"
            "    layers.apply_filter('save_stage_mcf', file=sys.argv[3])\n"
            "except pymeshlab.PyMeshLabException as error:\n"
            "    print('REFUSED', str(error).splitlines()[-1])\n")
        with tempfile.TemporaryDirectory() as name:
            path = Path(name) / "s.ply"
            path.write_bytes(old)
            path.chmod(0o666)
            Path(name).chmod(0o555)
            run = subprocess.run(
                [sys.executable, "-c", script, str(plugin), str(MESHES / "capsule.off"), str(path)],
                env=os.environ | {"LD_PRELOAD": str(faults)}, stdout=subprocess.PIPE, text=True,
                check=True)
            assert "REFUSED" in run.stdout and "Input/output error" in run.stdout
            assert path.read_bytes() == old


class TestMemory:
    """Refused at ten points of a job: an error that says so, and the document as it was."""

    @staticmethod
    def outcomes(plugin: Path, *arguments: str, **environment: str) -> list:
        run = subprocess.run(
            [sys.executable, str(HOSTS / "starved.py"), str(plugin), *arguments],
            env=os.environ | environment, capture_output=True, text=True, timeout=600)
        assert run.returncode == 0, run.stderr[-2000:]
        found = json.loads(run.stdout.splitlines()[-1])
        assert None not in found, f"{found}; {run.stderr[-2000:]}"
        return found

    @pytest.mark.parametrize("job", jobs(Path()))
    def test_refused(self, plugin, faults, job):
        # One thread: which request is the n-th does not depend on chance, and a copy of the process
        # has all of its threads.
        found = self.outcomes(plugin, "refuse", job, LD_PRELOAD=str(faults), OMP_NUM_THREADS="1")
        # The last requests may be the host's, when all is done.
        refused = [(text, unchanged) for text, unchanged, _ in found if text]
        assert len(found) == 10 and len(refused) >= 7, found
        for text, unchanged in refused:
            # The second is pymeshlab's own word for it.
            assert ("memory" in text.lower() or "bad_alloc" in text) and unchanged, found

    @pytest.mark.parametrize("threads", ["1", "3"])
    def test_limited(self, plugin, threads):
        found = self.outcomes(plugin, "limit", "full, larger", OMP_NUM_THREADS=threads)
        refused = [(text, unchanged) for text, unchanged, _ in found if text]
        assert len(refused) >= 5, "what is left has had enough memory without new one"
        for text, unchanged in refused:
            assert "memory" in text.lower() and unchanged, found
