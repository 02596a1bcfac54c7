"""The Python module on the installed library: arrays in and out, known answers, what is refused."""
import gc
import os
import unittest

import abbe
import numpy

SMALL = {"width": 48, "height": 40, "photons": 64, "map_size": 128}
QUICK = {"width": 48, "height": 40, "photons": 20000, "passes": 4}


class Pictures(unittest.TestCase):
    def test_arrays_come_back(self):
        array = numpy.random.default_rng(1).random((5, 7, 3), dtype=numpy.float32)
        picture = abbe.Picture(array, space="rec709")
        self.assertEqual(picture.shape, (5, 7, 3))
        self.assertEqual(picture.channels, ["R", "G", "B"])
        numpy.testing.assert_array_equal(picture.rgb, array)
        picture.save("a.exr")
        again = abbe.load("a.exr")
        numpy.testing.assert_array_equal(again.rgb, array)
        self.assertEqual(again.channels, ["B", "G", "R"])  # a file sorts them
        self.assertEqual(again["abbe:space"], "rec709")
        self.assertIn("abbe:space", again.attributes)

    def test_other_layouts_are_taken(self):
        array = numpy.arange(24.0).reshape(4, 6)
        turned = abbe.Picture(array.T)
        numpy.testing.assert_array_equal(turned.layer("Y"), array.T)
        whole = abbe.Picture(numpy.ones((2, 2, 2), dtype=int), channels=["a", "b"])
        self.assertEqual(whole.channels, ["a", "b"])

    def test_pixels_are_the_pictures_own(self):
        picture = abbe.Picture(numpy.zeros((3, 2, 3)))
        pixels = picture.pixels
        pixels[1, 1, 2] = 5
        self.assertEqual(picture.rgb[1, 1, 2], 5)
        del picture
        gc.collect()
        self.assertEqual(pixels[1, 1, 2], 5)  # it lives as long as they do

    def test_png(self):
        picture = abbe.Picture(numpy.full((4, 4, 3), 0.18))
        picture.save("a.png")
        picture.save("b.png", exposure=1, bits=16)
        self.assertGreater(abbe.load("b.png").rgb.mean(), abbe.load("a.png").rgb.mean())

    def test_what_is_none_is_refused(self):
        with self.assertRaises(ValueError):
            abbe.Picture(numpy.zeros(3))
        with self.assertRaises(ValueError):
            abbe.Picture(numpy.zeros((2, 2, 5)))
        with self.assertRaisesRegex(abbe.Error, "nowhere.exr"):
            abbe.load("nowhere.exr")
        with self.assertRaisesRegex(KeyError, "caustic"):
            abbe.Picture(numpy.zeros((2, 2, 3))).layer("caustic")
        with self.assertRaisesRegex(abbe.Error, "exposrue.*exposure"):
            abbe.Picture(numpy.zeros((2, 2, 3))).save("a.png", exposrue=1)
        self.assertFalse(os.path.exists("nowhere.exr"))


class Series(unittest.TestCase):
    def test_flicker(self):
        truth = [numpy.ones((2, 3, 3)), numpy.ones((2, 3, 3))]
        truth[1][0, 0] = 0
        frames = [truth[0] + 0.5, truth[1] + 0.25]
        row = abbe.flicker(frames, truth)
        size = numpy.sqrt(5 / 6)
        numpy.testing.assert_allclose(row[0, [0, 2]], (0.5, 0), atol=1e-7)
        numpy.testing.assert_allclose(row[1], (0.25 / size, 0.25 / size, 0.75 / 15), atol=1e-7)
        self.assertTrue(numpy.isnan(row[0, 1]))
        alone = abbe.flicker(frames)
        self.assertTrue(numpy.isnan(alone[:, [0, 2]]).all())
        self.assertAlmostEqual(alone[1, 1], numpy.sqrt((5 * 0.25 ** 2 + 1.25 ** 2) /
                                                       (5 * 1.25 ** 2 + 0.25 ** 2)), places=6)
        with self.assertRaises(KeyError):
            abbe.flicker(frames, layer="caustic")


class Tables(unittest.TestCase):
    def test_indices(self):
        table = abbe.Materials()
        glass = table["N-BK7"]
        self.assertAlmostEqual(glass.n(587.5618), 1.51680, delta=6e-6)
        n = glass.n([[486.1327, 656.2725]])
        self.assertEqual(n.shape, (1, 2))
        self.assertAlmostEqual((1.51680 - 1) / (n[0, 0] - n[0, 1]), 64.17, delta=0.02)
        self.assertGreater(table["gold"].k(550), 2)
        self.assertIn(glass.name, list(table))
        self.assertEqual(len(table), len(list(table)))
        self.assertLess(*glass.range)
        self.assertTrue(glass.source)

    def test_what_is_none_is_refused(self):
        with self.assertRaisesRegex(abbe.Error, "diamond"):
            abbe.Materials()["dimond"]
        with self.assertRaises(abbe.Error):
            abbe.Materials()["gold"].n(1e6)
        with self.assertRaises(abbe.Error):
            abbe.Materials("nowhere.yaml")

    def test_weights(self):
        nm, weight = abbe.weights(9)
        self.assertEqual((nm[0], nm[-1], weight.shape), (380, 780, (9, 3)))
        self.assertAlmostEqual(weight.sum(axis=0)[1], 1, places=12)
        with self.assertRaisesRegex(abbe.Error, "lab"):
            abbe.weights(9, space="lab")


