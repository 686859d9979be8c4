"""The teapot and the sweep: closed where they should be, facing outward, without empty triangles."""

import numpy as np
from numpy.testing import assert_allclose

from halfway.render.mesh import Mesh, outward, placed, sweep
from halfway.render.scenes import Placed
from halfway.render.teapot import PROFILES, TUBES, bezier, tangent, tessellate


def face_normals(mesh: Mesh) -> np.ndarray:
    """Across each triangle, as long as twice its area."""
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return np.cross(b - a, c - a)


def test_known_points_of_the_published_data():
    mesh = tessellate(4)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    assert_allclose([low[2], high[2]], [0, 3.15], atol=1e-6)  # foot and knob
    assert_allclose([low[0], high[1]], [-3, 2], atol=0.08)  # handle, widest at the belly


def test_profiles_join_where_the_pot_is_smooth():
    for upper, lower in [(1, 2), (3, 4)]:
        assert_allclose(PROFILES[upper][-1], PROFILES[lower][0])
        t = [tangent(PROFILES[i], np.array([end]))[0] for i, end in [(upper, 1.0), (lower, 0.0)]]
        assert_allclose(t[0][0] * t[1][1], t[0][1] * t[1][0], atol=1e-12)
    for first, second in [(0, 1), (2, 3)]:
        assert_allclose(TUBES[first][-1], TUBES[second][0])


def test_no_triangle_is_empty_and_normals_agree_with_the_faces():
    mesh = tessellate(8)
    across = face_normals(mesh)
    area = np.linalg.norm(across, axis=1)
    assert area.min() > 1e-4
    assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, rtol=1e-6)
    facing = np.einsum("ij,ikj->ik", across / area[:, None], mesh.normals[mesh.faces])
    assert facing.min() > 0


def test_the_body_faces_outward():
    mesh = tessellate(8)
    belly = (mesh.positions[:, 2] > 0.3) & (np.hypot(*mesh.positions[:, :2].T) > 1.7)
    belly &= np.abs(mesh.positions[:, 1]) > 0.7  # neither handle nor spout
    assert (np.einsum("ij,ij->i", mesh.positions[belly, :2], mesh.normals[belly, :2]) > 0).all()
    assert (mesh.normals[mesh.positions[:, 2] < 1e-6, 2] < -0.9).all()  # the foot
    assert (mesh.normals[mesh.positions[:, 2] > 3.149, 2] > 0.9).all()  # the knob


def test_a_bezier_curve_begins_and_ends_at_its_control_points():
    control = np.random.default_rng(0).random((4, 3))
    assert_allclose(bezier(control, np.array([0.0, 1.0])), control[[0, 3]])
    t = np.linspace(0, 1, 5)
    slope = (bezier(control, t + 1e-6) - bezier(control, t - 1e-6)) / 2e-6
    assert_allclose(tangent(control, t), slope, rtol=1e-6, atol=1e-8)


def test_placing_scales_to_the_height_and_stands_on_the_ground():
    mesh = placed(
        tessellate(4), Placed("teapot", at=(1.0, 2.0, 0.5), height=2.0, turn_degrees=90.0)
    )
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    assert_allclose([low[2], high[2]], [0.5, 2.5], atol=1e-6)
    assert_allclose((low + high)[:2] / 2, [1, 2], atol=1e-6)
    assert high[1] - low[1] > high[0] - low[0]  # the spout now points away


def test_a_mesh_that_is_inside_out_is_turned():
    mesh = tessellate(4)
    y_up = mesh.positions[:, [0, 2, 1]] * np.array([1, 1, -1])
    for faces in (mesh.faces, mesh.faces[:, ::-1]):
        turned = outward(y_up, np.zeros(y_up.shape), faces)
        assert_allclose(turned.positions, mesh.positions)
        agree = np.einsum("ij,ij->i", turned.normals, mesh.normals)
        assert np.median(agree) > 0.9


def test_the_sweep_faces_the_camera():
    across = face_normals(sweep())
    assert (across @ np.array([0, -1, 1]) > 0).all()
