"""Whose an effect is: tables of the page "A fleet".

    python3 docs/figures/fleet_levels.py target/release/cruisefit WORK [--fleets 10] [--tails 20] [--flights 12] [--first-seed 9001] [--null]

Every fleet is drawn by its seed: an effect of the type, effects of single tails, sensors of single tails, of typical size and
half of it. A clean tail of 40 flights teaches the model; `diagnose --fleet` compares the tails. Each tail's own diagnosis, from the
same run, is what one tail alone tells. Seeds below 9000 are for development; reported are 9001 and on.
Writes WORK/fleets-N.json and prints the tables. Standard library only; a fleet of 20 tails takes about a minute.
"""

import argparse
import json
import random
import shutil
from collections import defaultdict
from pathlib import Path

from learning_curves import X_AIRCRAFT, Runner

CLEAN_FLIGHTS = 40
# Typical sizes, as `cruisefit effects` prints them, and whose they may be. Physics is drawn for the type, what one aircraft or a
# box can have for tails.
TYPE = {"reynolds_number": 0.12, "wave_drag": 0.006, "tsfc_mach_exponent": 0.15, "induced_drag": 6.0, "tsfc_factor": 2.0, "zero_lift_drag": 5.0}
TAIL = {"tsfc_engine_2": 3.0, "drag_factor": 2.0, "zero_lift_drag": 5.0, "induced_drag": 6.0, "tsfc_factor": 2.0, "zero_fuel_mass_bias": 200.0}
SENSOR = {"mach_bias": 0.004, "static_pressure_bias": 0.3, "temperature_bias": 2.0, "fuel_flow_gain_1": 3.0, "fuel_flow_gain": 2.0}
# What one tail alone cannot distinguish, and the fleet is asked to.
PAIRS = [("tsfc_factor", "drag_factor"), ("fuel_flow_gain_1", "tsfc_engine_2"), ("mach_bias", "static_pressure_bias")]


def drawn(seed, tails, null):
    """Type effects, and effects of each tail with whether they are of a sensor."""
    rng = random.Random(seed)
    if null:
        return [], {}
    kind = rng.choice(sorted(TYPE))
    of_type = [(kind, rng.choice([1.0, 0.5]) * TYPE[kind])]
    of_tails = {}
    chosen = rng.sample(range(tails), max(2, round(0.3 * tails)))
    for place, tail in enumerate(chosen):
        library = SENSOR if place % 2 else TAIL
        name = rng.choice([name for name in sorted(library) if name != kind])
        share = rng.choice([1.0, 0.5]) * (rng.choice([1, -1]) if library is SENSOR else 1)
        of_tails[tail] = (name, share * library[name], share)
    return of_type, of_tails


def plan(seed, tails, flights, of_type, of_tails, gauges):
    columns = "    columns: (fuel_quantity: On),\n" if gauges else ""
    listed = ", ".join(f'(id: "{name}", size: {size})' for name, size in of_type)
    lines = [f"(\n    seed: {seed},\n    aircraft: Preset(citation_x),\n{columns}    effects: [{listed}],\n    tails: ["]
    for tail in range(tails):
        own = of_tails.get(tail)
        effects = f'(id: "{own[0]}", size: {own[1]})' if own else ""
        lines.append(f'        (tail: "{name_of(tail)}", effects: [{effects}], flights: Designed((flights: {flights}))),')
    return "\n".join(lines) + "\n    ],\n)\n"


def name_of(tail):
    return f"F-{tail:03}"


def model_of(run):
    """What the clean tail teaches; one for all fleets."""
    folder = run.work / "clean"
    if not folder.exists():
        text = f'(seed: 77, aircraft: Preset(citation_x), tails: [(tail: "CLEAN", flights: Designed((flights: {CLEAN_FLIGHTS})))])'
        (run.work / "clean.ron").write_text(text)
        run("simulate", run.work / "clean.ron", "-o", folder)
    study = run.work / "study"
    if not study.exists():
        run("simulate", "ghazi-2020", "-o", study)
    initial = run.init("x", X_AIRCRAFT, study / "guide.csv")
    return run.adapt("clean", initial, ["--law", "bayes"], sorted((folder / "CLEAN").glob("*.txt")))


def flown(run, seed, arguments):
    of_type, of_tails = drawn(seed, arguments.tails, arguments.null)
    name = f"fleet-{seed}-{arguments.tails}-{arguments.flights}{'-null' if arguments.null else ''}{'-gauges' if arguments.gauges else ''}"
    folder = run.work / name
    if not folder.exists():
        file = run.work / f"{name}.ron"
        file.write_text(plan(seed, arguments.tails, arguments.flights, of_type, of_tails, arguments.gauges))
        run("simulate", file, "-o", folder)
    return of_type, of_tails, folder


