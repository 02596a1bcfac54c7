"""Sweeps: tables, fronts and presets by hand; `abbe sweep` as people meet it."""
import contextlib
import io
import json
import math
import os
import signal
import subprocess
import sys
import time
import unittest
import warnings

import abbe
from abbe.sweep import __main__ as sweep
from abbe.sweep import fronts, grids, presets, show, table
from abbe.sweep.table import Row, Setting, Table, Wrong

GEM = "scenes/gem.yaml"
SMALL = [GEM, "-q", "--size", "24x24", "--frames", "1", "--spp", "2", "--traced-photons", "2000",
         "--texels", "16", "--map", "64", "--samples", "1", "--backend", "cpu"]
TWO = SMALL + ["--profiles", "default", "--wavelengths", "7", "--photons", "16,32", "-o", "s.csv"]
USUAL = {"wavelengths": 7, "map": 512, "fill": "bridge", "exits": 8}


def run(*arguments):
    """Exit code, what was printed, and what was said of mistakes."""
    out, wrong = io.StringIO(), io.StringIO()
    before, sys.argv = sys.argv, ["sweep", *arguments]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(wrong):
            code = sweep.main()
    except SystemExit as end:
        code = end.code
    finally:
        sys.argv = before
    return code, out.getvalue(), wrong.getvalue()


def read(name):
    with open(name, encoding="utf-8") as file:
        return file.read()


def row(profile, photons, ms=math.nan, error=math.nan, light=math.nan, eye=math.nan, **fields):
    plain = profile == "default"
    return Row(Setting(profile=profile, photons=photons, **(
        USUAL | ({} if plain else {"fill": "smear"}) | fields)),
               {"frame_ms": ms, "caustic_de": error, "light_ms": light, "eye_ms": eye})


class Temporary(unittest.TestCase):
    def setUp(self):
        self.files = set(os.listdir("."))

    def tearDown(self):
        for name in set(os.listdir(".")) - self.files:
            os.unlink(name)


class Fronts(unittest.TestCase):
    def test_a_front_by_hand(self):
        nan = math.nan
        cost = [1, 2, 3, 3, 4, 2, 5, nan, 0, 6]
        error = [9, 4, 4, 2, 3, 4, nan, 0, 0, 2]
        self.assertEqual(fronts.order(cost, error), [0, 1, 3])
        self.assertEqual(fronts.order([], []), [])

    def test_the_knee_and_the_accurate_end(self):
        e = math.exp
        cost, error = [1, e(1), e(2), e(4)], [e(4), e(1), e(0.9), 1]
        self.assertEqual(fronts.knee(cost, error), 1)
        self.assertEqual(fronts.knee(cost, [e(4), e(3), e(2), 1]), 2)
        self.assertEqual(fronts.knee(cost[:2], error[:2]), 1)
        self.assertEqual(fronts.accurate(error, 0), 3)
        self.assertEqual(fronts.accurate(error, e(0.9) - 1 + 1e-9), 2)

    def test_against_a_baseline_by_hand(self):
        t = Table()
        c = fronts.compare(t, "thesis", "frame_ms", "caustic_de")
        self.assertIsNone(c.row)
        self.assertEqual(c.front, 0)
        self.assertTrue(math.isnan(c.speedup) and math.isnan(c.front_ratio))
        for photons, ms, error in ((64, 10, 8), (128, 40, 4), (256, 160, 2)):
            t.add(row("default", photons, ms, error, map=1024))
        # 512: its own settings; 256 is not on its front
        for photons, ms, error in ((128, 60, 30), (512, 200, 20), (1024, 400, 10), (256, 300, 25)):
            t.add(row("thesis", photons, ms, error, map=1024))
        c = fronts.compare(t, "thesis", "frame_ms", "caustic_de")
        self.assertEqual(c.row.setting.photons, 512)
        # its front: (60, 30), (200, 20), (400, 10): speedups 6, 20, 40; ratios 4/30, 2/20, 2/10
        for seen, right in zip(c[1:], (200 / 10, 2 / 20, 3, 3, 6, 0.2)):
            self.assertAlmostEqual(seen, right)
        # a point that is cheaper than all, or better than all, has no answer
        t.add(row("thesis-cie", 512, 500, 3, map=1024))
        t.add(row("thesis-cie", 1024, 900, 1.5, map=1024))
        c = fronts.compare(t, "thesis-cie", "frame_ms", "caustic_de")
        self.assertAlmostEqual(c.speedup, 500 / 160)
        self.assertEqual(c.beaten, 1)
        self.assertTrue(math.isnan(c.front_speedup))
        self.assertAlmostEqual(c.front_ratio, 2 / 1.5)

    def test_what_an_error_is_made_of(self):
        t = Table({"model": fronts.model_text((4, 0.5, 0.1, 0.02, 0.93))})
        t.add(row("default", 64, 1, 9))
        t.add(row("default", 256, 2, 5))
        t.add(row("default", 256, 2, 6, fill="none"))
        for one, matched in zip(t.rows, (8, 3, 4)):
            one.update(matched_de=matched, matched_de_noise=0.1, caustic_de_noise=1, map_energy=0.9)
        parts = fronts.decompose(t)
        self.assertEqual([parts[key] for key in ("total", "model", "sampling_and_reconstruction",
                                                 "with_fill", "without_fill")], [5, 4, 3, 3, 4])
        self.assertIn("itself 4 (0.5) away from full; the setting is 3 (0.1)", parts["words"])
        self.assertIn("So the model has about as much", parts["words"])
        self.assertIn("keeps 93.0 % of the map's light, and the setting has 90.0 %", parts["words"])
        self.assertIn("With fewer photons it was 8: more of them would help on", parts["words"])
        self.assertIn("turns 4 into 3", parts["words"])
        self.assertIsNone(fronts.decompose(Table()))


