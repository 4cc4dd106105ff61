"""Kill -9 at random moments: the folder is always one that an uninterrupted run passes through.

    python3 benches/kill.py FOLDER [--kills 200] [--reports 5000] [--tails 50] [--law paper] [--seed N]

Half of the reports are learnt first; the run over all of them is killed at a random moment. Every file must then be
readable and the state be that before or after the run, and continuing must give the same bytes. Prints its seed.
"""
import argparse
import hashlib
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from chain import ROOT, make_reports


def digest(folder):
    """Bytes of everything that is state."""
    found = {}
    for name in ("models", "segments", "flights"):
        for path in sorted((folder / name).iterdir()):
            found[f"{name}/{path.name}"] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def committed(folder):
    """Files that STATE.ron names, each found with its SHA-256 in its place or in the waiting folder."""
    text = (folder / "STATE.ron").read_text()
    generation = re.search(r"generation: (\d+)", text)[1]
    named = dict(re.findall(r'file: "([^"]+)",\s+sha256: "([0-9a-f]+)"', text))
    for name, sha in named.items():
        waiting = folder / f".cruisefit-next-{generation}" / name
        path = waiting if waiting.exists() else folder / name
        assert hashlib.sha256(path.read_bytes()).hexdigest() == sha, f"{path} is not what STATE.ron names"
    return named


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--reports", type=int, default=5000)
    parser.add_argument("--tails", type=int, default=50)
    parser.add_argument("--law", default="paper")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    print(f"seed {asked.seed}")
    draw = random.Random(asked.seed)
    reports = asked.folder / f"reports-{asked.reports}-{asked.tails}"
    if not reports.exists():
        make_reports(reports, asked.reports, asked.tails)
    first = [str(path) for path in sorted(reports.glob("*/*.txt")) if int(path.stem) < asked.reports // asked.tails // 2]
    program, model = str(asked.target / "cruisefit"), str(asked.folder / "MODEL.ron")
    fixture = ROOT / "fixtures/global5000"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([program, "init", "--aircraft", str(fixture / "AIRCRAFT.ron"), "--guide", str(fixture / "guide.csv"),
                    "-o", model], check=True, **quiet)
    adapt = lambda what, output: [program, "adapt", *what, "--model", model, "-o", str(output), "--law", asked.law]
    begun, done, output = (asked.folder / name for name in ("begun", "done", "killed"))
    for folder in (begun, done):
        shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(adapt(first, begun), check=True, **quiet)
    shutil.copytree(begun, done)
    started = time.monotonic()
    subprocess.run(adapt([str(reports)], done), check=True, **quiet)
    lasts = time.monotonic() - started
    before, after = committed(begun), committed(done)
    expected = digest(done)
    old = new = 0
    for kill in range(asked.kills):
        shutil.rmtree(output, ignore_errors=True)
        shutil.copytree(begun, output)
        # Half of them aimed at the end, where files move.
        moment = lasts * (draw.uniform(0, 1) if kill % 2 else draw.uniform(0.8, 1.1))
        run = subprocess.Popen(adapt([str(reports)], output), **quiet)
        time.sleep(moment)
        run.kill()
        run.wait()
        state = committed(output)
        assert state in (before, after), f"kill {kill} after {moment:.3f} s: neither before nor after"
        old, new = old + (state == before), new + (state == after)
        subprocess.run(adapt([str(reports)], output), check=True, **quiet)
        assert digest(output) == expected, f"kill {kill} after {moment:.3f} s: other bytes after continuing"
        left = [path for path in output.rglob(".cruisefit-*")]
        assert not left, left
    print(f"{asked.kills} kills within {lasts:.2f} s: {old} before the commit, {new} after it; the same bytes after continuing")


if __name__ == "__main__":
    main()
