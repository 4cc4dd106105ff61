"""Memory over a folder of a million reports: hard links to a few thousand, so that the disk holds them.

    cargo build --release --locked -p cruisefit
    python3 benches/links.py FOLDER [--links 1000000] [--reports 8000] [--tails 160] [--law paper] [--target target/release]

Makes FOLDER/reports and FOLDER/links on the first call, then adapts the links, and prints the most memory that the process
held, beside 32 MB and 160 bytes a file. Every flight is there many times: what is learnt has to be what the reports alone
teach, which is compared. Standard library only.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from chain import ROOT, make_reports

BYTES_A_FILE, BYTES = 160, 32e6


def make_links(reports, folder, count):
    """As many links as asked for, as many in each folder as there are reports: a file cannot have more than 65,000."""
    sources = sorted(reports.rglob("*.txt"))
    for number in range(count):
        copy, source = divmod(number, len(sources))
        if source == 0:
            (folder / f"{copy:04}").mkdir(parents=True)
        os.link(sources[source], folder / f"{copy:04}" / f"{source:06}.txt")


def adapt(asked, inputs, output):
    """Peak memory in bytes, and everything that was learnt."""
    command = [str(asked.target / "cruisefit"), "adapt", str(inputs), "--model", str(asked.folder / "MODEL.ron"),
               "--law", asked.law, "-o", str(output), "--no-progress"]
    run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(run.pid, 0)
    assert os.waitstatus_to_exitcode(status) == 0, status
    learnt = {str(path.relative_to(output)): path.read_bytes() for part in ("models", "segments")
              for path in sorted((output / part).iterdir())}
    return used.ru_maxrss * 1024, learnt


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--links", type=int, default=1_000_000)
    parser.add_argument("--reports", type=int, default=8000)
    parser.add_argument("--tails", type=int, default=160)
    parser.add_argument("--law", default="paper")
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    reports, links = asked.folder / "reports", asked.folder / "links"
    if not reports.exists():
        make_reports(reports, asked.reports, asked.tails)
    if not links.exists():
        make_links(reports, links, asked.links)
    fixture = ROOT / "fixtures/global5000"
    subprocess.run([str(asked.target / "cruisefit"), "init", "--aircraft", str(fixture / "AIRCRAFT.ron"), "--guide",
                    str(fixture / "guide.csv"), "-o", str(asked.folder / "MODEL.ron"), "--force"],
                   check=True, stdout=subprocess.DEVNULL)
    output = pathlib.Path(tempfile.mkdtemp(dir=asked.folder))
    held, learnt = adapt(asked, links, output / "links")
    held_once, learnt_once = adapt(asked, reports, output / "reports")
    shutil.rmtree(output)
    assert learnt == learnt_once, "the links taught something else than the reports"
    bound = BYTES + BYTES_A_FILE * asked.links
    print(f"{asked.links} links to {asked.reports} reports of {asked.tails} tails, law {asked.law}: {held / 1e6:.0f} MB, "
          f"{held / bound:.2f} of 32 MB and 160 bytes a file; the reports alone {held_once / 1e6:.0f} MB; the same learnt")


if __name__ == "__main__":
    main()
