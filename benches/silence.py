"""Questions whose right answer is silence, or the table of a book: what `cruisefit diagnose` says to each.

    python3 benches/silence.py FOLDER [--binary target/release/cruisefit] [--fleets 100] [--books 30] [--first-seed 20261251]
    python3 benches/silence.py FOLDER --shuffles 200 --reports REPORTS --model MODEL.ron [--first-seed 9401]

Taught: virtual fleets of three aircraft, one seed each, without any effect but what flying always has (gravity, rotation, load
factor, trim drag, …); a model from a public or handbook guide learns the first forty flights and is asked about these forty (with
`--allow-learnt`) and about the twenty after them. Books: the first twenty flights against the guide that no flight has taught,
without and with 3 % more fuel flow of engine 2. Shuffles: each report keeps everything but its fuel flow, which is the mean of
another report's. Prints one line per question and the counts. Standard library only.
"""
import argparse
import collections
import json
import pathlib
import random
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
GUIDES = {"citation_x": "fixtures/ghazi-2020", "a320": "fixtures/a320-generic", "regional_jet": "E75L"}


def run(arguments, *more):
    command = [str(arguments.binary), *map(str, more), "--threads", "1", "--no-progress", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(command)}: {done.returncode}\n{done.stderr}")
    return done


def initial_model(arguments, aircraft):
    model = arguments.folder / f"{aircraft}.ron"
    if model.exists():
        return model
    guide = GUIDES[aircraft]
    place = ROOT / guide
    if not place.is_dir():
        place = arguments.folder / guide
        run(arguments, "guide", "--type", guide, "-o", place)
    files = ["--aircraft", place / "AIRCRAFT.ron", "--guide", place / "guide.csv"]
    run(arguments, "init", *files, "-o", model, "--accept")
    return model


def simulate(arguments, aircraft, seed, flights, effects=""):
    folder = arguments.folder / f"{aircraft}-{seed}{'-engine' if effects else ''}"
    plan = folder.with_suffix(".plan")
    plan.write_text(
        f'(seed: {seed}, aircraft: Preset({aircraft}), effects: [{effects}], '
        f'tails: [(tail: "T-1", flights: Designed((flights: {flights})))])'
    )
    if not folder.exists():
        run(arguments, "simulate", plan, "-o", folder)
    return sorted((folder / "T-1").glob("*.txt"))


def verdict(arguments, model, reports, *more):
    output = arguments.folder / f"found-{reports[0].parent.parent.name}-{reports[0].parent.name}-{reports[0].stem}-{model.stem}"
    run(arguments, "diagnose", *reports, "--model", model, "-o", output, "--accept", *more)
    found = json.loads((output / "diagnosis.json").read_text())["diagnoses"][0]
    told = found["verdict"]
    best = max((one.get("probability", 0.0) for one in found.get("ranking", [])), default=0.0)
    return told["kind"], told.get("effects", []), told.get("class", []), told.get("probability", best), found


def told(question, answer):
    kind, effects, of_class, probability, _ = answer
    print(f"{question}: {kind} {'+'.join(effects)} p={probability:.2f} class={','.join(of_class)}", flush=True)
    return question, answer


def fleet(arguments, number):
    aircraft = list(GUIDES)[number % 3]
    seed = arguments.first_seed + number
    reports = simulate(arguments, aircraft, seed, 60)
    folder = arguments.folder / f"taught-{aircraft}-{seed}"
    initial = initial_model(arguments, aircraft)
    if not folder.exists():
        run(arguments, "adapt", *reports[:40], "--model", initial, "-o", folder, "--accept")
    model = next((folder / "models").glob("*.ron"))
    return [
        told(f"own {aircraft} {seed}", verdict(arguments, model, reports[:40], "--allow-learnt")),
        told(f"next {aircraft} {seed}", verdict(arguments, model, reports[40:])),
    ]


def book(arguments, number):
    aircraft = list(GUIDES)[number % 3]
    seed = arguments.first_seed + 500 + number
    initial = initial_model(arguments, aircraft)
    engine = '(id: "tsfc_engine_2", size: 3.0)'
    return [
        told(f"book {aircraft} {seed}", verdict(arguments, initial, simulate(arguments, aircraft, seed, 20))),
        told(f"engine {aircraft} {seed}", verdict(arguments, initial, simulate(arguments, aircraft, seed, 20, engine))),
    ]


def shuffle(arguments, number):
    seed = arguments.first_seed + number
    reports = sorted(arguments.reports.glob("*.txt"))
    texts = [report.read_text().splitlines() for report in reports]
    heads = [next(k for k, line in enumerate(text) if line.startswith("TIME ")) for text in texts]
    columns = [[k for k, name in enumerate(text[head].split()) if re.match(r"WF\(\d\)", name)] for text, head in zip(texts, heads)]

    def mean(text, head, places):
        rows = [line.split() for line in text[head + 2 :] if line.strip()]
        return [sum(float(row[place]) for row in rows) / len(rows) for place in places]

    means = [mean(*three) for three in zip(texts, heads, columns)]
    order = list(range(len(texts)))
    random.Random(seed).shuffle(order)
    folder = arguments.folder / f"shuffled-{seed}"
    folder.mkdir(exist_ok=True)
    written = []
    for k, (text, head, places) in enumerate(zip(texts, heads, columns)):
        lines = text[: head + 2]
        for line in text[head + 2 :]:
            row = line.split()
            for place, value in zip(places, means[order[k]]):
                row[place] = f"{value:.0f}"
            lines.append(" ".join(row))
        written.append(folder / reports[k].name)
        written[-1].write_text("\n".join(lines) + "\n")
    return [told(f"shuffle {seed}", verdict(arguments, arguments.model, written))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/cruisefit")
    parser.add_argument("--fleets", type=int, default=0)
    parser.add_argument("--books", type=int, default=0)
    parser.add_argument("--shuffles", type=int, default=0)
    parser.add_argument("--reports", type=pathlib.Path)
    parser.add_argument("--model", type=pathlib.Path)
    parser.add_argument("--first-seed", type=int, default=20261251)
    parser.add_argument("--side-by-side", type=int, default=2)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for aircraft in GUIDES:
        initial_model(arguments, aircraft)
    counts = collections.Counter()
    with ThreadPoolExecutor(arguments.side_by_side) as pool:
        jobs = [(fleet, arguments.fleets), (book, arguments.books), (shuffle, arguments.shuffles)]
        for job, number in jobs:
            for answers in pool.map(lambda k, job=job: job(arguments, k), range(number)):
                for question, (kind, effects, _, probability, _) in answers:
                    counts[question.split()[0], kind] += 1
                    if effects and probability >= 0.9:
                        counts[question.split()[0], "an effect at 0.9 or more"] += 1
    for (question, kind), count in sorted(counts.items()):
        print(f"{question}: {kind}: {count}")


if __name__ == "__main__":
    main()
