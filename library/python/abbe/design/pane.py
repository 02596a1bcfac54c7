"""A pane whose caustic is a picture: its cut face as a height field, by optimal transport.

Light comes down along -z onto the pane's flat back and leaves by the cut face z = h(x, y), whose
mean is z = 0; the screen is the plane z = -distance. The light is the sun, which stands over the
back, or a point lamp. Each part of the face sends its flux to a place of the screen, and the face
is sought where as much flux comes to each part of the picture as it wants: the Monge-Ampere
equation F = g(Y(x)) det DY(x), with Y the real ray map of h (both refractions, the face's own
height) and not its paraxial limit. Newton's method has the derivatives through the ray map; the
unknown is h itself, so the normals always are those of a surface.

Lengths are in metres; inside, y grows with the picture's rows, downwards. Reflected and absorbed
light, and the sun's disk, are not followed; Fresnel's losses are.
"""
import copy
import dataclasses

import numpy as np

BLURS = (0.25, 0.12, 0.06, 0.03, 0.015, 0.007, 0.003)  # of the picture's width, for the first steps
SUN_DEGREES = 0.533


class Refused(Exception):
    """A pane that cannot be; a sentence says why, and what would do."""


TURNED_BACK = ("the picture is too large, too near or too far aside: light would have to leave the glass "
               "beyond the critical angle; make --picture smaller or --distance larger")


def mirrored(values, factor):
    """values convolved by what multiplies its cosines: factor(ky, kx), radians a sample."""
    rows, columns = values.shape
    whole = np.block([[values, values[:, ::-1]], [values[::-1], values[::-1, ::-1]]])
    ky, kx = np.pi * np.fft.fftfreq(2 * rows)[:, None] * 2, np.pi * np.fft.rfftfreq(2 * columns) * 2
    return np.fft.irfft2(np.fft.rfft2(whole) * factor(ky, kx), whole.shape)[:rows, :columns]


def blurred(values, sigma):
    return mirrored(values, lambda ky, kx: np.exp(-0.5 * sigma**2 * (kx**2 + ky**2)))


def poisson(values):
    """The mean-free solution of the five-point Laplacian, sign turned, with no flux at the edges."""
    def inverse(ky, kx):
        out = 4 - 2 * np.cos(kx) - 2 * np.cos(ky)
        out[0, 0] = np.inf
        return 1 / out
    return mirrored(values, inverse)


def slopes(h, cell):
    down, right = np.gradient(h, *cell[::-1], edge_order=2)
    return right, down


def fresnel(cos_in, cos_out, n_in, n_out, faces=1):
    """The share of unpolarised light that a face lets through, or several that it meets alike."""
    across = (n_in * cos_in - n_out * cos_out) / (n_in * cos_in + n_out * cos_out)
    along = (n_out * cos_in - n_in * cos_out) / (n_out * cos_in + n_in * cos_out)
    return ((1 - across**2)**faces + (1 - along**2)**faces) / 2


