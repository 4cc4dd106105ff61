"""When a page shows its first content, and how large it is: every page of the program in a headless Chromium.

    cargo build --release --locked -p cruisefit -p cruisefit-page --bin cruisefit --example page_of_many_tails
    python3 benches/first_paint.py FOLDER [--runs 7] [--target target/release]

Needs chromedriver (Debian: chromium-driver). The pages are made once into FOLDER by the program: of its demonstration, of 200 simulated
tails, and of a short plan of trials. Each is then opened from its file in a browser that was just started, the pages in turn, as often
as --runs says; printed are medians and the slowest. The browser reports the times itself, from the begin of the navigation: when the
first content is painted (first-contentful-paint of the Paint Timing standard) and when all is loaded and the scripts have run.
Starting the browser is not in them.
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parent.parent
GOAL_MS = 1000
GOAL_BYTES = 6_000_000
FIRST_PAINT = """const done = arguments[0];
new PerformanceObserver((list) => {
    const [paint] = list.getEntriesByName('first-contentful-paint');
    if (paint) done([paint.startTime, performance.getEntriesByType('navigation')[0].loadEventEnd]);
}).observe({ type: 'paint', buffered: true });"""
PLAN = """(
    seed: 17,
    tails: [%s],
)
"""
TRIALS = """(
    seed: 17, flights: 12, clean_flights: 10, duration_h: 0.5,
    parts: [(denied: exact, background: clean, kind: single, repeats: 2), (denied: exact, background: clean, kind: null, repeats: 10)],
)
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    pages = made(asked.folder.resolve(), asked.target.resolve())
    times = {name: [] for name in pages}
    for _ in range(asked.runs):
        for name, page in pages.items():
            times[name].append(paint_and_load_ms(page))
    print(f"{asked.runs} runs, each in a browser of its own\n")
    print("| page | size, kB | first content, ms | slowest, ms | all loaded, ms | |")
    print("|---|---|---|---|---|---|")
    for name, page in pages.items():
        paints, loads = zip(*times[name])
        size, median = page.stat().st_size, statistics.median(paints)
        met = "met" if median <= GOAL_MS and size <= GOAL_BYTES else "**missed**"
        print(f"| {name} | {size / 1000:.0f} | {median:.0f} | {max(paints):.0f} | {statistics.median(loads):.0f} | {met} |")


def made(folder, target):
    """Name and path of every page."""
    program = target / "cruisefit"

    def run(*words):
        subprocess.run([program, *words, "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL)

    if not (folder / "demo").exists():
        run("demo", "-o", "demo")
    tails = (f'(tail: "T-{k:03}", flights: Designed((flights: 12))%s)' % (', effects: [(id: "drag_factor")]' if k % 9 == 0 else "") for k in range(200))
    (folder / "FLEET.ron").write_text(PLAN % ", ".join(tails))
    if not (folder / "fleet").exists():
        run("simulate", "FLEET.ron", "-o", "fleet")
    if not (folder / "adapted").exists():
        run("adapt", "fleet", "--model", "demo/MODEL.ron", "-o", "adapted")
    if not (folder / "monitor").exists():
        run("monitor", "adapted", "-o", "monitor")
    if not (folder / "diagnosis").exists():
        run("diagnose", "fleet", "--model", "demo/MODEL.ron", "--fleet", "-o", "diagnosis")
    if not (folder / "trials").exists():
        (folder / "TRIALS.ron").write_text(TRIALS)
        run("trial", "TRIALS.ron", "-o", "trials")
    if not (folder / "report-200.html").exists():
        page = subprocess.run([target / "examples/page_of_many_tails"], check=True, stdout=subprocess.PIPE).stdout
        (folder / "report-200.html").write_bytes(page)
    first_of_fleet = sorted((folder / "adapted").glob("*/*.html"))
    return {
        "report.html, 1 tail": folder / "demo/adapted-bayes/report.html",
        "report.html, 200 tails with a page each": folder / "adapted/report.html",
        "page of one of them": first_of_fleet[0],
        "report.html, 200 tails on one page": folder / "report-200.html",
        "diagnosis.html, 1 tail": folder / "demo/diagnosis/diagnosis.html",
        "diagnosis.html, 200 tails": folder / "diagnosis/diagnosis.html",
        "fleet.html, 200 tails": folder / "diagnosis/fleet.html",
        "monitor.html, 200 tails": folder / "monitor/monitor.html",
        "trials.html": folder / "trials/trials.html",
    }


def paint_and_load_ms(page):
    """Opens a page in a new browser and asks it."""
    driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        port = next(found[1] for line in driver.stdout if (found := re.search(r"successfully on port (\d+)", line)))
        sessions = f"http://127.0.0.1:{port}/session"
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,900"]
        options = {"browserName": "chrome", "goog:chromeOptions": {"args": arguments}}
        session = f"{sessions}/{send(sessions, {'capabilities': {'alwaysMatch': options}})['sessionId']}"
        try:
            send(f"{session}/url", {"url": page.as_uri()})
            return send(f"{session}/execute/async", {"script": FIRST_PAINT, "args": []})
        finally:
            urllib.request.urlopen(urllib.request.Request(session, method="DELETE"), timeout=30).close()
    finally:
        driver.kill()
        driver.wait()


def send(address, body):
    request = urllib.request.Request(address, data=json.dumps(body).encode())
    with urllib.request.urlopen(request, timeout=120) as answer:
        return json.load(answer)["value"]


if __name__ == "__main__":
    main()
