"""How far the pressure under a ball on a block of finite size is from that of Hertz.

    hertz_bodies.py [--cells N] [--size L]

The bodies are those of the decks that compare_speed.py runs, as bodies of revolution: a paraboloid of the radius 100,
which becomes flat at the height L, on a cylinder of the same size, both of steel, pressed together by 0.62 at small
strain. They have four-node quadrilaterals, N on the radius 8 and growing ones beyond 12, and nodes that match. All but
the lines in contact is eliminated line by line, which leaves how far each node of them moves under a unit force at
another one; forces are then found by the set of nodes that touch. Nothing of this is signorini's.

Told is the pressure at the nodes nearest to the axis over that of Hertz there, at the force that was found: for N, its
half, and L four times as large. That on the axis itself, which belongs to a disc, is left out. The p0 that fits all
with r < 0.8 a best, by least squares over the area, is told, too.

Needs: numpy. Exit code: 0; 2 wrong command line
"""

import argparse
import math

import numpy as np

from accuracy import INNER, hertz

YOUNG, POISSON = 210000.0, 0.3
RADIUS, CONTACT, APPROACH = 100.0, 8.0, 0.62
# each cell beyond the fine ones over the one before it
GROWTH = 1.12
# nodes beside the axis of which the pressure is told
NODES = 3
MODULUS = 0.5 * YOUNG / (1.0 - POISSON**2)
STIFFNESS = YOUNG / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
# of the strains r, hoop, z, rz
LAW = STIFFNESS * np.array(
    [
        [1.0 - POISSON, POISSON, POISSON, 0.0],
        [POISSON, 1.0 - POISSON, POISSON, 0.0],
        [POISSON, POISSON, 1.0 - POISSON, 0.0],
        [0.0, 0.0, 0.0, 0.5 - POISSON],
    ]
)


def lines(fine, count, size):
    """From 0 to the size: so many of the fine distance, then growing ones."""
    found = [fine * k for k in range(count + 1)]
    step = fine
    while found[-1] < size:
        step *= GROWTH
        found.append(found[-1] + step)
    found, start = np.array(found), fine * count
    beyond = found > start
    found[beyond] = start + (found[beyond] - start) * (size - start) / (found[-1] - start)
    return found


def stiffness(x):
    """Of quadrilaterals with the corners x, as (element, corner, r or z): one matrix of 8 by 8 each."""
    matrices = np.zeros((len(x), 8, 8))
    at = 1.0 / math.sqrt(3.0)
    for a in (-at, at):
        for b in (-at, at):
            shape = 0.25 * np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)])
            slopes = 0.25 * np.array([[b - 1, 1 - b, 1 + b, -1 - b], [a - 1, -1 - a, 1 + a, 1 - a]])
            jacobian = np.einsum("ai,eij->eaj", slopes, x)
            gradient = np.einsum("eaj,ji->eai", np.linalg.inv(jacobian), slopes)
            r = x[:, :, 0] @ shape
            strain = np.zeros((len(x), 4, 8))
            strain[:, 0, 0::2] = gradient[:, 0]
            strain[:, 1, 0::2] = shape / r[:, None]
            strain[:, 2, 1::2] = gradient[:, 1]
            strain[:, 3, 0::2] = gradient[:, 1]
            strain[:, 3, 1::2] = gradient[:, 0]
            volume = 2.0 * math.pi * r * np.abs(np.linalg.det(jacobian))
            matrices += np.einsum("eai,ab,ebj,e->eij", strain, LAW, strain, volume)
    return matrices


def flexibility(across, up, place):
    """How far nodes of the first line move along z under unit forces along z, where the last line does not."""
    nodes, rows = len(across), len(up)
    x = place(*np.meshgrid(across, up))
    own = [np.zeros((2 * nodes, 2 * nodes)) for _ in range(rows)]
    beside = [np.zeros((2 * nodes, 2 * nodes)) for _ in range(rows - 1)]
    for k in range(rows - 1):
        corners = np.stack([x[k, :-1], x[k, 1:], x[k + 1, 1:], x[k + 1, :-1]], axis=1)
        for e, matrix in enumerate(stiffness(corners)):
            low, high = np.arange(2 * e, 2 * e + 4), np.array([2 * e + 2, 2 * e + 3, 2 * e, 2 * e + 1])
            own[k][np.ix_(low, low)] += matrix[:4, :4]
            own[k + 1][np.ix_(high, high)] += matrix[4:, 4:]
            beside[k][np.ix_(low, high)] += matrix[:4, 4:]
    # nodes on the axis do not leave it
    free = np.arange(1, 2 * nodes)
    behind = np.arange(2, 2 * nodes, 2)
    rest = own[-1][np.ix_(behind, behind)]
    for k in range(rows - 2, -1, -1):
        coupling = beside[k][np.ix_(free, behind)]
        rest = own[k][np.ix_(free, free)] - coupling @ np.linalg.solve(rest, coupling.T)
        behind = free
    along = np.arange(0, 2 * nodes - 1, 2)
    return np.linalg.inv(rest)[np.ix_(along, along)]


def pressed(cells, size):
    """The pressures at the first nodes beside the axis, over those of Hertz, and the p0 that fits over that of Hertz."""
    fine = CONTACT / cells
    across, up = lines(fine, 3 * cells // 2, size), lines(fine, 3 * cells // 4, size)

    def ball(r, z):
        height = r**2 / (2.0 * RADIUS)
        return np.stack([r, z + height * (1.0 - z / size)], axis=-1)

    def block(r, z):
        return np.stack([r, -z], axis=-1)

    both = flexibility(across, up, ball) + flexibility(across, up, block)
    gap = across**2 / (2.0 * RADIUS) - APPROACH
    touches = gap < 0.0
    while True:
        force = np.zeros(len(across))
        force[touches] = np.linalg.solve(both[np.ix_(touches, touches)], -gap[touches])
        now = np.where(touches, force > 0.0, gap + both @ force < 0.0)
        if (now == touches).all():
            break
        touches = now
    step = np.diff(across)
    area = np.zeros(len(across))
    area[:-1] += 2.0 * math.pi * step * (across[:-1] / 2.0 + step / 6.0)
    area[1:] += 2.0 * math.pi * step * (across[:-1] / 2.0 + step / 3.0)
    p0, a = hertz(force.sum(), RADIUS, MODULUS)
    told, inner = slice(1, 1 + NODES), across < INNER * a
    exact = p0 * np.sqrt(np.maximum(0.0, 1.0 - (across / a) ** 2))
    shape = exact[inner]
    return force[told] / area[told] / exact[told], force[inner] @ shape / (area[inner] @ shape**2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=64, help="cells on the radius of contact")
    parser.add_argument("--size", type=float, default=64.0, help="size of the bodies")
    options = parser.parse_args()
    if options.cells < 4 or options.size <= 1.5 * CONTACT:
        parser.error(f"at least 4 cells, and a size above {1.5 * CONTACT:g}")
    cells, size = options.cells, options.size
    for cells, size in ((cells // 2, size), (cells, size), (cells, 4.0 * size)):
        ratios, fitted = pressed(cells, size)
        off = " ".join(f"{ratio - 1.0:+.2%}" for ratio in ratios)
        print(f"{cells} cells on the radius, size {size:g}: {off} off Hertz, fitted {fitted - 1.0:+.2%}")


if __name__ == "__main__":
    main()
