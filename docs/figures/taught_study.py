"""A book whose drag is off by a tenth with a tilt, taught by flights: are later effects named rightly? Table of the page "Blind trials".

    python3 docs/figures/taught_study.py target/release/cruisefit WORK [--models 10] [--taught 30] [--flights 15] [--first-seed 20262201]

The guide is the study's: drag wrong by -5 % and more, by Mach number and lift coefficient. Each model is taught by the clean flights
of one seed; each later effect, and nothing, is flown with seeds of its own. Seeds below 20262201 are for development.
Writes WORK/taught-study.csv and prints the table. Standard library only; ten models take some three minutes.
"""

import argparse
import csv
import json
import math
import shutil
from pathlib import Path

from learning_curves import X_AIRCRAFT, Runner, plan

# 1.6 times typical sizes, as a fault would be that somebody asks about.
EFFECTS = {"zero_lift_drag": 8.0, "mach_bias": -0.008, "drag_factor": 2.5}
SURE = 0.9


def diagnosed(run, name, reports, model):
    out = run.work / f"{name}-diagnosis"
    shutil.rmtree(out, ignore_errors=True)
    run("diagnose", *reports, "--model", model, "-o", out)
    return json.loads((out / "diagnosis.json").read_text())["diagnoses"][0]


def case(run, seed, place, effect, model, flights):
    size = EFFECTS.get(effect)
    effects = f'(id: "{effect}", size: {size})' if size else ""
    name = f"later-{seed}-{effect}"
    reports = run.simulate(name, plan(seed + 100_000 * (place + 1), "Preset(citation_x)", effects, f"flights: {flights}"))
    found = diagnosed(run, name, reports, model)
    verdict, names = found["verdict"], found["causes"]
    truth = [one["probability"] for one in names if one["effect"] == effect]
    top = verdict["effects"] or [one["effect"] for one in names[:1]]
    return {
        "seed": seed,
        "planted": effect,
        "verdict": verdict["kind"],
        "named": " + ".join(top),
        "probability": round(verdict["probability"] or 0.0, 4),
        "of_planted": round(truth[0], 4) if truth else 0.0,
        "in_class": effect in [*top, *verdict["class"]],
    }


def table(rows):
    print("| planted | cases | named first | in the class | sure (>= 0.9) | sure and wrong | mean ln p of the planted |\n|---|---|---|---|---|---|---|")
    for effect in [*EFFECTS, "all"]:
        of = [row for row in rows if row["planted"] == effect or (effect == "all" and row["planted"] != "nothing")]
        sure = [row for row in of if row["verdict"] == "effects" and row["probability"] >= SURE]
        wrong = [row for row in sure if row["named"] != row["planted"]]
        mean = sum(math.log(max(row["of_planted"], 1e-6)) for row in of) / len(of)
        first = sum(row["named"] == row["planted"] for row in of)
        print(f"| {effect} | {len(of)} | {first} | {sum(row['in_class'] for row in of)} | {len(sure)} | {len(wrong)} | {mean:.2f} |")
    quiet = [row for row in rows if row["planted"] == "nothing"]
    print(f"nothing planted: no gap in {sum(row['verdict'] == 'no_gap' for row in quiet)} of {len(quiet)}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("work", type=Path)
    parser.add_argument("--models", type=int, default=10)
    parser.add_argument("--taught", type=int, default=30)
    parser.add_argument("--flights", type=int, default=15)
    parser.add_argument("--first-seed", type=int, default=20262201)
    asked = parser.parse_args()
    asked.work.mkdir(parents=True, exist_ok=True)
    run = Runner(asked.program, asked.work)
    if not (asked.work / "study").exists():
        run("simulate", "ghazi-2020", "-o", asked.work / "study")
    initial = run.init("x", X_AIRCRAFT, asked.work / "study/guide.csv")
    rows = []
    for seed in range(asked.first_seed, asked.first_seed + asked.models):
        clean = run.simulate(f"clean-{seed}", plan(seed, "Preset(citation_x)", design=f"flights: {asked.taught}"))
        model = run.adapt(f"taught-{seed}", initial, ["--law", "bayes"], clean)
        for place, effect in enumerate([*EFFECTS, "nothing"]):
            rows.append(case(run, seed, place, effect, model, asked.flights))
            print(rows[-1], flush=True)
    with (asked.work / "taught-study.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    table(rows)


if __name__ == "__main__":
    main()