class Scenes(unittest.TestCase):
    def test_render_move_trace_compare(self):
        scene = abbe.Scene("scenes/sphere.yaml")
        first = scene.render(**SMALL)
        self.assertEqual(first.shape, (40, 48, 3))
        camera = scene.camera
        scene.look(fov=0.7 * camera["fov"])
        self.assertAlmostEqual(scene.camera["fov"], 0.7 * camera["fov"], places=9)
        moved = scene.render(**SMALL)
        self.assertFalse(numpy.array_equal(first.rgb, moved.rgb))
        truth = scene.trace(**QUICK)
        self.assertTrue((truth.layer("stderr") >= 0).all())
        report = abbe.compare(truth, moved, mask="caustic")
        self.assertAlmostEqual(report.value("energy_ratio", masked=False).value, 1, delta=0.03)
        self.assertGreater(report.pixels(), 0)
        self.assertIn("ciede2000_mean", report.metrics)
        report.plot("difference.png", title="rendered less traced")
        self.assertGreater(abbe.load("difference.png").shape[0], 40)
        scene.look(fov=camera["fov"])
        numpy.testing.assert_array_equal(scene.render(**SMALL).rgb, first.rgb)

    def test_values_of_the_file(self):
        plain = abbe.Scene("scenes/sphere.yaml").render(**SMALL).rgb
        lit = abbe.Scene("scenes/sphere.yaml", set={"ambient": 0.5}).render(**SMALL).rgb
        scene = abbe.Scene("scenes/sphere.yaml")
        scene.change({"ambient": 0.5})
        numpy.testing.assert_array_equal(scene.render(**SMALL).rgb, lit)
        self.assertGreater(lit.sum(), plain.sum())

    def test_values_from_numpy(self):
        camera = {"camera.eye": numpy.array([0.1, -0.5, 0.4]), "camera.fov": numpy.float32(31),
                  "ambient": numpy.array(0.5)}
        scene = abbe.Scene("scenes/sphere.yaml", set=camera)
        self.assertEqual(scene.camera["eye"], (0.1, -0.5, 0.4))
        self.assertAlmostEqual(scene.camera["fov"], 31, places=5)
        scene.change({"camera.eye": numpy.array([0, -1, 1])})
        self.assertEqual(scene.camera["eye"], (0, -1, 1))
        size = numpy.array([48, 40])
        picture = scene.render(**{**SMALL, "width": size[0], "height": size[1:]})
        self.assertEqual(picture.shape, (40, 48, 3))
        with self.assertRaisesRegex(TypeError, "width"):
            scene.render(**{**SMALL, "width": size})

    def test_a_map_on_the_same_texels(self):
        scene = abbe.Scene("scenes/sphere.yaml")
        scene.render(**SMALL)
        drawn = scene.map(bands=3)
        traced = scene.trace_map(like=drawn, **QUICK)
        self.assertEqual(drawn.shape[:2], traced.shape[:2])
        self.assertAlmostEqual(abbe.compare(traced, drawn)["energy_ratio"], 1, delta=0.05)

    def test_progress_is_told_and_stops(self):
        scene, told = abbe.Scene("scenes/sphere.yaml"), []
        scene.trace(progress=told.append, **QUICK)
        self.assertTrue(told and all(0 <= done <= 1 for done in told))
        with self.assertRaises(abbe.Error):
            scene.trace(progress=lambda done: False, **QUICK)

        def interrupt(done):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            scene.trace(progress=interrupt, **QUICK)
        scene.trace(**QUICK)  # it is as it was

    def test_what_is_none_is_refused(self):
        with self.assertRaisesRegex(abbe.Error, "nowhere.yaml"):
            abbe.Scene("nowhere.yaml")
        scene = abbe.Scene("scenes/sphere.yaml")
        with self.assertRaisesRegex(abbe.Error, "widht.*width"):
            scene.render(widht=3)
        with self.assertRaisesRegex(abbe.Error, "passes"):
            scene.trace(passes=0)
        with self.assertRaises(ValueError):
            scene.look(eye=(1, 2))
        with self.assertRaises(ValueError):
            scene.look(fov=180)
        with self.assertRaises(abbe.Error):
            scene.map()
        for name, wrong in (("path", lambda: abbe.Scene(None)), ("path", lambda: abbe.load(None)),
                            ("ambient", lambda: scene.change({"ambient": None})),
                            ("material", lambda: abbe.gem_report("a.asc", None)),
                            ("path", lambda: abbe.Scene(3)),
                            ("metric", lambda: abbe.compare(numpy.ones((2, 2, 3)),
                                                            numpy.ones((2, 2, 3)))[None])):
            with self.assertRaisesRegex(TypeError, name):
                wrong()
        for wrong in (lambda: abbe.Scene("scenes/sphere.yaml\0x"),
                      lambda: abbe.Materials()["diamond\0x"],
                      lambda: scene.change({"ambient": "0.5\0x"})):
            with self.assertRaisesRegex(ValueError, "NUL"):
                wrong()


class Gems(unittest.TestCase):
    def test_a_report(self):
        report = abbe.gem_report("scenes/designs/brilliant-diamond.asc", "diamond", size=16,
                                 repeats=3, wavelengths=2, tilt=0)
        self.assertAlmostEqual(sum(report[name].value for name in
                                   ("iso", "leakage", "absorbed", "left")), 1, places=4)
        self.assertNotIn("fire", report.keys())
        self.assertGreaterEqual(report["iso"].error, 0)
        self.assertIn("iso", report.maps().channels)
        with self.assertRaises(abbe.Error):
            abbe.gem_report("scenes/designs/brilliant-diamond.asc", "gold")


unittest.main()