def scored(run, seed, model, arguments):
    of_type, of_tails, folder = flown(run, seed, arguments)
    out = run.work / f"found-{seed}"
    shutil.rmtree(out, ignore_errors=True)
    run("diagnose", folder, "--model", model, "-o", out, "--fleet", "--accept")
    document = json.loads((out / "diagnosis.json").read_text())
    fleet = document["fleets"][0]
    planted = [{"whose": None, "level": "type", "effect": name, "share": size / TYPE[name]} for name, size in of_type]
    for tail, (name, _, share) in sorted(of_tails.items()):
        level = "sensor" if name in SENSOR else "tail"
        planted.append({"whose": name_of(tail), "level": level, "effect": name, "share": abs(share)})
    alone = {found["tail"]: found["verdict"] for found in document["diagnoses"]}
    for one in planted:
        same = [f for f in fleet["findings"] if f["tail"] == one["whose"] and one["effect"] in f["class"]]
        elsewhere = [f for f in fleet["findings"] if f["tail"] != one["whose"] and one["effect"] in f["class"]]
        one["found"] = bool(same)
        one["level_right"] = any(f["level"] == one["level"] for f in same)
        one["level_open"] = all(len(f["levels"]) > 1 for f in same)
        one["named"] = any(f["effect"] == one["effect"] for f in same)
        partners = {name for pair in PAIRS if one["effect"] in pair for name in pair} - {one["effect"]}
        one["separated"] = any(not partners & set(f["class"]) for f in same)
        one["elsewhere"] = len(elsewhere)
        if one["whose"] is not None:
            verdict = alone[one["whose"]]
            one["one_tail_found"] = verdict["kind"] == "effects" and one["effect"] in verdict["class"] + verdict["effects"]
            one["one_tail_separated"] = one["one_tail_found"] and not partners & set(verdict["class"] + verdict["effects"])
    false_ones = [f for f in fleet["findings"] if not any(one["whose"] == f["tail"] and one["effect"] in f["class"] for one in planted)]
    clean_tails = [t for t in range(arguments.tails) if t not in of_tails]
    silent = sum(alone[name_of(t)]["kind"] == "no_gap" for t in clean_tails if name_of(t) in alone)
    return {
        "seed": seed, "planted": planted, "findings": fleet["findings"], "false": false_ones, "false_share": fleet["false_share"],
        "spread": fleet["spread_of_typical"], "smooth": fleet["smooth_discrepancy_percent"],
        "noise": [tail["noise"] for tail in fleet["tails"]], "one_tail_silent": [silent, len(clean_tails)],
    }


def share(ones, key):
    values = [bool(one[key]) for one in ones if key in one]
    return f"{sum(values)} of {len(values)}"


def report(fleets):
    planted = [one for fleet in fleets for one in fleet["planted"]]
    print("| level | share of typical | planted | found | level left open | level right, of the others | one tail alone: found |")
    print("|---|---|---|---|---|---|---|")
    for level in ("type", "tail", "sensor"):
        for size in (1.0, 0.5):
            ones = [one for one in planted if one["level"] == level and one["share"] == size]
            found = [one for one in ones if one["found"]]
            stated = [one for one in found if not one["level_open"]]
            print(f"| {level} | {size} | {len(ones)} | {len(found)} | {len(found) - len(stated)} | {share(stated, 'level_right')} | {share(ones, 'one_tail_found')} |")
    found = [one for one in planted if one["found"] and not one["level_open"]]
    findings = sum(len(fleet["findings"]) for fleet in fleets)
    false_ones = [f for fleet in fleets for f in fleet["false"]]
    disturbed = {(fleet["seed"], one["whose"]) for fleet in fleets for one in fleet["planted"]}
    misnamed = sum((fleet["seed"], f["tail"]) in disturbed for fleet in fleets for f in fleet["false"])
    print(f"\nof the false ones, {misnamed} are where something else was planted")
    print(f"level right where one is stated: {share(found, 'level_right')}; findings {findings}, false {len(false_ones)}, fleets with one {sum(bool(f['false']) for f in fleets)} of {len(fleets)}")
    kinds = defaultdict(int)
    for one in false_ones:
        kinds[one["level"], one["effect"]] += 1
    print("false:", dict(kinds))
    print("clean tails that are silent alone:", sum(f["one_tail_silent"][0] for f in fleets), "of", sum(f["one_tail_silent"][1] for f in fleets))
    print("\n| pair | planted on tails | separated by the fleet | by one tail |")
    print("|---|---|---|---|")
    for pair in PAIRS:
        ones = [one for one in planted if one["effect"] in pair and one["whose"] is not None]
        print(f"| {', '.join(pair)} | {len(ones)} | {share(ones, 'separated')} | {share(ones, 'one_tail_separated')} |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("work", type=Path)
    parser.add_argument("--fleets", type=int, default=10)
    parser.add_argument("--tails", type=int, default=20)
    parser.add_argument("--flights", type=int, default=12)
    parser.add_argument("--first-seed", type=int, default=9001)
    parser.add_argument("--null", action="store_true")
    parser.add_argument("--gauges", action="store_true", help="tank gauges are recorded")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    run = Runner(str(Path(arguments.program).resolve()), arguments.work)
    model = model_of(run)
    fleets = [scored(run, seed, model, arguments) for seed in range(arguments.first_seed, arguments.first_seed + arguments.fleets)]
    name = f"fleets-{arguments.tails}{'-null' if arguments.null else ''}{'-gauges' if arguments.gauges else ''}.json"
    (arguments.work / name).write_text(json.dumps(fleets, indent=1))
    report(fleets)


if __name__ == "__main__":
    main()
