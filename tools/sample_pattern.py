"""Finds where in a pixel samples lie: `area_samples.h` and `sample_offsets.h` of `cpp/shaders/shared`,
`cpp/src/frame/sample_pattern.cpp`.

Among many scrambled (0, m, 2)-nets (Sobol' points with Owen's scrambling), keeps the one whose mean over the samples
errs least, in the root mean square, on straight edges at every angle and offset that cross the pixel. Of the largest
it tells as well how far pixels are off whose samples differ and are followed by others along the border
(`composite_points` of static decals).

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


def followed(growth: np.ndarray, count: int) -> np.ndarray:
    """`sample_place` of `cpp/shaders/shared` for borders (n, 2): places (count, n, 2)."""
    normal = growth / np.abs(growth).sum(axis=1, keepdims=True)
    wide = np.abs(normal).max(axis=1)
    narrow = 1 - wide
    share = (np.arange(count)[:, None] + 0.5) / count
    least = np.minimum(share, 1 - share)
    corner = np.where(
        2 * least * wide < narrow, np.sqrt(2 * least * wide * narrow), least * wide + narrow / 2
    )
    across = np.where(share < 0.5, corner - 0.5, 0.5 - corner) / (normal**2).sum(axis=1)
    middle = across[..., None] * normal
    along = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    along = np.where(np.abs(along) < 1e-6, 1e-6, along)
    ends = np.stack([(-0.5 - middle) / along, (0.5 - middle) / along])
    begin, end = ends.min(axis=0).max(axis=-1), ends.max(axis=0).min(axis=-1)
    place = np.array([(int(f"{i:016b}"[::-1], 2) + 0.5) / 65536 for i in range(count)])
    return middle + along * (begin + (end - begin) * place[:, None])[..., None]


def tell_followed(points: np.ndarray) -> None:
    """Prints errors on random edges of samples that follow the border as 64 see it."""
    random = np.random.default_rng(7)
    angle, offset = random.uniform(0, 2 * np.pi, 40_000), random.uniform(-0.7, 0.7, 40_000)
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    fine = (np.arange(256) + 0.5) / 256 - 0.5
    steep = np.abs(normal).max(axis=1)
    flat = np.abs(normal).min(axis=1)
    # As in `edges`: turned so that each of 256 columns is cut at one height.
    exact = np.clip((offset - flat * fine[:, None]) / steep + 0.5, 0, 1).mean(axis=0)
    inside = points @ normal.T <= offset
    mixed = inside.any(axis=0) & ~inside.all(axis=0)
    weight = np.maximum(0.45 - (points**2).sum(axis=1), 0.0)
    growth = (inside * weight[:, None]).T[mixed] @ points
    found = inside.mean(axis=0)
    for count in (64, 128, 192):
        again = (followed(growth, count) * normal[mixed]).sum(axis=-1) <= offset[mixed]
        found[mixed] = again.mean(axis=0)
        error = np.abs(found - exact)
        rms = float(np.sqrt((error[mixed] ** 2).mean()))
        print(f"{count} samples that follow the border: rms {rms:.4f}, largest {error.max():.4f}")


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
            tell_followed(offsets)


if __name__ == "__main__":
    main()
