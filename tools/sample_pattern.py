"""Finds where in a pixel samples lie: `area_samples.h` and `sample_offsets.h` of `cpp/shaders/shared`,
`cpp/src/frame/sample_pattern.cpp`.

Among many scrambled (0, m, 2)-nets (Sobol' points with Owen's scrambling), keeps the one whose mean over the samples
errs least, in the root mean square, on straight edges at every angle and offset that cross the pixel. Of the largest
it tells as well how far pixels are off that are seen again in quarters where sixteen samples tell something else than
the others (`composite_points` of static decals).

Run: python tools/sample_pattern.py
"""

import numpy as np


def sobol_net(bits: int) -> np.ndarray:
    """The first two Sobol' dimensions as integers below 2^bits, shape (2^bits, 2)."""
    index = np.arange(1 << bits)
    reversed_bits = sum(((index >> bit) & 1) << (bits - 1 - bit) for bit in range(bits))
    second = np.zeros(1 << bits, dtype=np.int64)
    direction = 1 << (bits - 1)
    for bit in range(bits):
        second ^= np.where((index >> bit) & 1, direction, 0)
        direction ^= direction >> 1
    return np.stack([reversed_bits, second], axis=1)


def scramble(points: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Owen's nested scrambling: each bit is flipped or not by the bits above it. Integers, as `points`."""
    count = len(points)
    bits = count.bit_length() - 1
    result = np.zeros_like(points)
    for axis in range(2):
        flips = random.integers(0, 2, size=(bits, count))
        values = points[:, axis]
        for bit in range(bits):
            above = values >> (bits - bit)
            flipped = ((values >> (bits - 1 - bit)) & 1) ^ flips[bit, above]
            result[:, axis] |= flipped << (bits - 1 - bit)
    return result


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


def best_net(bits: int) -> tuple[np.ndarray, float, float]:
    """Columns and rows of the samples, (2^bits, 2); their error on straight edges: root mean square, largest."""
    random = np.random.default_rng(2020)
    normal, offsets, exact = edges(24)
    partly = (exact > 0) & (exact < 1)
    best, best_rms, worst = sobol_net(bits), np.inf, np.inf
    for _ in range(3000):
        net = scramble(sobol_net(bits), random)
        points = (net + 0.5) / len(net) - 0.5
        inside = (normal @ points.T)[:, None, :] <= offsets[:, :, None]
        error = (inside.mean(axis=2) - exact)[partly]
        rms = float(np.sqrt((error**2).mean()))
        if rms < best_rms:
            best, best_rms, worst = net, rms, float(np.abs(error).max())
    return best, best_rms, worst


def covered(points: np.ndarray, normal: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """Which points (n, 2) lie in each half plane, (n, edges)."""
    return points @ normal.T <= offset


def tell_quarters(points: np.ndarray) -> None:
    """Prints errors of 64 samples on random edges: alone, and with four times as many where they differ."""
    random = np.random.default_rng(7)
    angle, offset = random.uniform(0, 2 * np.pi, 40_000), random.uniform(-0.7, 0.7, 40_000)
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    fine = (np.arange(256) + 0.5) / 256 - 0.5
    steep = np.abs(normal).max(axis=1)
    flat = np.abs(normal).min(axis=1)
    # As in `edges`: turned so that each of 256 columns is cut at one height.
    exact = np.clip((offset - flat * fine[:, None]) / steep + 0.5, 0, 1).mean(axis=0)
    inside = covered(points, normal, offset)
    middles = np.array([(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)])
    quarters = np.concatenate([0.5 * points + middle for middle in middles])
    once, again = inside.mean(axis=0), covered(quarters, normal, offset).mean(axis=0)
    sixteen = inside.reshape(4, 16, -1).mean(axis=1)
    mixed = (once > 0) & (once < 1)
    for name, rough in (
        ("no pixels", np.zeros_like(mixed)),
        ("pixels whose sixteens differ by 0.03", sixteen.std(axis=0) > 0.03),
        ("all pixels with a border", mixed),
    ):
        error = np.abs(np.where(rough, again, once) - exact)
        rms = np.sqrt((error[mixed] ** 2).mean())
        share = rough[mixed].mean()
        print(f"{name} in quarters, {share:.0%}: rms {rms:.4f}, largest {error.max():.4f}")


def main() -> None:
    for bits in range(1, 7):
        net, rms, worst = best_net(bits)
        print(f"{len(net)} samples, on straight edges: rms {rms:.4f}, largest {worst:.4f}")
        print("rows by column:", ", ".join(str(row) for row in net[np.argsort(net[:, 0]), 1]))
        if bits < 5:
            continue
        offsets = (net + 0.5) / len(net) - 0.5
        for row in range(0, len(net), 3):
            print("   ", ", ".join(f"vec2({x:.7g}, {y:.7g})" for x, y in offsets[row : row + 3]))
        if len(net) == 64:
            tell_quarters(offsets)


if __name__ == "__main__":
    main()