@dataclasses.dataclass
class Setup:
    """What stands where. width: of the pane; picture: of the picture; lamp: None for the sun, or
    (x, y, z); shape: the target's rows and columns; cells: vertices across."""
    shape: tuple
    width: float
    distance: float
    thickness: float
    lamp: tuple = None
    picture: float = None
    cells: int = None

    def __post_init__(self):
        rows, columns = self.shape
        across = self.cells or columns
        down = max(round(across * rows / columns), 2)
        tall = self.width * rows / columns
        self.cell = self.width / (across - 1), tall / (down - 1)
        self.x, self.y = np.meshgrid(np.linspace(-0.5, 0.5, across) * self.width,
                                     np.linspace(-0.5, 0.5, down) * tall)
        self.middle = (0.0, 0.0)
        natural = self.width
        if self.lamp is not None:
            grow = (self.lamp[2] + self.distance) / self.lamp[2]
            natural *= grow
            self.middle = (self.lamp[0] * (1 - grow), -self.lamp[1] * (1 - grow))
        self.picture = self.picture or natural
        self.pixel = self.picture / columns

    def part(self, top, bottom, left, right):
        """The same pane for a part of the picture alone, pixels of it."""
        out, (rows, columns) = copy.copy(self), self.shape
        out.shape = bottom - top, right - left
        out.middle = (self.middle[0] + ((left + right) - columns) / 2 * self.pixel,
                      self.middle[1] + ((top + bottom) - rows) / 2 * self.pixel)
        return out

    def entry(self, h, n):
        """Inside: the direction (x, y, and down) of the ray to each place of the face, and the flux
        through a horizontal unit of it, W a W/m2 of the sun or a W/sr of the lamp."""
        if self.lamp is None:
            return 0 * h, 0 * h, 1 + 0 * h, np.full(h.shape, fresnel(1, 1, 1, n))
        dx, dy = self.x - self.lamp[0], self.y + self.lamp[1]
        far = np.maximum(np.hypot(dx, dy), 1e-12)
        air, glass = self.lamp[2] - self.thickness, self.thickness - h
        u = far / (air + glass / n)  # the tangent outside
        for _ in range(8):
            root = np.sqrt(n**2 + (n**2 - 1) * u**2)
            u = u - (air * u + glass * u / root - far) / (air + glass * n**2 / root**3)
        root = np.sqrt(n**2 + (n**2 - 1) * u**2)
        outside = 1 / np.sqrt(1 + u**2)
        sine = u * outside / n
        cosine = np.sqrt(1 - sine**2)
        flux = u * outside**3 / far / (air + glass * n**2 / root**3)
        return (sine * dx / far, sine * dy / far, cosine,
                flux * fresnel(outside, cosine, 1, n))

    def land(self, h, p, q, entry, n):
        """Where rays meet the screen, in pixels of the picture (column, row), for the slopes p, q;
        the flux that each place of the face sends there; and whether any was turned back, or starts
        behind the screen."""
        dx, dy, down, flux = entry
        long = np.sqrt(1 + p * p + q * q)
        cosine = (dx * p + dy * q + down) / long
        square = 1 - n**2 * (1 - cosine**2)
        out = np.sqrt(np.maximum(square, 1e-6))
        k = (out - n * cosine) / long
        far = (self.distance + h) / (n * down + k)
        rows, columns = self.shape
        return ((self.x + (n * dx + k * p) * far - self.middle[0]) / self.pixel + columns / 2,
                (self.y + (n * dy + k * q) * far - self.middle[1]) / self.pixel + rows / 2,
                flux * long * cosine / down * fresnel(cosine, out, n, 1),
                np.min(square) <= 1e-6 or np.min(h) <= -self.distance)


class Face:
    """A height field under its light: the ray map, its derivative, and what is made of them."""

    def __init__(self, setup, h, n):
        self.setup, self.h, self.n = setup, h, n
        self.entry = setup.entry(h, n)
        self.slope = slopes(h, setup.cell)
        self.u, self.v, self.flux, self.turned_back = setup.land(h, *self.slope, self.entry, n)

    def derivative(self):
        """d(u, v)/d(p, q) at each vertex, pixels a slope."""
        (p, q), step = self.slope, 1e-6
        right = self.setup.land(self.h, p + step, q, self.entry, self.n)
        down = self.setup.land(self.h, p, q + step, self.entry, self.n)
        return [(one[i] - (self.u, self.v)[i]) / step for i in (0, 1) for one in (right, down)]

    def cells(self):
        """Of each cell: its flux, and (u, v, their derivatives across and down) at 2 x 2 places."""
        places = []
        for s in (0.25, 0.75):
            for t in (0.25, 0.75):
                one = []
                for a in (self.u, self.v):
                    a, b, c, d = a[:-1, :-1], a[:-1, 1:], a[1:, :-1], a[1:, 1:]
                    one += [(1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d),
                            (1 - t) * (b - a) + t * (d - c), (1 - s) * (c - a) + s * (d - b)]
                places.append(one)
        return average(self.flux), places


