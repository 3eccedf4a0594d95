"""Surfaces and trajectories that tests share."""

from __future__ import annotations

import numpy as np

from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.footprint import Footprint, ring
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.samples import SurfaceSamples

TARGET = 50e-6


def plate(count: int, size: float = 1.0) -> SurfaceSamples:
    """A square plate in the plane z = 0, its normals up, with count² points."""
    x = np.linspace(0.0, size, count)
    X, Y = np.meshgrid(x, x, indexing="ij")
    points = np.stack((X.ravel(), Y.ravel(), np.zeros(count**2)), axis=1)
    width = np.full(count, size / (count - 1))
    width[[0, -1]] *= 0.5
    return SurfaceSamples(
        points, np.tile((0.0, 0.0, 1.0), (count**2, 1)), np.outer(width, width).ravel()
    )


def bumpy(count: int, seed: int) -> SurfaceSamples:
    """A smooth rolling surface with true normals."""
    rng = np.random.default_rng(seed)
    flat = plate(count)
    a, b, c, d = rng.uniform(-0.05, 0.05, 4)
    x, y = flat.points[:, 0], flat.points[:, 1]
    z = a * np.sin(4 * x) + b * np.cos(5 * y) + c * np.sin(3 * x + 2 * y + d)
    by_x = 4 * a * np.cos(4 * x) + 3 * c * np.cos(3 * x + 2 * y + d)
    by_y = -5 * b * np.sin(5 * y) + 2 * c * np.cos(3 * x + 2 * y + d)
    normals = np.stack((-by_x, -by_y, np.ones(len(x))), axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return SurfaceSamples(np.stack((x, y, z), axis=1), normals, flat.areas)


def sweeps(
    count: int = 6, width: float = 0.18, overhang: float = 0.1, longest: float = 0.1
) -> PaintTrajectory:
    """Parallel sweeps over the metre plate, painting in the turns, square to it from 0.25 m."""
    middle = 0.5 + (np.arange(count) - 0.5 * (count - 1)) * width
    along = np.linspace(
        -overhang, 1 + overhang, 1 + int(np.ceil((1 + 2 * overhang) / longest - 1e-9))
    )
    turn = np.arange(1, int(np.ceil(width / longest - 1e-9)))
    points: list[tuple[float, float]] = []
    for k, y in enumerate(middle):
        way = along[::-1] if k % 2 else along
        if k:
            points += [(way[0], y - width + t * width / (len(turn) + 1)) for t in turn]
        points += [(x, y) for x in way]
    position = np.column_stack((np.array(points), np.full(len(points), 0.25)))
    return PaintTrajectory.at_speed(position, np.tile((0.0, 0.0, -1.0), (len(points), 1)), 0.25)


def plate_case(radius: float, count: int) -> tuple[Deposition, PaintTrajectory]:
    """Plate and sweeps, the flow scaled so that 0.25 m/s gives the target on average."""
    trajectory, samples = sweeps(), plate(count)
    found = Deposition(samples, ring(radius)).thickness(trajectory)
    mean = float(samples.areas @ found) / samples.area
    return Deposition(samples, ring(radius).scaled(TARGET / mean)), trajectory


def wandering(waypoints: int, seed: int, fan: bool = False) -> PaintTrajectory:
    """A trajectory over the metre plate with tilted nozzles and uneven flow."""
    rng = np.random.default_rng(seed)
    position = np.column_stack(
        (
            np.linspace(0.2, 0.8, waypoints) + rng.uniform(-0.05, 0.05, waypoints),
            rng.uniform(0.2, 0.8, waypoints),
            rng.uniform(0.2, 0.3, waypoints),
        )
    )
    nozzle = np.column_stack((rng.uniform(-0.3, 0.3, (waypoints, 2)), -np.ones(waypoints)))
    nozzle /= np.linalg.norm(nozzle, axis=1, keepdims=True)
    axis = np.column_stack((np.ones(waypoints), rng.uniform(-0.5, 0.5, (waypoints, 2))))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return PaintTrajectory(
        position,
        nozzle,
        rng.uniform(0.3, 1.0, waypoints - 1),
        rng.uniform(0.5, 1.5, waypoints - 1),
        axis if fan else None,
    )


def fan_footprint(aspect: float = 2.0) -> Footprint:
    """An elliptic footprint with a piece of every kind: dip, peak, tail."""
    return Footprint.of_cone(
        (0.0, 0.05, 0.12, 0.2),
        (4e-5, 9e-5, 5e-5, 0.0),
        0.25,
        0.03,
        slopes=(0.0, 2e-4, -8e-4, 0.0),
        aspect=aspect,
    )
