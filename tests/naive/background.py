"""Backgrounds made by hand, and the look-up written as one would say it."""

import numpy as np

from surfmesh._core.fields import Background


def uniform_background(inverse: np.ndarray, width: float, height: float, largest: float = 1e30):
    """One level of cells over [0, width] x [0, height] from node values.

    inverse (ny + 1, nx + 1, 3 or 4): A = H^-1 at the nodes, and 1 / h (1 when left out).
    """
    ny, nx = inverse.shape[0] - 1, inverse.shape[1] - 1
    if inverse.shape[2] == 3:
        inverse = np.concatenate([inverse, np.ones((ny + 1, nx + 1, 1))], axis=2)
    j, i = np.divmod(np.arange(nx * ny), nx)
    first = j * (nx + 1) + i
    corner = np.stack([first, first + 1, first + nx + 1, first + nx + 2], axis=1)
    return Background(
        np.array([0.0, 0.0, nx / width, ny / height, largest]),
        np.array([nx, ny]),
        np.full(nx * ny, -1, np.int32),
        corner.astype(np.int32),
        np.ascontiguousarray(inverse.reshape(-1, 4), float),
    )


def constant_background(h: np.ndarray | float, width: float, height: float) -> Background:
    """The size tensor h (2, 2), or the size h, everywhere."""
    a = np.linalg.inv(np.asarray(h, float) * np.eye(2) if np.ndim(h) == 0 else h)
    scale = 1.0 / np.sqrt(np.linalg.det(np.linalg.inv(a)))
    return uniform_background(np.tile([a[0, 0], a[0, 1], a[1, 1], scale], (2, 2, 1)), width, height)


def random_background(
    seed: int,
    cells: int,
    ratio: float = 1.0,
    stretch: float = 1.0,
    size: float = 0.1,
    width: float = 1.0,
    height: float = 1.0,
) -> Background:
    """Random SPD tensors at the nodes.

    Sizes between size / sqrt(ratio) and size * sqrt(ratio), independently from node to node;
    the two axes of each differ by up to ``stretch``, in a random direction.
    """
    rng = np.random.default_rng(seed)
    shape = (cells + 1, cells + 1)
    h = size * ratio ** rng.uniform(-0.5, 0.5, shape)
    longer = stretch ** rng.uniform(-0.5, 0.5, shape)
    angle = rng.uniform(0.0, np.pi, shape)
    c, s = np.cos(angle), np.sin(angle)
    p, q = longer / h, 1.0 / (longer * h)  # eigenvalues of A
    a = np.stack([p * c * c + q * s * s, (p - q) * c * s, p * s * s + q * c * c, 1.0 / h], axis=-1)
    return uniform_background(a, width, height)


def random_tree(seed: int, nx: int, ny: int, splits: int, largest: float = 1e30):
    """A forest of quadtrees over [0, 1]^2 with unrelated random tensors at all corners."""
    rng = np.random.default_rng(seed)
    child = [-1] * (nx * ny)
    leaves = list(range(nx * ny))
    for _ in range(splits):
        leaf = leaves.pop(int(rng.integers(len(leaves))))
        child[leaf] = len(child)
        leaves += range(len(child), len(child) + 4)
        child += [-1] * 4
    corner = np.arange(4 * len(child), dtype=np.int32).reshape(-1, 4)  # nothing is shared
    m = rng.normal(size=(4 * len(child), 2, 2))
    a = m @ m.transpose(0, 2, 1) + 1e-3 * np.eye(2)
    inverse = np.stack([a[:, 0, 0], a[:, 0, 1], a[:, 1, 1], rng.uniform(1, 9, len(a))], axis=1)
    return Background(
        np.array([0.0, 0.0, nx, ny, largest], float),
        np.array([nx, ny]),
        np.array(child, np.int32),
        corner,
        inverse,
    )


def replaced(background: Background, **arrays: np.ndarray) -> Background:
    """The same but for the ``arrays`` given by name."""
    names = ("box", "grid", "child", "corner", "metric_root", "metric_root_3d")
    kept = {name: getattr(background, name) for name in names}
    if not background.is_anisotropic:
        del kept["metric_root_3d"]
    return Background(**(kept | arrays))


def looked_up(background: Background, x: float, y: float) -> np.ndarray:
    """(A11, A12, A22, 1 / h) at a point: from the root cell down, then bilinear."""
    nx, ny = background.grid
    x0, y0, across, up = background.box[:4]
    x = np.clip(x, x0, x0 + nx / across)
    y = np.clip(y, y0, y0 + ny / up)
    i = min(int((x - x0) * across), nx - 1)
    j = min(int((y - y0) * up), ny - 1)

    def descend(cell, left, bottom, width, height):
        first = background.child[cell]
        if first < 0:
            s, t = (x - left) / width, (y - bottom) / height
            v = background.metric_root[background.corner[cell]]
            return (1 - t) * ((1 - s) * v[0] + s * v[1]) + t * ((1 - s) * v[2] + s * v[3])
        right, top = x >= left + width / 2, y >= bottom + height / 2
        return descend(
            first + right + 2 * top,
            left + right * width / 2,
            bottom + top * height / 2,
            width / 2,
            height / 2,
        )

    return descend(j * nx + i, x0 + i / across, y0 + j / up, 1 / across, 1 / up)


def capped_inverse(a: np.ndarray, largest: float) -> np.ndarray:
    """A^-1 (2, 2) with the eigenvalues of A raised to 1 / largest."""
    values, vectors = np.linalg.eigh(a)
    return vectors @ np.diag(1.0 / np.maximum(values, 1.0 / largest)) @ vectors.T
