"""`abbe design`: lenses, prisms and pairs by closed forms; panes by their own light and traced."""
import contextlib
import io
import math
import os
import unittest

import numpy as np

import abbe
from abbe.design import __main__ as command
from abbe.design import pane, prism, solid

N = 1.49
ROWS, COLUMNS = 24, 32


def hill():
    """A bright place on a darker ground, from 0 to 1."""
    y, x = np.mgrid[:ROWS, :COLUMNS]
    return 0.15 + 0.85 * np.exp(-((x - 10)**2 + (y - 14)**2) / 40)


def made(target=None, lamp=None, picture=None, width=0.05, distance=0.5, **how):
    setup = pane.Setup((ROWS, COLUMNS), width, distance, 0.004, lamp, picture)
    return pane.design(np.ones((ROWS, COLUMNS)) if target is None else target, setup, N, **how)


def run(*words):
    """Exit code, what was printed, and what was said of mistakes."""
    out, wrong = io.StringIO(), io.StringIO()
    before, command.sys.argv = command.sys.argv, ["design", *words]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(wrong):
            code = command.main()
    except SystemExit as end:
        code = end.code
    finally:
        command.sys.argv = before
    return code, out.getvalue(), wrong.getvalue()


class Panes(unittest.TestCase):
    def test_an_even_smaller_picture_is_a_lens(self):
        for lamp, scale in ((None, 0.5), (None, 1.5), ((0, 0, 1.0), 0.75), ((0, 0, 2.0), 1.2)):
            face = made(lamp=lamp, picture=0.05 * scale, refine=0)
            # A thin lens lays x at x (1 + d / lamp - d / f); the pane's thickness shortens a little.
            far = math.inf if lamp is None else lamp[2] - 0.004 * (1 - 1 / N)
            power = 1 / far + (1 - scale) / 0.5
            slope = np.polyfit(face.setup.x.ravel(), face.slope[0].ravel(), 1)[0]
            self.assertAlmostEqual(slope * (N - 1), power, delta=0.01 * abs(power))
            # its height is the paraboloid of that power
            sag = face.h[0, -1] - face.h[0, COLUMNS // 2]
            squares = face.setup.x[0, -1]**2 - face.setup.x[0, COLUMNS // 2]**2
            self.assertAlmostEqual(sag / (power * squares / 2 / (N - 1)), 1, delta=0.01)

    def test_no_picture_is_no_cut(self):
        face = made(refine=0)
        self.assertLess(np.ptp(face.h), 1e-12)
        self.assertAlmostEqual(face.flux.mean(), (1 - ((N - 1) / (N + 1))**2)**2, places=9)

    def test_light_is_where_it_is_wanted(self):
        target = hill() / hill().mean()
        for lamp in (None, (0.02, -0.01, 0.8)):
            face = made(target, lamp)
            seen = pane.thrown(face)
            given = pane.average(face.flux).sum()
            self.assertAlmostEqual(seen.sum() / given, 1, delta=0.01)
            seen /= seen.mean()
            self.assertLess(np.sqrt(np.mean((seen - target)**2)), 0.05)
            for part in (np.s_[:, :16], np.s_[:12], np.s_[10:18, 6:14]):
                self.assertAlmostEqual(seen[part].mean() / target[part].mean(), 1, delta=0.02)
            for edge, at in ((face.u[:, 0], 0), (face.u[:, -1], COLUMNS), (face.v[0], 0),
                             (face.v[-1], ROWS)):
                self.assertLess(np.abs(edge - at).max(), 0.01)

    def test_derivatives_of_the_ray_map(self):
        face = made(hill() / hill().mean(), (0.1, 0, 0.5), refine=0)
        step = 1e-4
        for k, change in enumerate(((step, 0), (0, step))):
            more, less = (face.setup.land(face.h, face.slope[0] + s * change[0],
                                          face.slope[1] + s * change[1], face.entry, N)
                          for s in (1, -1))
            for i in (0, 1):
                exact = (more[i] - less[i]) / 2 / step
                self.assertLess(np.abs(face.derivative()[2 * i + k] - exact).max(),
                                1e-4 * np.abs(exact).max() + 1e-2)

    def test_rays_meet_snell(self):
        """The lamp's ray through the flat back, and from the cut face to the screen."""
        face = made(hill() / hill().mean(), (0.1, 0.03, 0.5), refine=0)
        dx, dy, down, _ = face.entry
        sine = np.hypot(dx, dy)
        back = np.stack([face.setup.x - dx / down * (0.004 - face.h),
                         face.setup.y - dy / down * (0.004 - face.h)])
        outside = np.hypot(back[0] - 0.1, back[1] + 0.03)
        outside /= np.hypot(outside, 0.5 - 0.004)
        self.assertLess(np.abs(outside - N * sine).max(), 1e-9)
        side = face.setup.pixel
        out = np.stack([(face.u - COLUMNS / 2) * side + face.setup.middle[0] - face.setup.x,
                        (face.v - ROWS / 2) * side + face.setup.middle[1] - face.setup.y,
                        face.setup.distance + face.h])
        out /= np.linalg.norm(out, axis=0)
        normal = np.stack([*face.slope, np.ones_like(face.h)])
        normal /= np.linalg.norm(normal, axis=0)
        across = np.cross(out, normal, axis=0) - N * np.cross([dx, dy, down], normal, axis=0)
        self.assertLess(np.abs(across).max(), 1e-9)

    def test_the_solid_is_closed(self):
        face = made(hill() / hill().mean(), refine=0)
        points, normals, triangles, which = solid.solid(face)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        seen = set(map(tuple, edges.tolist()))
        self.assertEqual(len(seen), len(edges))
        self.assertEqual(seen, {(b, a) for a, b in seen})
        a, b, c = (points[triangles[:, i]] for i in range(3))
        volume = np.einsum("ij,ij", a, np.cross(b, c)) / 6
        sizes = np.ptp(points, axis=0)
        self.assertAlmostEqual(volume / (sizes[0] * sizes[1] * 0.004), 1, delta=0.02)
        flat = np.cross(b - a, c - a)
        self.assertTrue((np.einsum("ij,ij->i", flat, normals[which].sum(1)) > 0).all())
        self.assertEqual(len(solid.stl(face)), 84 + 50 * len(triangles))

    def test_the_dip(self):
        setup = pane.Setup((ROWS, COLUMNS), 0.05, 0.5, 0.004)
        face = pane.Face(setup, -2 * setup.x**2 - 5 * setup.y**2, N)
        self.assertAlmostEqual(pane.dip_radius(face), 0.1, places=6)


class Prisms(unittest.TestCase):
    def test_least_deviation(self):
        for apex, n, deviation in ((60, 1.5, 37.180756), (60, 2 ** 0.5, 30), (90, 1.5 ** 0.5, 30)):
            got, incidence = prism.least_deviation(math.radians(apex), n)
            self.assertAlmostEqual(math.degrees(got), deviation, places=3)
            self.assertAlmostEqual(prism.apex_for(got, n), math.radians(apex), places=12)
            for off in (-0.01, 0.01):
                self.assertGreater(prism.deviation_at(math.radians(apex), n, incidence + off), got)

    def test_two_faces_at_brewsters_angle(self):
        """Light along the plane of incidence is not mirrored; that across it is, at both faces."""
        incidence = math.atan(N)
        mirrored = ((N**2 - 1) / (N**2 + 1))**2
        passed = pane.fresnel(math.cos(incidence), math.sin(incidence), 1, N, faces=2)
        self.assertAlmostEqual(passed, (1 + (1 - mirrored)**2) / 2, places=12)

    def test_fans(self):
        n = abbe.Materials()["sf10"].n(prism.LINES)
        apex = prism.apex_for_spread(math.radians(2), n)
        self.assertAlmostEqual(math.degrees(prism.spread_of(apex, n)), 2, places=6)
        # d(deviation) / dn = 2 sin(A/2) / cos(incidence)
        _, incidence = prism.least_deviation(apex, n[0])
        self.assertAlmostEqual(prism.spread_of(apex, n) / (n[1] - n[2])
                               / (2 * math.sin(apex / 2) / math.cos(incidence)), 1, delta=0.02)
        self.assertTrue(math.isnan(prism.apex_for_spread(math.radians(60), n)))

    def test_lenses_without_colour(self):
        table = abbe.Materials()
        crown, flint = (table[name].n(prism.LINES) for name in ("n-bk7", "f2"))
        v = prism.abbe_number(crown), prism.abbe_number(flint)
        self.assertAlmostEqual(v[0], 64.17, delta=0.01)
        self.assertAlmostEqual(v[1], 36.4, delta=0.1)
        f = prism.lens_pair(0.2, crown, flint)
        self.assertAlmostEqual(f[0] * v[0] + f[1] * v[1], 0, places=12)
        self.assertAlmostEqual(1 / f[0] + 1 / f[1], 5, places=12)
        at = prism.pair_focal(f, (crown[0], flint[0]), (crown, flint))
        self.assertAlmostEqual(at[0], 0.2, places=12)
        self.assertAlmostEqual(at[1], at[2], places=12)
        self.assertNotAlmostEqual(at[0], at[1], places=5)

    def test_prisms_without_colour(self):
        table = abbe.Materials()
        crown, flint = (table[name].n(prism.LINES) for name in ("n-bk7", "f2"))
        thin = prism.prism_pair(1e-3, crown, flint)
        self.assertAlmostEqual(thin[0] * (crown[1] - crown[2]) / thin[1] / (flint[1] - flint[2]), 1,
                               places=4)
        pair = prism.prism_pair(math.radians(10), crown, flint)
        at = [math.degrees(prism.pair_deviation(pair, a, b)) for a, b in zip(crown, flint)]
        self.assertAlmostEqual(at[0], 10, places=8)
        self.assertAlmostEqual(at[1], at[2], places=8)
        # one glass twice is a single prism that light meets straight
        one = prism.pair_deviation((0.3, 0.1), 1.5, 1.5)
        self.assertAlmostEqual(one, math.asin(1.5 * math.sin(0.2)) - 0.2, places=12)


class Commands(unittest.TestCase):
    def setUp(self):
        self.files = set(os.listdir("."))
        abbe.Picture(np.repeat(hill()[:, :, None], 3, 2), space="rec709").save("hill.png",
                                                                               view="Plain")

    def tearDown(self):
        for name in set(os.listdir(".")) - self.files:
            os.unlink(name)

    def test_a_pane_is_traced(self):
        for light in ("sun", "0.02,-0.01,0.8"):
            code, out, wrong = run("pane", "hill.png", "-o", "p.obj", "-o", "p.stl", "--scene",
                                   "p.yaml", "--png", "thrown.png", "--light", light, "--json")
            self.assertEqual((code, wrong), (0, ""))
            self.assertIn('"ssim": 0.9', out)
            traced = abbe.Scene("p.yaml").trace(passes=4, photons=100000, space="rec709")
            grey = command._grey(hill())
            same = abbe.compare(grey, traced, best_scale=True, structure=True)
            self.assertGreater(same["ssim"], 0.9)
            ends = abbe.load("thrown.png")
            self.assertEqual(ends.shape[:2], (ROWS, COLUMNS))
            self.assertGreater(abbe.compare(grey, pane.decoded(ends.rgb), best_scale=True,
                                            structure=True)["ssim"], 0.9)
            self.assertEqual(abbe.Scene("p.yaml", set={"objects.pane.mesh": "p.stl",
                                                       "objects.pane.fit": 0.1})
                             .plan()["mesh_faces"], abbe.Scene("p.yaml").plan()["mesh_faces"])

    def test_black_margins_stay_black(self):
        y, x = np.mgrid[0:48, 0:60] + 0.5
        ring = (np.abs(np.hypot(x - 28, y - 26) - 11) < 4) * 1.0
        abbe.Picture(np.repeat(ring[:, :, None], 3, 2), space="rec709").save("ring.png", view="Plain")
        code, out, wrong = run("pane", "ring.png", "-o", "p.obj", "--png", "thrown.png", "--json")
        self.assertEqual((code, wrong), (0, ""))
        self.assertGreater(float(out.split('"ssim": ')[1].split(",")[0]), 0.5)
        seen = pane.decoded(abbe.load("thrown.png").rgb) @ command.LUMINANCE
        for margin in (seen[:8], seen[44:], seen[:, :10], seen[:, 47:]):
            self.assertLess(margin.mean(), 0.002)
        self.assertGreater(np.median(seen[ring == 1]), 0.8)

    def test_names_that_mean_something_in_yaml(self):
        os.rename("hill.png", "a: b #.png")
        with open("my own.yaml", "w", encoding="utf-8") as file:
            file.write("materials: [{name: 'no', model: constant, coefficients: [1.5], source: here}]\n")
        code, _, wrong = run("pane", "a: b #.png", "-o", 'p "#1.obj', "--scene", "p.yaml", "--light",
                             "-0.02,-0.01,0.8", "--materials", "my own.yaml", "--material", "no")
        self.assertEqual((code, wrong), (0, ""))
        self.assertGreater(abbe.Scene("p.yaml").plan()["mesh_faces"], 2 * (ROWS - 1) * (COLUMNS - 1))

    def test_tables(self):
        code, out, _ = run("prism", "--deviation", "45", "--spread", "2")
        self.assertEqual(code, 0)
        self.assertIn("sf11", out.splitlines()[1])
        code, out, _ = run("achromat", "--focal", "20cm", "--glasses", "n-bk7,f2")
        self.assertEqual((code, len(out.splitlines())), (0, 2))
        self.assertEqual(run("achromat", "--deviation", "10")[0], 0)

    def test_bad_input(self):
        with open("text.png", "w", encoding="utf-8") as file:
            file.write("hello")
        grey = np.full((20, 20, 3), 0.5)
        abbe.Picture(grey, space="rec709").save("blank.png", view="Plain")
        abbe.Picture(grey[:9, :9], space="rec709").save("tiny.png", view="Plain")
        wide = np.linspace(0.1, 1, 40)[None, :, None].repeat(16, 0).repeat(3, 2)
        abbe.Picture(wide, space="rec709").save("wide.png", view="Plain")
        abbe.Picture(wide.transpose(1, 0, 2), space="rec709").save("tall.png", view="Plain")
        files = set(os.listdir("."))
        for line, code, part in (
                ("pane no.png -o p.obj", 1, "no.png: No such file"),
                ("pane text.png -o p.obj", 1, "text.png: it is no PNG"),
                ("pane blank.png -o p.obj", 1, "blank.png: it is blank"),
                ("pane tiny.png -o p.obj", 1, "tiny.png: it has 9 x 9 pixels"),
                ("pane hill.png -o p.obj --white 20", 1, "times the light that there is; --white may"),
                ("pane hill.png -o p.obj --white -1", 1, "not above 0"),
                ("pane hill.png -o p.obj --picture 2 --distance 0.3", 1, "critical angle"),
                ("pane wide.png -o p.obj --cells 16", 1, "has 6 of them down; 16 to 2048"),
                ("pane tall.png -o p.obj --cells 2048", 1, "has 5120 of them down; 16 to 2048"),
                ("pane hill.png -o p.obj --depth 0.01mm", 1, "details the cut is"),
                ("pane hill.png -o p.obj --radius 5", 1, "details the smallest dip"),
                ("pane hill.png -o p.obj --distance 0.001", 1, "much larger than 16.6 mm"),
                ("pane hill.png -o p.obj --distance 3mm --thickness 1", 1, "too near"),
                ("pane hill.png -o p.obj --light 0.4,0,0.2 --distance 5mm", 1, "critical angle"),
                ("pane hill.png -o p.obj --thickness 0.1mm", 1, "make --thickness or --distance larger"),
                ("pane hill.png -o p.obj --material gold", 1, "clear material"),
                ("pane hill.png -o p.obj --material glas", 1, "glas"),
                ("pane hill.png -o no/p.obj", 1, "no/p.obj: could not be written"),
                ("pane hill.png", 2, "where to?"), ("pane -o p.obj", 2, "which picture?"),
                ("pane hill.png -o p.ply", 2, ".obj or .stl"),
                ("pane hill.png -o p.stl --scene p.yaml", 2, "needs the pane as an .obj"),
                ("pane hill.png -o p.obj --png hill.png", 2, "two files have one name"),
                ("pane hill.png -o p.obj --light 0,0", 2, "neither sun nor a lamp's place"),
                ("pane hill.png -o p.obj --light 0,0,0.001", 2, "not above the pane"),
                ("pane hill.png -o p.obj --size 3km", 2, "not a length"),
                ("pane hill.png -o p.obj --dept 3", 2, "did you mean '--depth'"),
                ("prism", 2, "what for?"), ("prism --deviation 170", 1, "no glass of these"),
                ("prism --deviation 20 --material gold", 1, "gold: it is no clear glass"),
                ("achromat", 2, "what for?"), ("achromat --focal 1 --glasses f2", 2, "two glasses"),
                ("achromat --focal 1 --glasses sf11,n-sf11", 1, "no pair"),
                ("achromat --deviation 80", 1, "no pair"),
                ("lens", 2, "there is no 'lens'"), ("", 2, "usage:")):
            seen, _, wrong = run(*line.split())
            self.assertEqual((seen, part in wrong), (code, True), line + ": " + wrong)
            self.assertEqual(set(os.listdir(".")), files, line)


if __name__ == "__main__":
    unittest.main()
