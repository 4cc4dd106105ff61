"""Months of nightly runs with a fault every tenth night: the folder at the end is that of months without one.

    python3 benches/soak.py FOLDER [--nights 730] [--tails 100] [--every 10] [--diagnosed 1] [--samples N]
        [--flies-every 1] [--seed N] [--target target/release]

Each night every tail has flown once (with `--flies-every N` every Nth tail in turn), and `adapt --relearn` gets the reports of the last week; every thirtieth night `monitor` reads the
folder, and in one such month of `--diagnosed` months `diagnose` the reports of the last thirty nights against the models before them. Both are done twice: in one folder
undisturbed, in the other with a fault every tenth night and the same command once more after it. Faults in turn: kill -9,
SIGTERM, no space for a file, a report of which half has arrived, files that are no reports, two processes at once, a changed
digit in a segments file that is put right from a backup. In the end models, segments, flights, monitor.json and all
diagnosis.json are compared byte by byte. Prints its seed.
"""
import argparse
import collections
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from chain import ROOT, make_reports
from kill import committed, digest

QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
WEEK, MONTH = 7, 30


class World:
    """A folder, and what happens to it."""

    def __init__(self, asked, name):
        self.program = str(asked.target / "cruisefit")
        self.flies_every = asked.flies_every
        self.reports = asked.folder / f"reports-{asked.flights * asked.tails}-{asked.tails}-{asked.samples}"
        self.model = asked.folder / "MODEL.ron"
        self.home = asked.folder / name
        shutil.rmtree(self.home, ignore_errors=True)
        self.home.mkdir(parents=True)
        self.output, self.before = self.home / "out", self.home / "before"
        self.documents = {}
        self.diagnosed = asked.diagnosed

    def of_nights(self, first, last):
        nights, of = range(max(0, first), last + 1), self.flies_every
        return [
            str(tail / f"{night // of:05}.txt")
            for number, tail in enumerate(sorted(self.reports.iterdir()))
            for night in nights
            if night % of == number % of
        ]

    def adapt(self, inputs):
        return [self.program, "adapt", *inputs, "--model", str(self.model), "-o", str(self.output), "--relearn", "--no-progress"]

    def night(self, night):
        status = subprocess.run(self.adapt(self.of_nights(night - WEEK + 1, night)), **QUIET).returncode
        assert status == 0, f"night {night}: status {status}"

    def month(self, night):
        out = self.home / f"month-{night}"
        subprocess.run([self.program, "monitor", str(self.output), "-o", str(out)], check=True, **QUIET)
        self.documents[f"monitor {night}"] = (out / "monitor.json").read_bytes()
        is_diagnosed = (night + 1) // MONTH % self.diagnosed == 0
        if self.before.exists() and is_diagnosed:
            inputs = self.of_nights(night - MONTH + 1, night)
            model = ["--model", str(self.before), "--no-progress", "-o", str(out / "diagnosis")]
            subprocess.run([self.program, "diagnose", *inputs, *model], check=True, **QUIET)
            self.documents[f"diagnosis {night}"] = (out / "diagnosis" / "diagnosis.json").read_bytes()
        shutil.rmtree(self.before, ignore_errors=True)
        shutil.copytree(self.output, self.before)