def average(a):
    """Of vertices, at cells."""
    return (a[:-1, :-1] + a[:-1, 1:] + a[1:, :-1] + a[1:, 1:]) / 4


def spread(r):
    """Of cells, to their vertices."""
    out = np.zeros((r.shape[0] + 1, r.shape[1] + 1))
    for part in (out[:-1, :-1], out[:-1, 1:], out[1:, :-1], out[1:, 1:]):
        part += r / 4
    return out


def sampled(picture, u, v):
    """The picture between its pixels' centres; beyond its edges as at them."""
    rows, columns = picture.shape
    u, v = np.clip(u - 0.5, 0, columns - 1.001), np.clip(v - 0.5, 0, rows - 1.001)
    i, j = v.astype(int), u.astype(int)
    s, t = u - j, v - i
    flat, at = picture.ravel(), i * columns + j
    return ((1 - t) * ((1 - s) * flat[at] + s * flat[at + 1])
            + t * ((1 - s) * flat[at + columns] + s * flat[at + columns + 1]))


def shortfall(face, wanted):
    """What of each vertex' flux has no place in the picture, whose flux is wanted's sum; and the
    target's density at cells."""
    flux, places = face.cells()
    density, share = 0, 0
    for u, ux, uy, v, vx, vy in places:
        g = sampled(wanted, u, v)
        density, share = density + g / 4, share + g * (ux * vy - uy * vx) / 4
    r = spread(flux * (wanted.sum() / flux.sum()) - share)
    return r - r.mean(), density


def conductivity(face, density):
    """The symmetric part of -g adj(DY) dY/dp at cells: what a height's gradient moves, pixels'
    light across a cell's side."""
    uu, uv, vu, vv = (average(a) / cell for a, cell in zip(face.derivative(), 2 * face.setup.cell))
    step = [average(a) for a in (*np.gradient(face.u), *np.gradient(face.v))]
    uy, ux, vy, vx = step
    a = -density * (vy * uu - uy * vu)
    b = -density * (ux * vv - vx * uv)
    c = -density * (vy * uv - uy * vv + ux * vu - vx * uu) / 2
    least = 1e-3 * np.median(a + b)
    a, b = np.maximum(a, least), np.maximum(b, least)
    most = 0.95 * np.sqrt(a * b)
    return a, b, np.clip(c, -most, most)


def solve(a, b, c, r, tolerance=0.01, most=100):
    """Heights whose flux, -div of (a c; c b) grad, is r: conjugate gradients behind a scaled
    Laplacian."""
    def flow(h):
        across, down = np.diff(h, axis=1), np.diff(h, axis=0)
        right = (across[:-1] + across[1:]) / 2 * c
        below = (down[:, :-1] + down[:, 1:]) / 2 * c
        out = np.zeros_like(h)
        for rows in (np.s_[:-1], np.s_[1:]):
            f = (a * across[rows] + below) / 2
            out[rows][:, 1:] += f
            out[rows][:, :-1] -= f
            f = (b * down[:, rows] + right) / 2
            out[1:, rows] += f
            out[:-1, rows] -= f
        return out

    scale = 1 / np.sqrt(spread(a + b) / spread(np.ones_like(a)) / 2)
    h, before, enough = np.zeros_like(r), None, tolerance * np.linalg.norm(r)
    for _ in range(most):
        z = scale * poisson(scale * r)
        z -= z.mean()
        rz = np.vdot(r, z)
        step = z if before is None else z + step * (rz / before)
        before = rz
        moved = flow(step)
        alpha = rz / np.vdot(step, moved)
        h += alpha * step
        r = r - alpha * moved
        if np.linalg.norm(r) < enough:
            break
    return h - h.mean()