class Tables(Temporary):
    def test_labels(self):
        for setting, label in (
                (Setting(profile="default", photons=256, **USUAL), "w7 p256 m512 s1"),
                (Setting(profile="default", photons=9, **(USUAL | {
                    "exits": 2, "share": 0.1, "model": "layers", "upsample": 2, "history": 4,
                    "fill": "none"})), "w7 p9 m512 s1/2 no fill e2 share 0.1 layers h4"),
                (Setting(profile="wyman2006", photons=9, **(USUAL | {"fill": "quads"})),
                 "wyman2006 w7 p9 m512 s1 quads"),
                (Setting(profile="trace", photons=512, passes=4), "trace 4 x p512")):
            self.assertEqual(setting.label, label)

    def test_a_table_comes_back(self):
        t = Table({"scene": "a\nb.yaml", "class": "convex"}, [row("default", 64, 0.1, 1e-300)])
        t.rows[0].front = True
        t.save("t.csv")
        back = table.load("t.csv")
        self.assertEqual(back.facts, t.facts)
        self.assertEqual(back.facts["scene"], "a b.yaml")
        self.assertEqual(back.rows[0].setting, t.rows[0].setting)
        self.assertEqual(back.rows[0]["caustic_de"], 1e-300)
        self.assertTrue(back.rows[0].front and math.isnan(back.rows[0]["map_rmse"]))
        with self.assertRaisesRegex(Wrong, "'w7 p64 m512 s1' is there twice"):
            t.add(row("default", 64))

    def test_what_is_no_table(self):
        Table({}, [row("default", 64, 0.1)]).save("t.csv")
        head, line = read("t.csv").splitlines()
        for text, part in ((head.replace("photons,", "photos,"), ":1: column 3 is 'photos' where a "
                            "sweep has 'photons'"), ("", "it has no line of column names"),
                           (head + "\na,b", ":2: the row has 2 cells, not 59"),
                           (head + "\n" + line.replace("64", "-1", 1), "photons '-1' is not a whole"),
                           (head + "\n" + line.replace("0.1", "x"), "frame_ms 'x' is not a number"),
                           (head + "\n" + line.replace("0.01", "0"), "'0' is not a share above 0"),
                           (head + "\n" + line.replace("default", ""), "profile '' is not a word"),
                           (head + f"\n{line}\n{line}", ":3: the setting")):
            with open("t.csv", "w", encoding="utf-8") as file:
                file.write(text + "\n")
            with self.assertRaisesRegex(Wrong, "t.csv:?.*" + part):
                table.load("t.csv")

    def test_rows_of_other_sweeps(self):
        a, b = Table({"machine": "x", "date": "1"}), Table({"machine": "y", "date": "2"})
        with self.assertRaisesRegex(Wrong, "b.csv: its rows were measured with the machine 'y'"):
            table.join([a, b], ["a.csv", "b.csv"])
        b.set("machine", "x")
        a.add(row("default", 1))
        b.add(row("default", 2))
        self.assertEqual(len(table.join([a, b], ["a.csv", "b.csv"]).rows), 2)

    def test_unrest_and_noise(self):
        t = Table({}, [row("default", n, 10 + n, 5) for n in range(1, 4)])
        for one in t.rows:
            one.update(fastest_ms=10, caustic_de_noise=1)
        self.assertAlmostEqual(t.unrest(), 0.2)
        self.assertTrue(t.tells("caustic_de"))
        t.rows[0]["caustic_de_noise"] = 4.9
        self.assertFalse(t.tells("caustic_de"))


