"""Finds the 32 sample positions of `cpp/shaders/shared/sample_offsets.h`.

Among many scrambled (0, 5, 2)-nets (Sobol' points with Owen's scrambling), keeps the one whose mean over the samples
errs least, in the root mean square, on straight edges at every angle and offset that cross the pixel.

Run: python tools/sample_pattern.py
"""

import numpy as np

BITS = 5
COUNT = 1 << BITS


def sobol_net() -> np.ndarray:
    """The first two Sobol' dimensions as integers below 2^5, shape (32, 2)."""
    index = np.arange(COUNT)
    reversed_bits = sum(((index >> bit) & 1) << (BITS - 1 - bit) for bit in range(BITS))
    second = np.zeros(COUNT, dtype=np.int64)
    direction = 1 << (BITS - 1)
    for bit in range(BITS):
        second ^= np.where((index >> bit) & 1, direction, 0)
        direction ^= direction >> 1
    return np.stack([reversed_bits, second], axis=1)


def scramble(points: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Owen's nested scrambling: each bit is flipped or not by the bits above it; then a place inside the stratum."""
    result = np.empty(points.shape)
    for axis in range(2):
        flips = random.integers(0, 2, size=(BITS, COUNT))
        values = points[:, axis].copy()
        scrambled = np.zeros_like(values)
        for bit in range(BITS):
            above = values >> (BITS - bit)
            flipped = ((values >> (BITS - 1 - bit)) & 1) ^ flips[bit, above]
            scrambled |= flipped << (BITS - 1 - bit)
        result[:, axis] = (scrambled + 0.5) / COUNT
    return result - 0.5


def edges(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit normals, offsets and exact coverages of half planes that cross the unit square."""
    angle = (np.arange(count) + 0.5) / count * np.pi / 4
    turns = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    angles = (turns[:, None] + angle).ravel()
    normal = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    reach = 0.5 * np.abs(normal).sum(axis=1)
    offsets = np.linspace(-1, 1, 41)[None, :] * reach[:, None]
    fine = (np.arange(256) + 0.5) / 256 - 0.5
    # A half plane cuts each column of the square at one height: exact along y, 256 columns along x.
    flip = np.abs(normal[:, 0]) > np.abs(normal[:, 1])
    n0 = np.where(flip, normal[:, 1], normal[:, 0])
    n1 = np.where(flip, normal[:, 0], normal[:, 1])
    height = (offsets[:, :, None] - n0[:, None, None] * fine) / n1[:, None, None]
    below = np.clip(height + 0.5, 0, 1)
    exact = np.where(n1[:, None, None] > 0, below, 1 - below).mean(axis=2)
    return normal, offsets, exact


def main() -> None:
    random = np.random.default_rng(2020)
    normal, offsets, exact = edges(24)
    partly = (exact > 0) & (exact < 1)
    best, best_error = None, np.inf
    for _ in range(3000):
        points = scramble(sobol_net(), random)
        inside = (normal @ points.T)[:, None, :] <= offsets[:, :, None]
        error = (inside.mean(axis=2) - exact)[partly]
        rms = float(np.sqrt((error**2).mean()))
        if rms < best_error:
            best, best_error, worst = points, rms, float(np.abs(error).max())
    assert best is not None
    print(f"// straight edges: rms {best_error:.4f}, largest {worst:.4f}")
    for row in range(0, COUNT, 4):
        print(
            "    "
            + ", ".join(f"vec2({x:.6f}, {y:.6f})" for x, y in best[row : row + 4])
            + (", \\" if row < 28 else "")
        )


if __name__ == "__main__":
    main()