def rimmed(face):
    """The face with other heights at its rim, by which its edges land on the picture's."""
    setup, h = face.setup, face.h.copy()
    rows, columns = setup.shape
    uu, _, _, vv = face.derivative()
    p = face.slope[0] + (np.where(setup.x < 0, 0, columns) - face.u) / uu
    q = face.slope[1] + (np.where(setup.y < 0, 0, rows) - face.v) / vv
    for heights, slope, cell in ((h.T, p.T, setup.cell[0]), (h, q, setup.cell[1])):
        for k, step in ((0, -2 * cell), (-1, 2 * cell)):  # as slopes() has them
            near, far = (1, 2) if k == 0 else (-2, -3)
            heights[k] = (4 * heights[near] - heights[far] + step * slope[k]) / 3
    return Face(setup, h, face.n)


def newton(face, wanted, steps):
    """Steps towards the face that throws wanted, each as long as it leads nearer. Light of single
    cells may cross where the picture is dark; it is little, and later steps part it."""
    for _ in range(steps):
        r, density = shortfall(face, wanted)
        change = solve(*conductivity(face, density), r)
        for length in (1, 0.5, 0.25, 0.12, 0.06, 0.03):
            new = rimmed(Face(face.setup, face.h + length * change, face.n))
            left, _ = shortfall(new, wanted)
            if not new.turned_back and np.linalg.norm(left) < np.linalg.norm(r):
                face = new
                break
        else:
            if new.turned_back:
                raise Refused(TURNED_BACK)
            break
    return face


def reachable(face, target):
    """Refuses a target that no cut throws. Whatever map lays the light out, some of it goes as far
    aside as quantiles of the pane's and the target's columns, or rows, are apart; a face bends no
    ray by more than the critical angle's complement."""
    setup, flux = face.setup, average(face.flux)
    aside = 0
    for axis, at in ((0, setup.x[0]), (1, setup.y[:, 0])):
        has, wants = (np.append(0, np.cumsum(a.sum(axis))) for a in (flux, target))
        has, wants = has / has[-1], wants / wants[-1]
        side = target.shape[1 - axis]
        where = setup.middle[axis] + (np.arange(side + 1) - side / 2) * setup.pixel
        share = np.union1d(has, wants)
        aside = max(aside, np.abs(np.interp(share, wants, where) - np.interp(share, has, at)).max())
    steepest = np.arccos(face.entry[2].min()) + np.arccos(1 / face.n)
    if steepest < np.pi / 2 and aside > (setup.distance + setup.thickness) * np.tan(steepest):
        raise Refused(f"light has to go {1e3 * aside:.3g} mm aside, further than glass can bend it up to "
                      "the critical angle; make --distance much larger than "
                      f"{1e3 * aside / np.tan(steepest):.3g} mm")


def start(setup, n):
    """The smooth face that lays the pane's rectangle onto the picture's."""
    face = Face(setup, np.zeros_like(setup.x), n)
    rows, columns = setup.shape
    u = (setup.x / setup.width + 0.5) * columns
    v = (setup.y / np.ptp(setup.y) + 0.5) * rows
    for _ in range(8):
        uu, uv, vu, vv = face.derivative()
        if face.turned_back:
            break
        det = uu * vv - uv * vu
        p = face.slope[0] + ((u - face.u) * vv - (v - face.v) * uv) / det
        q = face.slope[1] + ((v - face.v) * uu - (u - face.u) * vu) / det
        across, down = ((p[:, :-1] + p[:, 1:]) / 2 * setup.cell[0],
                        (q[:-1] + q[1:]) / 2 * setup.cell[1])
        out = np.zeros_like(p)  # least squares: the divergence of what the edges want
        out[:, 1:] += across
        out[:, :-1] -= across
        out[1:] += down
        out[:-1] -= down
        face = Face(setup, poisson(out), n)
    return face