class Presets(Temporary):
    def make(self):
        """Two convex scenes, one of them noisy besides, and a ball."""
        noisy, gem, prism, ball = (Table({
            "scene": f"scenes/{name}.yaml", "class": of, "machine": 'a "good" one'})
            for name, of in (("noisy", "convex"), ("gem", "convex"), ("prism", "convex"),
                             ("ball", "spheres")))
        noisy.add(row("default", 64, 2, 90, 1, 1))
        noisy.rows[0]["caustic_de_noise"] = 85
        for t, numbers in ((gem, ((64, 10, 1, 8), (128, 20, 1, 3), (256, 90, 1, 2.02),
                                  (512, 400, 1, 2), (1024, 1600, 1, 1.99), (48, 1, 1, 1))),
                           (prism, ((64, 40, 4, 4), (128, 80, 1, 2), (256, 90, 1, 1),
                                    (512, 400, 1, 1), (1024, 1600, 1, 1)))):
            for photons, light, eye, error in numbers:
                t.add(row("default", photons, light + eye, error, light, eye))
            t.add(row("thesis", 16, 2, 0.1, 1, 1))  # no preset whatever it is worth
            # cheap, but it gives up what others may be made of
            t.add(row("default", 24, 2, 0.5, 1, 1, share=0.1))
        ball.add(row("default", 64, 10, 1, 5, 5))
        return [noisy, gem, prism, ball], ["n.csv", "a.csv", "b.csv", "c.csv"]

    def test_a_class_of_two_scenes(self):
        tables, names = self.make()
        presets.write("p.yaml", tables, names, "caustic_de")
        text = read("p.yaml")
        self.assertIn("# left out, for its reference's noise explains its errors: noisy.yaml", text)
        front = abbe.presets("convex", "p.yaml")
        self.assertEqual([front[key] for key in ("error", "scenes")], ["caustic_de", "gem, prism"])
        # leaving one scene out: the worst of their errors' ratios, 2.02 over 1
        self.assertAlmostEqual(front["margin"], 2.02)
        # the cheapest is the geometric mean, the others that times the worse of the ratios
        points = [(p["photons"], p["error"] / front["margin"]) for p in front["points"]]
        for (photons, error), right in zip(points, ((64, 8), (128, 3), (256, 2.02), (512, 2),
                                                    (1024, 1.99))):
            self.assertEqual(photons, right[0])
            self.assertAlmostEqual(error, right[1])
        for light in (20, 40, 180, 800, 3200):
            self.assertIn(f"model: auto, light_ms: {light}.00, eye_ms: 2.00", text)
        # one scene alone takes the widest margins of the other classes
        self.assertEqual(abbe.presets("spheres", "p.yaml")["margin"], front["margin"])
        self.assertEqual(abbe.presets("bows", "p.yaml"), {})

    def test_whole_pictures(self):
        tables, names = self.make()
        for t in tables[1:]:
            t.add(Row(Setting(profile="trace", photons=128, passes=2),
                      {"frame_ms": 10, "own_de": 2, "warm_ms": 30, "caustic_de": 4}))
            for one in t.rows:
                if one.setting.profile == "default":
                    one["warm_ms"] = one["frame_ms"] + 100
        presets.write("p.yaml", tables, names, "caustic_de")
        text = read("p.yaml")
        self.assertIn("  pictures:\n    base_ms: 10.00\n    base_error: 2\n    margin_scenes: 2", text)
        self.assertIn("      - {photons: 128, passes: 2, ms: 30.0, error: 4, least: 4}", text)
        self.assertIn("{photons: 64, wavelengths: 7, map: 512, samples: 1, upsample: 1, fill: bridge"
                      ",\n         exits: 8, share: 0.01, model: auto, ms: 144.0, error: 8", text)

    def test_promises(self):
        tables, names = self.make()
        presets.write("p.yaml", tables, names, "caustic_de")
        lines = presets.promises(tables[1], "p.yaml")
        self.assertIn("made on gem, prism; margin 2.02 for the error", lines[0])
        self.assertEqual(len(lines), 6)
        self.assertIn("draft     w7 p64 m512 s1", lines[1])
        self.assertIn("8 met;", lines[1])
        self.assertEqual(presets.promises(Table({"class": "bows"}), "p.yaml"), [])

    def test_accurate_is_finer_than_the_defaults(self):
        usual = Setting(profile="default", photons=256, **(USUAL | {"map": 1024, "samples": 2}))
        self.assertFalse(presets.is_fine(usual))
        self.assertFalse(presets.is_fine(usual.but(photons=512)))
        fine = usual.but(photons=512, wavelengths=21)
        self.assertTrue(presets.is_fine(fine))
        self.assertFalse(presets.is_fine(fine.but(samples=1)))
        plan = abbe.Scene("scenes/sphere.yaml").plan()  # what plans take by themselves
        for key, value in presets.USUAL.items():
            self.assertEqual(plan[grids.KEYS.get(key, key)], value)
        t = Table({"scene": "a.yaml", "class": "spheres"}, [
            row("default", n, 2 * n, 99 / n, n, n, map=1024, samples=2, wavelengths=21)
            for n in (64, 128, 512)])
        presets.write("p.yaml", [t], ["a.csv"], "caustic_de")
        self.assertEqual([point["point"] for point in abbe.presets("spheres", "p.yaml")["points"]],
                         ["draft", "balanced", "accurate"])
        t.rows.pop()
        presets.write("p.yaml", [t], ["a.csv"], "caustic_de")
        self.assertIn("# accurate: no setting that is finer", read("p.yaml"))

    def test_what_is_refused(self):
        tables, names = self.make()
        tables[2].set("machine", "b")
        with self.assertRaisesRegex(Wrong, "n.csv and b.csv are of different machines"):
            presets.write("p.yaml", tables, names, "caustic_de")
        tables[2].set("class", "")
        with self.assertRaisesRegex(Wrong, "b.csv: it does not name its scene's class"):
            presets.write("p.yaml", tables, names, "caustic_de")
        with self.assertRaisesRegex(Wrong, "its class, spheres, has no setting"):
            presets.write("p.yaml", tables[3:], names[3:], "map_rmse")
        self.assertFalse(os.path.exists("p.yaml"))


