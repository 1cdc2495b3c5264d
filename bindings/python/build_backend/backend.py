"""The PEP 517 backend of the package: builds it with CMake and packs it as a wheel. Standard library only.

FREIFORM_PYTHON_PACKAGE names a folder `freiform` that was built already (build/python/freiform); without it the preset
`python` is built first, configured with what `pip install . --config-settings cmake-args="-D.."` adds.
"""
import base64
import hashlib
import os
import pathlib
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
VERSION = (ROOT / "VERSION").read_text().strip()
INFO = f"freiform-{VERSION}.dist-info"
METADATA = f"""Metadata-Version: 2.1
Name: freiform
Version: {VERSION}
Summary: Curves and surfaces whose answers carry a bound that holds
Requires-Python: >=3.9
Requires-Dist: numpy
"""
# Of a fixed day, so that the same files give the same wheel.
TIME = (2026, 1, 1, 0, 0, 0)


def _tag():
    version = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    return f"{version}-{version}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _package(settings):
    given = os.environ.get("FREIFORM_PYTHON_PACKAGE")
    if given:
        return pathlib.Path(given)
    python = os.path.realpath(sys.executable)  # not that of an isolated environment, which has no NumPy
    more = (settings or {}).get("cmake-args", [])  # a list where it is given more than once
    more = [word for text in ([more] if isinstance(more, str) else more) for word in shlex.split(text)]
    subprocess.run(["cmake", "--preset", "python", f"-DPython_EXECUTABLE={python}", "--log-level=WARNING", *more], cwd=ROOT,
                   check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", "--preset", "python"], cwd=ROOT, check=True, stdout=sys.stderr)
    return ROOT / "build" / "python" / "freiform"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package, tag = _package(config_settings), _tag()
    files = {f"freiform/{p.name}": p.read_bytes() for p in sorted(package.iterdir())
             if p.suffix in (".py", ".pyi", ".so", ".typed")}
    files[f"{INFO}/METADATA"] = METADATA.encode()
    files[f"{INFO}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: freiform\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    files[f"{INFO}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{INFO}/RECORD"] = (record + f"{INFO}/RECORD,,\n").encode()
    wheel = f"freiform-{VERSION}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as z:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, TIME)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            z.writestr(entry, data)
    return wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / INFO
    folder.mkdir(parents=True)
    (folder / "METADATA").write_text(METADATA)
    return INFO


def build_sdist(sdist_directory, config_settings=None):
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    base = f"freiform-{VERSION}"
    with tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz") as t:
        for name in names:
            t.add(ROOT / name, f"{base}/{name}")
    return f"{base}.tar.gz"
