"""Files of triangles, read and measured by Blender: area, volume, box and number of triangles are those that were written."""
import json
import shutil
import subprocess

import numpy as np
import pytest

import freiform as ff

MEASURE = """
import bmesh, bpy, json, numpy, sys
numpy.bool = bool  # Debian's Blender is older than its NumPy
out = []
for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    elif path.endswith(".stl"):
        bpy.ops.import_mesh.stl(filepath=path)
    else:
        bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z")
    one = dict(area=0.0, volume=0.0, triangles=0, points=[], objects=0)
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            mesh = bmesh.new()
            mesh.from_mesh(thing.data)
            mesh.transform(thing.matrix_world)
            one["area"] += sum(f.calc_area() for f in mesh.faces)
            one["volume"] += mesh.calc_volume(signed=True)
            one["triangles"] += len(mesh.faces)
            one["points"] += [tuple(v.co) for v in mesh.verts]
            one["objects"] += 1
    points = one.pop("points")
    one["low"], one["high"] = [list(map(f, zip(*points))) for f in (min, max)]
    out.append(one)
print("MEASURED " + json.dumps(out))
"""
SQUARE_RING = ff.Path("M 0 0 H 4 V 3 H 0 Z M 1 1 H 3 V 2 H 1 Z")
DISC = ff.Path("M 3 0 A 1 1 0 1 1 1 0 A 1 1 0 1 1 3 0 Z")
RAIL = ff.Curve([[0, 0, 0], [0, 0, 9], [9, 0, 9]])
SOLIDS = {
    "prism": ff.Model.prism(SQUARE_RING, (0, 0, 2)),
    "ring": ff.Model.solid_of_revolution(DISC, (0, 0, 0), (0, 1, 0)),
    "pipe": ff.Model.along(ff.Path("M 1 0 A 1 1 0 1 1 -1 0 A 1 1 0 1 1 1 0 Z"), RAIL, 1e-3).model,
}
EXACT_VOLUMES = {"prism": (12 - 2) * 2, "ring": 2 * np.pi * 2 * np.pi, "pipe": np.pi * RAIL.length(1e-9).value}


def measures(mesh):
    """(area, volume) of the triangles as they are."""
    a, b, c = (mesh.points[mesh.faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, np.einsum("id,id->", a, np.cross(b, c)) / 6


def measured_by_blender(folder, paths):
    if shutil.which("blender") is None:
        pytest.skip("blender is not installed")
    script = folder / "measure.py"
    script.write_text(MEASURE)
    done = subprocess.run(["blender", "-b", "--factory-startup", "--python", str(script), "--", *map(str, paths)],
                          capture_output=True, text=True, timeout=200, env={"PATH": "/usr/bin:/bin", "HOME": str(folder)})
    lines = [line for line in done.stdout.split("\n") if line.startswith("MEASURED ")]
    assert lines, done.stdout[-2000:] + done.stderr[-2000:]
    return json.loads(lines[0][9:])


def test_blender_reads_what_was_written(tmp_path):
    meshes = {name: model.tessellate(0.01).mesh for name, model in SOLIDS.items()}
    files = [(name, tmp_path / f"{name}.{kind}") for name in meshes for kind in ("glb", "stl", "obj")]
    for name, path in files:
        meshes[name].write(path)
    for (name, path), said in zip(files, measured_by_blender(tmp_path, [path for _, path in files]), strict=True):
        mesh = meshes[name]
        area, volume = measures(mesh)
        assert said["triangles"] == len(mesh), path
        assert said["area"] == pytest.approx(area, rel=1e-5), path          # the files hold floats
        assert said["volume"] == pytest.approx(volume, rel=1e-5), path
        assert said["volume"] == pytest.approx(EXACT_VOLUMES[name], rel=0.02), path
        low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
        assert np.allclose([said["low"], said["high"]], [low, high], atol=1e-5), path


def test_blender_knows_the_unit_of_gltf(tmp_path):
    """glTF is in metres, whatever the model is in; other files are in the model's unit."""
    model = ff.Model.assemble([ff.Surface([[[0, 0, 0], [0, 30, 0]], [[20, 0, 0], [20, 30, 0]]])], "mm")
    mesh = model.tessellate(0.1).mesh
    paths = [tmp_path / f"sheet.{kind}" for kind in ("glb", "stl")]
    for path in paths:
        mesh.write(path)
    glb, stl = measured_by_blender(tmp_path, paths)
    assert glb["area"] == pytest.approx(600e-6, rel=1e-5) and stl["area"] == pytest.approx(600, rel=1e-5)
