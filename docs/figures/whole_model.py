"""What the whole model predicts on flights that did not teach it: the tables of "The whole model" in "Learning curves".

    python3 docs/figures/whole_model.py target/release/cruisefit WORK [--data DIR] [--seeds FIRST COUNT]

Virtual fleets are flown with `cruisefit simulate`; DIR holds fleets of forty flights flown in JSBSim, which the repository
does not carry whole: `jsbsim-737`, `jsbsim-global5000` and `jsbsim-b747`, each with `guide.csv`, `SIM-01` and, but for the
last, the measured points `static.csv`. Some five minutes. Standard library only.
"""

import argparse
import csv
import io
import math
import statistics
from pathlib import Path

from learning_curves import A_AIRCRAFT, EXACT_RECORDINGS, ROOT, X_AIRCRAFT, Runner, guide_of_segments, plan

JSBSIM = {
    "jsbsim-737": """(name: "737 (JSBSim)", type_code: "737", engines: 2, wing_area_m2: 108.78945984,
        tsfc: (static_lb_per_lbf_h: 0.683, mach_exponent: 0.0),
        table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)))""",
    "jsbsim-global5000": """(name: "Global 5000 (JSBSim)", type_code: "global5000", engines: 2, wing_area_m2: 94.94690688,
        tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0.0),
        table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)))""",
    "jsbsim-b747": """(name: "B747 (JSBSim)", type_code: "B747", engines: 4, wing_area_m2: 524.7164,
        tsfc: (static_lb_per_lbf_h: 0.605, mach_exponent: 0.0),
        table: (lift_coefficient: (0.10, 0.80, 0.02), mach: (0.50, 0.94, 0.02)))""",
}


def judged(run, model, reports, judges, taught):
    adapted = run.adapt("whole", model, [], reports[:taught])
    return adapted, run.judge(adapted, judges)


def inside(run, model, points):
    """How many measured points lie inside their 95 % interval."""
    rows = list(csv.DictReader(io.StringIO(run("predict", "--model", model, points, text=True))))
    found = [
        abs(float(row["error_percent"])) < 196 * float(row["fuel_flow_std_kg_s"]) / float(row["fuel_flow_kg_s"])
        for row in rows
        if row["error_percent"]
    ]
    return f"{sum(found)} of {len(found)}"


def jsbsim(run, data):
    print("\n| fleet | flights learnt | mean ± std of the others | rms | within 95 % | measured points inside |")
    print("|---|---|---|---|---|---|")
    for name, aircraft in JSBSIM.items():
        folder = data / name
        model = run.init(name, aircraft, folder / "guide.csv")
        reports = sorted((folder / "SIM-01").iterdir())
        for taught in (10, 20):
            adapted, found = judged(run, model, reports, reports[taught:], taught)
            points = folder / "static.csv"
            print(
                f"| {name} | {taught} | {found['mean']:+.2f} ± {found['std']:.2f} | "
                f"{math.hypot(found['mean'], found['std']):.2f} | {100 * found['coverage']:.0f} % | "
                f"{inside(run, adapted, points) if points.exists() else ''} |",
                flush=True,
            )


def initial(run, letter, preset, aircraft):
    sister = run.simulate(f"{letter}-sister", plan(100, f"Preset({preset})", more=EXACT_RECORDINGS))
    guide = run.work / f"{letter}-guide.csv"
    guide_of_segments(guide, run.segments(sister, letter))
    return run.init(letter, aircraft, guide)


def virtual(run, first, count):
    cases = [
        ("Citation X, drag +6 %", "citation_x", '(id: "drag_factor", size: 6.0)', initial(run, "x", "citation_x", X_AIRCRAFT)),
        ("Citation X, bad guide", "citation_x", "", run.init("xb", X_AIRCRAFT, ROOT / "fixtures/ghazi-2020/guide.csv")),
        ("A320, drag +6 %", "a320", '(id: "drag_factor", size: 6.0)', initial(run, "a", "a320", A_AIRCRAFT)),
    ]
    print(f"\n{count} fleets of each kind, seeds from {first}, the last thirty of seventy flights judge")
    print("| fleet | flights learnt | mean (range) | std | rms | within 95 % (lowest) |")
    print("|---|---|---|---|---|---|")
    for number, (words, preset, effects, model) in enumerate(cases):
        fleets = [
            run.simulate(f"fleet-{number}-{seed}", plan(seed, f"Preset({preset})", effects, "flights: 70"))
            for seed in range(first, first + count)
        ]
        for taught in (5, 10, 20, 40):
            all_found = [judged(run, model, reports, reports[-30:], taught)[1] for reports in fleets]
            means = [found["mean"] for found in all_found]
            squares = statistics.mean(found["mean"] ** 2 + found["std"] ** 2 for found in all_found)
            covered = sum(found["coverage"] * found["n"] for found in all_found) / sum(found["n"] for found in all_found)
            print(
                f"| {words} | {taught} | {statistics.mean(means):+.2f} ({min(means):+.2f} to {max(means):+.2f}) | "
                f"{statistics.mean(found['std'] for found in all_found):.2f} | {math.sqrt(squares):.2f} | "
                f"{100 * covered:.1f} % ({100 * min(found['coverage'] for found in all_found):.0f} %) |",
                flush=True,
            )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("work", type=Path)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--seeds", type=int, nargs=2, default=(601, 6))
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    run = Runner(arguments.program, arguments.work)
    if arguments.data:
        jsbsim(run, arguments.data)
    virtual(run, *arguments.seeds)


if __name__ == "__main__":
    main()