class Faults:
    """Faults in turn; each leaves a folder that the same command brings to where it would have been."""

    def __init__(self, world, seed):
        self.world, self.draw, self.done = world, random.Random(seed), collections.Counter()
        self.kinds = [self.killed, self.terminated, self.no_space, self.half_arrived, self.no_reports, self.two_at_once, self.damaged]

    def strike(self, night, lasts):
        kind = self.kinds[sum(self.done.values()) % len(self.kinds)]
        self.tonight = self.world.of_nights(night, night)
        kind(self.world.of_nights(night - WEEK + 1, night), lasts)
        self.done[kind.__name__] += 1

    def _signalled(self, inputs, lasts, number):
        run = subprocess.Popen(self.world.adapt(inputs), **QUIET)
        time.sleep(lasts * self.draw.uniform(0.3, 1.1))
        run.send_signal(number)
        run.wait()

    def killed(self, inputs, lasts):
        self._signalled(inputs, lasts, signal.SIGKILL)

    def terminated(self, inputs, lasts):
        self._signalled(inputs, lasts, signal.SIGTERM)

    def no_space(self, inputs, _):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        status = subprocess.run(self.world.adapt(inputs), preexec_fn=limit, **QUIET).returncode
        assert status == 2, status

    def half_arrived(self, inputs, _):
        whole = pathlib.Path(self.draw.choice(self.tonight))
        half = self.world.home / "half" / whole.parent.name / whole.name
        half.parent.mkdir(parents=True, exist_ok=True)
        lines = whole.read_text().splitlines(keepends=True)
        half.write_text("".join(lines[: len(lines) * 6 // 10]))
        given = [path for path in inputs if path != str(whole)] + [str(half)]
        status = subprocess.run(self.world.adapt(given), **QUIET).returncode
        assert status in (0, 1), status

    def no_reports(self, inputs, _):
        folder = self.world.home / "rubbish"
        folder.mkdir(exist_ok=True)
        (folder / "noise.txt").write_bytes(self.draw.randbytes(5000))
        (folder / "cut.txt.gz").write_bytes(b"\x1f\x8b\x08\0\0\0\0\0\0\3" + self.draw.randbytes(50))
        status = subprocess.run(self.world.adapt([*inputs, str(folder)]), **QUIET).returncode
        assert status == 1, status

    def two_at_once(self, inputs, _):
        runs = [subprocess.Popen(self.world.adapt(inputs), **QUIET) for _ in range(2)]
        statuses = sorted(run.wait() for run in runs)
        assert statuses in ([0, 0], [0, 2]), statuses

    def damaged(self, inputs, _):
        # A tail with nothing new is not read.
        flying = {pathlib.Path(path).parent.name for path in self.tonight}
        files = sorted((self.world.output / "segments").iterdir())
        path = self.draw.choice([path for path in files if path.name.split(".")[0] in flying])
        good = path.read_bytes()
        places = [place for place, byte in enumerate(good) if chr(byte).isdigit()]
        place = self.draw.choice(places)
        path.write_bytes(good[:place] + bytes([48 + (good[place] - 47) % 10]) + good[place + 1 :])
        status = subprocess.run(self.world.adapt(inputs), **QUIET).returncode
        assert status in (1, 2), status
        path.write_bytes(good)


def live(world, asked, faults):
    lasts = 1.0
    for night in range(asked.nights):
        started = time.monotonic()
        if faults and night % asked.every == asked.every - 1:
            faults.strike(night, lasts)
        world.night(night)
        lasts = time.monotonic() - started if not faults else lasts * 0.9 + 0.1 * (time.monotonic() - started)
        if night % MONTH == MONTH - 1:
            world.month(night)
            print(f"{world.home.name}: {night + 1} nights, the last in {lasts:.1f} s", flush=True)
    committed(world.output)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--nights", type=int, default=730)
    parser.add_argument("--tails", type=int, default=100)
    parser.add_argument("--every", type=int, default=10)
    parser.add_argument("--diagnosed", type=int, default=1, help="months of which one is diagnosed: most of the time goes there")
    parser.add_argument("--samples", type=int, help="end every report after so many, for more nights in the same time")
    parser.add_argument("--flies-every", type=int, default=1, help="nights from one flight of a tail to its next")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    if asked.flies_every > min(asked.every, asked.tails):
        parser.error("--flies-every: every tail flies before the first fault, and some tail flies each night")
    asked.flights = -(-asked.nights // asked.flies_every)
    print(f"seed {asked.seed}", flush=True)
    undisturbed, disturbed = World(asked, "undisturbed"), World(asked, "disturbed")
    if not undisturbed.reports.exists():
        make_reports(undisturbed.reports, asked.flights * asked.tails, asked.tails, asked.samples)
    fixture = ROOT / "fixtures/global5000"
    subprocess.run([undisturbed.program, "init", "--aircraft", str(fixture / "AIRCRAFT.ron"), "--guide",
                    str(fixture / "guide.csv"), "-o", str(asked.folder / "MODEL.ron"), "--force"], check=True, **QUIET)
    faults = Faults(disturbed, asked.seed)
    live(undisturbed, asked, None)
    live(disturbed, asked, faults)
    assert digest(undisturbed.output) == digest(disturbed.output), "state differs"
    assert undisturbed.documents.keys() == disturbed.documents.keys()
    for name, document in undisturbed.documents.items():
        assert document.replace(b"undisturbed", b"disturbed") == disturbed.documents[name], f"{name} differs"
    struck = ", ".join(f"{count} {kind}" for kind, count in sorted(faults.done.items()))
    print(f"{asked.nights} nights of {asked.tails} tails, {sum(faults.done.values())} faults ({struck}): the same bytes of "
          f"{3 * asked.tails} files of state and {len(undisturbed.documents)} documents")


if __name__ == "__main__":
    main()
