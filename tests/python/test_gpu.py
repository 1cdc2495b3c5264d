"""Surfaces for graphics cards: buffers, shaders, pictures and points, compared with what the processor computes."""
import re

import numpy as np
import pytest
from conftest import ROOT

import freiform as ff

BALL = ff.sphere(2.0).surface
BODY = ff.Model.prism(ff.Path("M 0 0 H 2 V 1 A 1 1 0 0 1 0 1 Z"), by=(0, 0, 1.5))
PATCH = ff.TriangularPatch([[0, 0, 3], [1, 0, 3], [0, 1, 3]])


def on_card(make):
    """What make() gives; the test is skipped where there is no OpenGL that can do it."""
    try:
        return make()
    except ff.UnavailableError as why:
        pytest.skip(str(why))


def test_buffers_hold_the_pieces_of_a_model():
    b = on_card(lambda: ff.SurfaceBuffers(BODY, 1e-3))
    assert b.face_count == len(BODY.faces) and b.triangles == 0
    assert b.texels.dtype == np.float32 and b.texels.shape[1] == 4 and not b.texels.flags.writeable
    assert b.faces + 3 * b.face_count <= len(b.texels) and b.pieces + 4 * b.tensor_pieces <= len(b.texels)
    assert b.bends.shape == (b.tensor_pieces, 2)
    # The record of a piece repeats its bend.
    records = b.texels[b.pieces:b.pieces + 4 * b.tensor_pieces].reshape(-1, 4, 4)
    assert np.array_equal(records[:, 3, :2], b.bends)
    # Ends of edges are where the vertices are: in the scene, whose units they give.
    ends = b.middle + b.size * np.concatenate([b.seams["edge_from"], b.seams["edge_to"]]).astype(float)
    for corner in ([0, 0, 0], [2, 0, 0], [2, 1, 1.5]):
        assert np.abs(ends - corner).max(axis=1).min() < 1e-6 * b.size
    assert b.outlines.shape[1:] == (2, 3) and b.extent.shape[1] == 3
    assert np.all(b.extent.min(axis=0) <= [1e-9, 1e-9, 1e-9]) and np.all(b.extent.max(axis=0) >= [2 - 1e-9, 1, 1.5 - 1e-9])


def test_arrays_outlive_their_buffers():
    b = on_card(lambda: ff.SurfaceBuffers(BODY, 1e-3))
    texels = b.texels
    before = texels.copy()
    del b
    assert np.array_equal(texels, before)


def test_triangular_patches_come_beside_a_model():
    b = on_card(lambda: ff.SurfaceBuffers(BODY, 1e-3, [PATCH, (PATCH, "#ff0000")], colour="#00ff00"))
    assert b.triangles == 2 and b.face_count == len(BODY.faces) + 2
    colours = b.texels[b.faces:b.faces + 3 * b.face_count].reshape(-1, 3, 4)[:, 1, :3]
    assert np.allclose(colours[-1], [1, 0, 0]) and np.allclose(colours[:-1], [0, 1, 0])


def test_a_smaller_tolerance_of_edges_needs_more_segments():
    coarse, fine = (on_card(lambda: ff.SurfaceBuffers(BODY, t)) for t in (1e-1, 1e-4))
    assert len(fine.seams) > 2 * len(coarse.seams)
    assert np.array_equal(fine.bends, coarse.bends)


def test_shaders_are_complete_sources():
    on_card(lambda: ff.shader_source("patch_vertex"))
    for name in ("patch_vertex", "patch_control", "patch_evaluation", "triangle_evaluation", "grid_vertex", "surface_fragment",
                 "seam_vertex", "seam_fragment", "evaluate_float", "evaluate_double"):
        assert ff.shader_source(name).startswith("#version 430") and "void main()" in ff.shader_source(name)
    assert ff.shader_source("grid_vertex", "gles300").startswith("#version 300 es")


def test_a_picture_shows_what_the_mesh_shows():
    renderer = on_card(lambda: ff.SurfaceRenderer(ff.SurfaceBuffers(BODY, 1e-3)))
    options = dict(width=200, height=150, view="30,20")
    picture, mesh = renderer.draw(**options), BODY.tessellate(1e-3).mesh.render(**options)
    assert picture.shape == mesh.shape == (150, 200, 3)
    different = np.abs(picture.astype(int) - mesh.astype(int)).max(axis=2) > 24
    assert different.mean() < 0.02  # along outlines
    assert (np.abs(picture.astype(int) - picture[0, 0].astype(int)).max(axis=2) > 24).mean() > 0.2
    assert not np.array_equal(picture, renderer.draw(**dict(options, view="60,20")))