def thrown(face, fineness=4):
    """The picture that the face throws, flux a pixel: each cell in as many parts as it takes for
    one to be no larger than 1/fineness of a pixel, each laid as a square onto up to four pixels."""
    rows, columns = face.setup.shape
    _, places = face.cells()
    side = np.max([np.maximum(np.hypot(ux, vx), np.hypot(uy, vy))
                   for _, ux, uy, _, vx, vy in places], axis=0)
    parts = np.exp2(np.ceil(np.log2(np.clip(side * fineness, 1, 64)))).astype(int)
    flux, out = average(face.flux), np.zeros((rows + 2) * (columns + 2))
    corners = [(a[:-1, :-1], a[:-1, 1:], a[1:, :-1], a[1:, 1:]) for a in (face.u, face.v)]
    for count in np.unique(parts):
        these = parts == count
        t = ((np.arange(count) + 0.5) / count)[:, None, None]
        s = t.reshape(1, count, 1)
        u, v = (((1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d)).ravel()
                for a, b, c, d in ([one[these] for one in four] for four in corners))
        size = np.broadcast_to(np.maximum(side[these] / count, 1e-9), (count, count, these.sum())).ravel()
        light = np.broadcast_to(flux[these] / count**2, (count, count, these.sum())).ravel()
        keep = (u > -1) & (u < columns + 1) & (v > -1) & (v < rows + 1)
        u, v, size, light = u[keep] + 0.5, v[keep] + 0.5, size[keep], light[keep]
        j, i = u.astype(int), v.astype(int)
        s = np.clip((u - j - 0.5) / size + 0.5, 0, 1)
        t = np.clip((v - i - 0.5) / size + 0.5, 0, 1)
        where = i * (columns + 2) + j
        for step, share in ((0, (1 - t) * (1 - s)), (1, (1 - t) * s), (columns + 2, t * (1 - s)),
                            (columns + 3, t * s)):
            out += np.bincount(where + step, light * share, len(out) + columns + 3)[:len(out)]
    return out.reshape(rows + 2, columns + 2)[1:-1, 1:-1]


def dip_radius(face):
    """The least radius of curvature that a tool from the screen's side has to fit into, m."""
    cell = face.setup.cell
    (pp, pq), (_, qq) = slopes(face.slope[0], cell), slopes(face.slope[1], cell)
    most = -((pp + qq) / 2 - np.sqrt((pp - qq)**2 / 4 + pq**2)).min()
    return 1 / max(most, 1e-12)


def encoded(linear):
    """sRGB's curve."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - 0.055)


def decoded(values):
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055)**2.4)


def error(seen, target):
    return np.linalg.norm(encoded(seen / target.max()) - encoded(target / target.max()))


def design(target, setup, n, refine=3, progress=None):
    """The face that throws target, light a pixel in units of the even light's, above 0 everywhere,
    with the index n. refine: how often what it throws is compared with the target, and the density
    that is sought is corrected; the best face of all is kept. progress is called with the share
    done and the face, whose depth and bends grow with the picture's details."""
    columns = target.shape[1]
    blurs = [blur * columns for blur in BLURS if blur * columns > 0.3]
    stages = [(blurred(target, blur), 2) for blur in blurs] + [(target, 6)]
    reachable(Face(setup, np.zeros_like(setup.x), n), target)
    face = start(setup, n)
    if face.turned_back:
        raise Refused(TURNED_BACK)
    for done, stage in enumerate(stages):
        face = newton(face, *stage)
        if progress:
            progress((done + 1) / (len(stages) + refine), face)
    best, wanted, least = face, target, np.inf
    for done in range(refine + 1):
        seen = thrown(face)
        seen *= target.sum() / seen.sum()
        now = error(seen, target)
        if now < least:
            best, least = face, now
        if done == refine:
            return best
        ratio = blurred(target, 0.9) / np.maximum(blurred(seen, 0.9), 1e-6)
        wanted = wanted * np.clip(ratio, 0.5, 2)**0.5
        face = newton(face, wanted * (target.sum() / wanted.sum()), 2)
        if progress:
            progress((len(stages) + done + 1) / (len(stages) + refine), face)
