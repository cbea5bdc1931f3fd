"""Makes the wheel for ``pip install .`` and ``pip wheel .`` (PEP 517): CMake builds and installs into a folder, which is packed.

The package holds its own tree: papilla/bin, papilla/lib with the library and what it loads on first use, and
papilla/share/papilla/designs. Debian's libraries that it stands on are not in it. Settings: ``-C PAPILLA_NATIVE=OFF`` for a
wheel that runs on other processors, any other cache variable of the build likewise.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator, Mapping

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/wheel"
# What other programs build with, and pages that no reader of a package looks for.
_LEFT_OUT = ("include", "lib/cmake", "lib/pkgconfig", "share/bash-completion", "share/fish", "share/man")
_BYTES_OF_A_COMPILER = 1.5e9
_TIME = (1980, 1, 1, 0, 0, 0)  # the earliest of a zip: the same tree gives the same bytes

Settings = Mapping[str, str] | None


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None) -> str:
    """Builds, and returns the name of the wheel in the folder."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = _version()
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tags = f"{tag}-{tag}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    info = f"papilla-{version}.dist-info"
    with tempfile.TemporaryDirectory() as stage:
        root = pathlib.Path(stage)
        _install(root / "papilla", config_settings or {})
        (root / info).mkdir()
        (root / info / "METADATA").write_text(_metadata(project, version))
        (root / info / "WHEEL").write_text(
            f"Wheel-Version: 1.0\nGenerator: papilla_wheel\nRoot-Is-Purelib: false\nTag: {tags}\n")
        scripts = "".join(f"{name} = {target}\n" for name, target in project["scripts"].items())
        (root / info / "entry_points.txt").write_text("[console_scripts]\n" + scripts)
        shutil.copy(ROOT / "LICENSE", root / info / "LICENSE")
        name = f"papilla-{version}-{tags}.whl"
        _pack(root, info, pathlib.Path(wheel_directory) / name)
    return name


def _version() -> str:
    found = re.search(r"project\(papilla VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())
    assert found
    return found[1]


def _install(tree: pathlib.Path, settings: Mapping[str, str]) -> None:
    """The installed tree, whose prefix is the package itself."""
    given = [f"-D{key}={value}" for key, value in settings.items()]
    _run("cmake", "--preset", "wheel", f"-DPython_EXECUTABLE={sys.executable}", *given)
    _run("cmake", "--build", str(BUILD), "-j", str(_jobs()))
    _run("cmake", "--install", str(BUILD), "--prefix", str(tree), "--strip")
    for folder in _LEFT_OUT:
        shutil.rmtree(tree / folder, ignore_errors=True)


def _run(*command: str) -> None:
    done = subprocess.run(command, cwd=ROOT, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(done.stdout)
    if done.returncode:
        raise SystemExit(f"{' '.join(command[:2])} failed; what it needs of Debian is installed by scripts/setup --test")


def _jobs() -> int:
    """One compiler a processor, but no more than memory carries."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_AVPHYS_PAGES")
    return max(1, min(os.cpu_count() or 1, int(memory / _BYTES_OF_A_COMPILER)))


def _metadata(project: Mapping[str, object], version: str) -> str:
    optional: Mapping[str, list[str]] = project["optional-dependencies"]  # type: ignore[assignment]
    lines = ["Metadata-Version: 2.1", "Name: papilla", f"Version: {version}", f"Summary: {project['description']}",
             "License: Apache-2.0", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in project["dependencies"]]  # type: ignore[attr-defined]
    for extra, names in optional.items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {name}; extra == "{extra}"' for name in names)]
    lines += ["Description-Content-Type: text/markdown", "", (ROOT / str(project["readme"])).read_text()]
    return "\n".join(lines)


def _files(root: pathlib.Path) -> Iterator[tuple[str, pathlib.Path]]:
    """By their names in the wheel. A zip has no links: of the names of a library only the one that is loaded, its link
    with the short version, stays, as a file."""
    everything = sorted(root.rglob("*"))
    loaded = {file for file in everything if file.is_symlink() and not file.name.endswith(".so")}
    behind = {file.resolve() for file in loaded}
    for file in everything:
        dropped = file not in loaded if file.is_symlink() else file.resolve() in behind
        if file.is_file() and not dropped:
            yield file.relative_to(root).as_posix(), file


def _pack(root: pathlib.Path, info: str, wheel: pathlib.Path) -> None:
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as out:

        def add(name: str, data: bytes, mode: int) -> None:
            entry = zipfile.ZipInfo(name, _TIME)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, data)

        for name, file in _files(root):
            data = file.read_bytes()
            add(name, data, 0o755 if os.access(file, os.X_OK) else 0o644)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}\n")
        record.append(f"{info}/RECORD,,\n")
        add(f"{info}/RECORD", "".join(record).encode(), 0o644)