def test_both_pipelines_draw_the_same():
    buffers = on_card(lambda: ff.SurfaceBuffers(BODY, 1e-3))
    a, b = (on_card(lambda: ff.SurfaceRenderer(buffers, p)) for p in ("tessellation", "grid"))
    pictures = [r.draw(width=120, height=100).astype(int) for r in (a, b)]
    assert (np.abs(pictures[0] - pictures[1]).max(axis=2) > 24).mean() < 0.02


def test_triangles_of_a_picture_lie_on_the_surface():
    buffers = on_card(lambda: ff.SurfaceBuffers(ff.Model.assemble([BALL]), 1e-3))
    renderer = on_card(lambda: ff.SurfaceRenderer(buffers))
    t = renderer.triangles(width=300, height=300)
    assert t.ndim == 2 and t.shape[1] == 3 and len(t) > 100
    points = buffers.middle + buffers.size * t["position"].astype(float)
    assert np.abs(np.linalg.norm(points, axis=2) - 2).max() < 4e-6
    assert np.abs(np.abs(np.einsum("tkd,tkd->tk", t["normal"], points / 2)) - 1).max() < 1e-4
    assert t["piece"].min() >= 0 and t["piece"].max() < buffers.tensor_pieces
    assert len(renderer.triangles(0.02, width=300, height=300)) > 4 * len(t)


@pytest.mark.parametrize("precision,most", [("single", 2e-6), ("twice", 1e-14)])
def test_a_compute_shader_evaluates_as_the_processor_does(precision, most):
    rng = np.random.default_rng(3)
    surface = ff.Surface(rng.normal(size=(6, 7, 3)), (3, 4), weights=rng.uniform(0.5, 2, size=(6, 7)))
    shader = on_card(lambda: ff.SurfaceEvaluator(surface, precision))
    uv = rng.uniform(size=(1000, 2)) * [d.length for d in surface.domain] + [d.lo for d in surface.domain]
    expected = surface(uv[:, 0], uv[:, 1])
    points, normals = shader.with_normals(uv)
    assert np.abs(points - expected).max() < most * 8
    assert np.array_equal(points, shader(uv))
    n = np.cross(surface(uv[:, 0], uv[:, 1], (1, 0)), surface(uv[:, 0], uv[:, 1], (0, 1)))
    size = np.linalg.norm(n, axis=1)
    clear = size > 0.05 * size.max()  # elsewhere rounding leaves the direction
    assert clear.mean() > 0.1
    assert np.abs(normals[clear] - (n / size[:, None])[clear]).max() < most * 1e2
    assert shader([[0, 0]]).shape == (1, 3)


def test_what_cannot_be_done_is_refused():
    on_card(lambda: ff.shader_source("patch_vertex"))
    for make in (lambda: ff.SurfaceBuffers(BODY, 0), lambda: ff.SurfaceBuffers(BODY, np.nan),
                 lambda: ff.SurfaceBuffers(BODY, 1e-3, [BALL]), lambda: ff.SurfaceBuffers(BODY, 1e-3, colour="blue"),
                 lambda: ff.SurfaceBuffers(BODY, 1e-3, [ff.TriangularPatch([[0, 0], [1, 0], [0, 1]])]),
                 lambda: ff.shader_source("vertex"), lambda: ff.shader_source("grid_vertex", "hlsl")):
        with pytest.raises((ff.InvalidError, ff.UnsupportedError)):
            make()
    buffers = ff.SurfaceBuffers(BODY, 1e-3)
    renderer = on_card(lambda: ff.SurfaceRenderer(buffers))
    for draw in (lambda: renderer.draw(edges=True), lambda: renderer.draw(0), lambda: renderer.draw(colours=1),
                 lambda: ff.SurfaceRenderer(buffers, "grid").triangles(), lambda: ff.SurfaceRenderer(buffers, "mesh")):
        with pytest.raises((ff.InvalidError, ff.UnsupportedError)):
            draw()
    shader = on_card(lambda: ff.SurfaceEvaluator(BALL))
    for uv in ([[-1, 0]], [[0, np.nan]]):
        with pytest.raises(ff.OutOfDomainError):
            shader(uv)
    for uv in ([[0, 0, 0]], "x"):
        with pytest.raises(ff.InvalidError):
            shader(uv)


def test_the_example_of_the_guide_runs():
    names = {}
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "gpu.md").read_text(), re.S)
    assert len(blocks) == 1
    on_card(lambda: exec(compile(blocks[0], "docs/gpu.md", "exec"), names))
    assert names["picture"].shape == (200, 300, 3) and abs(np.linalg.norm(names["points"][0]) - 2) < 1e-14