class Grids(unittest.TestCase):
    def test_grids_are_resolved_once(self):
        scene = abbe.Scene("scenes/ring.yaml")
        parts = [{"photons": [16, 32], "wavelengths": [3, 5]}, {"photons": [16], "wavelengths": [3]},
                 {"profiles": ["thesis"], "samples": [1, 2], "wavelengths": [7]},
                 {"model": ["layers"], "meshes": True}, {"history": [1, 4]}]
        out, refused, _ = grids.expand(scene, parts)
        labels = [setting.label for setting in out]
        self.assertEqual(len(labels), len(set(labels)))
        # the first axis varies fastest; of a published method samples are without effect
        self.assertEqual([(s.wavelengths, s.photons) for s in out[:4]],
                         [(3, 16), (5, 16), (3, 32), (5, 32)])
        self.assertEqual(sum(s.profile == "thesis" for s in out), 1)
        self.assertEqual(sum(s.history == 4 for s in out), 1)
        self.assertEqual(refused, 0)
        for setting in out:  # a request comes to itself
            plan = scene.plan(**grids.request(setting))
            self.assertEqual(grids.setting_of(plan, profile=setting.profile,
                                              direction=setting.direction), setting)

    def test_named_grids(self):
        scene = abbe.Scene(GEM)
        for name, count in (("quick", 82), ("thin", 97)):
            self.assertEqual(len(grids.expand(scene, grids.GRIDS[name])[0]), count)
        self.assertTrue(all(s.exits for s in grids.of_presets(scene, None)))

    def test_what_cannot_be_rendered(self):
        scene = abbe.Scene(GEM)
        with self.assertRaisesRegex(Wrong, "no setting of the grid can be rendered"):
            grids.expand(scene, [{"profiles": ["default"], "direction": ["own"]}])
        out, refused, why = grids.expand(scene, [{"profiles": ["default", "pinhole-64"]}])
        self.assertEqual((len(out), refused), (1, 1))
        self.assertIsInstance(why, abbe.Error)


