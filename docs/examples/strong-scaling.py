#!/usr/bin/env python3
"""Measures what ranks of abbe-mpi are worth, and models more of them than there are.

    docs/examples/strong-scaling.py ABBE ABBE_MPI [--scene FILE] [--passes N] [--mpirun PROGRAM]

Measured: processor time of each of 32 passes, one a process; the time of 1 and 2 ranks of one thread
each, from start to end. Modelled: R ranks trace N passes whose times are drawn from those measured;
T(R) = start + the slowest rank's passes + the reduction, of log2 R hops of all sums at 1 GB/s.
"""
import argparse, json, math, os, random, statistics, subprocess, tempfile, time

SAMPLES = 32
GIGABYTE_A_SECOND = 1e9


def run(command):
    """Wall and processor time of a command that must succeed, s."""
    start = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit("failed: " + " ".join(command))
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime


def measure_passes(trace, folder):
    """Processor time of what comes before the passes, and of each pass, s."""
    part = os.path.join(folder, "part.ck")
    stats = os.path.join(folder, "stats.json")
    passes, starts = [], []
    for k in range(SAMPLES):
        _, whole = run(trace + ["--passes", f"{k}:{k + 1}", "--checkpoint", part, "--stats", stats])
        with open(stats) as file:
            said = json.load(file)
        passes.append(said["light_seconds"] + said["eye_seconds"])
        starts.append(whole - passes[-1])
    return statistics.median(starts), passes, os.path.getsize(part)


def modelled(ranks, count, start, passes, reduction, source):
    """The time of that many ranks, s: a mean over draws, for which rank is slowest is chance."""
    times = []
    for _ in range(20):
        slowest = 0
        for r in range(min(ranks, count)):
            own = (count - r - 1) // ranks + 1
            slowest = max(slowest, sum(source.choices(passes, k=own)))
        times.append(slowest)
    return start + statistics.mean(times) + reduction * math.ceil(math.log2(ranks))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("abbe")
    arguments.add_argument("abbe_mpi")
    arguments.add_argument("--scene", default="scenes/gem.yaml")
    arguments.add_argument("--passes", type=int, default=32)
    arguments.add_argument("--mpirun", default="mpirun --oversubscribe --bind-to none --allow-run-as-root")
    q = arguments.parse_args()
    asked = [q.scene, "--size", "128x128", "--map", "128", "--photons", "262144", "--threads", "1", "--quiet"]
    source = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        files = ["-o", os.path.join(folder, "a.exr"), "--save-map", os.path.join(folder, "m.exr")]
        start, passes, size = measure_passes([q.abbe, "trace"] + asked + files, folder)
        measured = {}
        for ranks in (1, 2):
            command = q.mpirun.split() + ["-n", str(ranks), q.abbe_mpi, "trace"] + asked + files
            measured[ranks] = run(command + ["--spp", str(q.passes)])[0]
    reduction = size / GIGABYTE_A_SECOND
    mean, spread = statistics.mean(passes), statistics.stdev(passes)
    print(f"{q.scene}: start {start:.3f} s, a pass {mean:.3f} s, standard deviation {100 * spread / mean:.1f} %, "
          f"sums {size / 1e6:.1f} MB")
    one, two = measured[1], measured[2]
    print(f"measured, {q.passes} passes: 1 rank {one:.2f} s, 2 ranks {two:.2f} s, efficiency {one / (2 * two):.2f}")
    print("\nmodelled:\n\n| ranks | " + " | ".join(f"{n} passes, s | efficiency" for n in (64, 4096)) + " |")
    print("|---|---|---|---|---|")
    for ranks in (1, 2, 4, 16, 64, 256, 1000):
        cells = []
        for count in (64, 4096):
            whole = modelled(1, count, start, passes, reduction, source)
            own = modelled(ranks, count, start, passes, reduction, source)
            cells += [f"{own:.1f}", f"{whole / (ranks * own):.2f}"]
        print(f"| {ranks} | " + " | ".join(cells) + " |")


main()