class Command(Temporary):
    def ok(self, *arguments):
        code, out, wrong = run(*arguments)
        self.assertEqual(code, 0, wrong)
        return out

    def test_rows_are_measured_once(self):
        self.assertIn("2 settings", self.ok(*TWO))
        first = table.load("s.csv")
        self.assertEqual((first.facts["size"], first.facts["reference"]),
                         ("24x24", "s-reference.exr"))
        for one in first.rows:
            self.assertGreater(min(one["frame_ms"], one["camera_ms"], one["baseline_ms"]), 0)
            self.assertGreater(one["caustic_de"], 0)
            self.assertGreater(one["map_rmse_noise"], 0)
        # errors are those of compare
        scene = abbe.Scene(GEM)
        scene.lay_map(abbe.load("s-reference-map.exr"))
        for one in first.rows:
            picture = scene.render(width=24, height=24, backend="cpu", **grids.request(one.setting))
            held = abbe.compare(abbe.load("s-reference.exr"), picture, mask="caustic")
            self.assertEqual(one["caustic_de"], held["ciede2000_mean"])
            self.assertEqual(one["picture_rmse"], held.value("relative_rmse", masked=False).value)
        # more photons: the two rows stay as they are, times included, and one comes
        more = [word.replace("16,32", "16,32,48") for word in TWO]
        self.ok(*more, "--report", "s.md")
        second = table.load("s.csv")
        self.assertEqual(len(second.rows), 3)
        for one, same in zip(first.rows, second.rows):
            self.assertEqual({k: v for k, v in one.items() if v == v},
                             {k: v for k, v in same.items() if v == v})
        page = read("s.md")
        self.assertIn("## gem.yaml", page)
        self.assertIn("![reference](s-gem-reference.png)", page)
        self.assertTrue(os.path.exists("s-gem-accurate.png"))

    def test_contestants_beside_each_other(self):
        rows = json.loads(self.ok(
            *SMALL, "--profiles", "default,thesis,thesis-cie,trace,trace-filter", "--wavelengths",
            "7", "--photons", "32", "--fill", "auto,none", "--passes", "2", "--history", "1,4", "-o",
            "s.csv", "--json"))["rows"]
        of = {(one["profile"], one["fill"], one["history"]): one for one in rows}
        # it knows no units, so it got its best factor; the default profile does and got none
        self.assertNotEqual(of["thesis", "none", 1]["scale"], 1)
        self.assertIsNone(of["thesis", "none", 1]["baseline_ms"])
        self.assertEqual(of["default", "bridge", 1]["scale"], 1)
        self.assertGreater(of["thesis", "smear", 1]["fill_invented"], 0)
        self.assertEqual(of["thesis", "none", 1]["fill_invented"], 0)
        self.assertGreater(of["trace", "none", 1]["own_de"], 0)
        self.assertIsNone(of["trace", "none", 1]["map_rmse"])
        later = of["default", "bridge", 4]
        self.assertLess(later["after_8_de"], later["after_1_de"])
        self.assertFalse(later["front"])
        self.assertIn("the Pareto front of frame_ms and map_rmse",
                      self.ok("s.csv", "--error", "map_rmse"))

    def test_the_error_is_decomposed(self):
        one = SMALL + ["--profiles", "default", "--wavelengths", "7", "--photons", "16", "-o",
                       "s.csv"]
        self.ok(*SMALL, "-o", "s.csv", "--decompose", "--trace-only")
        self.assertFalse(os.path.exists("s.csv"))
        kept = [abbe.load(name).pixels for name in ("s-reference.exr", "s-matched.exr")]
        self.assertIn("What is left: w7 p16 m64 s1 share 0.005 has", self.ok(*one, "--decompose"))
        for before, name in zip(kept, ("s-reference.exr", "s-matched.exr")):
            self.assertTrue((before == abbe.load(name).pixels).all())
        code, _, wrong = run(*one)  # rows of another decomposition are not mixed
        self.assertEqual(code, 1)
        self.assertIn("its rows were measured with the model 'caustic_de", wrong)

    def test_parts_of_given_references_are_joined(self):
        scene = abbe.Scene(GEM)
        scene.render(width=24, height=24, photons=32, map_size=64, aovs=True,
                     backend="cpu").save("r.exr")
        scene.map().save("m.exr")
        given = [GEM, "-q", "--frames", "1", "--reference", "r.exr", "--reference-map", "m.exr",
                 "--profiles", "default", "--photons", "16,32,48", "--map", "64", "--backend", "cpu"]
        for part in ("0", "1"):
            self.ok(*given, "-o", f"p{part}.csv", "--part", part + "/2")
        self.assertIn("3 settings", self.ok("p0.csv", "p1.csv", "-o", "s.csv"))
        same = table.load("s.csv").rows[2]
        self.assertEqual(same.setting.photons, 32)
        for column in ("map_rmse", "picture_de", "caustic_rmse"):
            self.assertLess(same[column], 1e-6)
        code, _, wrong = run("p0.csv", "p0.csv", "-o", "s.csv")
        self.assertEqual((code, "twice" in wrong), (1, True))

    def test_what_is_stopped_goes_on(self):
        long = SMALL + ["--profiles", "default", "--wavelengths", "7,9,11,13,15,17,19,21",
                        "--photons", "64,72,80,800", "-o", "s.csv"]
        for name in ("INT", "TERM"):
            child = subprocess.Popen([sys.executable, "-m", "abbe.sweep", *long],
                                     stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
            while not os.path.exists("s.csv") and child.poll() is None:
                time.sleep(0.02)
            child.send_signal(getattr(signal, "SIG" + name))
            wrong = child.communicate()[1]
            self.assertEqual(child.returncode, 1, wrong)
            self.assertIn("of 32 settings are in s.csv, and the same command goes on", wrong)
            self.assertTrue(1 <= len(table.load("s.csv").rows) < 32)
            os.unlink("s.csv")
        self.assertEqual([name for name in os.listdir(".") if name.startswith(".abbe-")], [])

    def test_whole_processes(self):
        one = [word for word in TWO if word not in ("-q",)]
        self.ok(*[word.replace("16,32", "16") for word in one], "-q", "--processes")
        (only,) = table.load("s.csv").rows
        self.assertGreater(only["cold_ms"], 0)
        self.assertGreater(only["warm_ms"], only["frame_ms"])

    def test_charts(self):
        try:
            import matplotlib  # noqa: F401 pylint: disable=unused-import,import-outside-toplevel
        except ImportError:
            with self.assertRaisesRegex(Wrong, "python3-matplotlib"):
                show.figures()
            return
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what matplotlib itself uses
            Table({"scene": "a.yaml"}, [row("default", 64, 1, 2), row("thesis", 64, 2, 3)]).save(
                "s.csv")
            self.ok("s.csv", "--plot", "s.svg")
            self.ok("s.csv", "--plot", "s.png")
        self.assertIn("</svg>", read("s.svg"))
        with self.assertRaisesRegex(Wrong, "no setting has a known time"):
            show.plot("t.png", [Table(), Table()], "frame_ms", "caustic_de")

    def test_what_is_refused(self):
        for line, code, part in (
                ("", 2, "which scene?"), ("a.yaml", 2, "where to? Give -o FILE.csv"),
                ("a.yaml b.yaml -o s.csv", 2, "one scene at a time"),
                ("a.yaml -o s.csv --grid quack", 2, "did you mean 'quick'?"),
                ("a.yaml -o s.csv --grid full --map 64", 2, "one or the other"),
                ("a.yaml -o s.csv --map 64,,8", 2, "is not a list such as 3,7,21"),
                ("a.yaml -o s.csv --map 64,x", 2, "'x' is not a whole number"),
                ("a.yaml -o s.csv --samples 9", 2, "9 is not from 1 to 4"),
                ("a.yaml -o s.csv --error caustic_da", 2, "did you mean 'caustic_de'?"),
                ("a.yaml -o s.csv --error frame_ms", 2, "is no error"),
                ("a.yaml -o s.csv --profile thesis", 2, "did you mean '--profiles'?"),
                ("a.yaml -o s.csv --part 2/2", 2, "is no part"),
                ("a.yaml -o s.txt", 2, "does not end with .csv"),
                ("a.yaml -o s.csv --decompose --physics matched", 2,
                 "--decompose traces full and matched physics"),
                ("a.yaml -o s.csv --reference r.exr --spp 9", 2, "and one is given"),
                ("a.csv --grid thin", 2, "'a.csv' is a table"),
                ("a.yaml -o s.csv --write-presets p.yaml", 2, "--write-presets reads tables"),
                ("a.yaml -o s.csv", 1, "a.yaml"), ("a.csv", 1, "a.csv"),
                (GEM + " -o no/s.csv", 1, "no/s.csv"),
                (GEM + " -o s.csv --reference no.exr", 1, "no.exr")):
            seen, _, wrong = run(*line.split())
            self.assertEqual((seen, part in wrong), (code, True), line + ": " + wrong)
            self.assertEqual(set(os.listdir(".")), self.files, line)

    def test_nothing_is_overwritten(self):
        for name in ("a.csv", "b.csv"):
            Table({"scene": "gem.yaml", "reference": "s-gem-reference.png"}).save(name)
        for name in ("gem.md", "s-gem-reference.png"):
            with open(name, "w", encoding="utf-8"):
                pass
        os.link("gem.md", "gem.yaml")
        for line, part in (("a.csv --report s.md", "'s-gem-reference.png' would be written over the "
                            "table's source"), ("a.csv b.csv -o b.csv --presets p.yaml "
                                                "--write-presets p.yaml", "written over --presets")):
            code, _, wrong = run(*line.split())
            self.assertEqual((code, part in wrong), (2, True), wrong)
        self.ok(*TWO)
        text = read("s.csv").replace("scene hash: ", "scene hash: x")
        for text, part in ((text, "s.csv: its rows were measured with the scene hash 'x"),
                           ("broken\n", "s.csv:1: column 1 is 'broken'")):
            with open("s.csv", "w", encoding="utf-8") as file:
                file.write(text)
            code, _, wrong = run(*TWO)
            self.assertEqual((code, part in wrong), (1, True), wrong)
            self.assertEqual(read("s.csv"), text)


if __name__ == "__main__":
    unittest.main()
