"""What the whole model predicts on flights that did not teach it: the tables of "The whole model" in "Learning curves".

    python3 docs/figures/whole_model.py target/release/cruisefit WORK [--data DIR] [--seeds FIRST COUNT] [--floor PROGRAM]
        [--exact FIRST COUNT] [--bend FIRST COUNT]

Virtual fleets are flown with `cruisefit simulate`; DIR holds fleets of forty flights flown in JSBSim, which the repository
does not carry whole: `jsbsim-737`, `jsbsim-global5000` and `jsbsim-b747`, each with `guide.csv`, `SIM-01` and, but for the
last, the measured points `static.csv`. PROGRAM is the example `floor` (`cargo build --release -p cruisefit-trials --example
floor`), which computes what an oracle with the true aircraft leaves. Some five minutes. Standard library only.
"""

import argparse
import csv
import io
import math
import statistics
import subprocess
from pathlib import Path

from learning_curves import (
    A_AIRCRAFT,
    EXACT_RECORDINGS,
    PLAIN,
    ROOT,
    X_AIRCRAFT,
    Runner,
    exact_aircraft,
    exact_guide,
    guide_of_segments,
    plan,
)

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


def inside(run, model, points, as_flown=lambda row: 1.0):
    """How many measured points lie inside their 95 % interval; `as_flown` is a factor on what was measured."""
    rows = list(csv.DictReader(io.StringIO(run("predict", "--model", model, points, text=True))))
    found = [
        abs(1 - (1 - float(row["error_percent"]) / 100) / as_flown(row))
        < 1.96 * float(row["fuel_flow_std_kg_s"]) / float(row["fuel_flow_kg_s"])
        for row in rows
        if row["error_percent"]
    ]
    return f"{sum(found)} of {len(found)}"


# The trimmed points of the Global 5000 were measured at one center of gravity, that of a mean zero-fuel mass with 12,000 lb of
# fuel (TRUTH.json); in flight it moves with the mass. Drag by the equations of TRUTH.json; a throttle that closes makes fuel flow
# follow drag by 0.79 only (d ln TSFC/d ln T = -0.21 at three quarters of the throttle).
FLOW_OVER_DRAG = 0.79


def global5000_drag(lift, mach, center_of_gravity):
    elevator = (0.6 * lift / 4.34783 - lift * (center_of_gravity - 0.25)) / (0.6 * 0.2 / 4.34783 - 1.2 + 0.45 * mach)
    alpha = (lift - 0.2 * elevator) / 4.34783
    rise = 0.0741935 * max(0, mach - 0.79)
    return 0.024 + 0.0230769 * abs(alpha) + 0.043 * lift * lift + rise + 0.04 * abs(elevator / 0.35)


def centers_of_gravity(reports):
    """The straight line of the recorded centers of gravity over mass, and the mean mass with 12,000 lb of fuel."""
    masses, centers, zero_fuel = [], [], []
    for report in reports:
        rows = [line.split() for line in report.read_text().splitlines()]
        header = {row[0]: row[1] for row in rows if len(row) > 1}
        zero_fuel.append(float(header["ZFW"]))
        for row in rows:
            if row and row[0].isdigit():
                masses.append(float(header["ZFW"]) + float(header["FOB"]) - float(row[12]))
                centers.append(float(row[16]))
    mass, center = statistics.mean(masses), statistics.mean(centers)
    pairs = list(zip(masses, centers))
    slope = sum((m - mass) * (c - center) for m, c in pairs) / sum((m - mass) ** 2 for m in masses)

    def at(pounds):
        return (center + slope * (pounds - mass)) / 100

    return at, at(statistics.mean(zero_fuel) + 12000)


def global5000_as_flown(reports):
    """What a trimmed point would have burnt at the center of gravity of a flight, over what it burnt."""
    flown, trimmed = centers_of_gravity(reports)
    print(f"Global 5000: points trimmed at {100 * trimmed:.1f} % MAC")

    def factor(row):
        state = float(row["lift_coefficient"]), float(row["mach"])
        own = global5000_drag(*state, flown(float(row["weight_lb"])))
        return (own / global5000_drag(*state, trimmed)) ** FLOW_OVER_DRAG

    return factor


def jsbsim(run, data):
    print("\n| fleet | flights learnt | mean ± std of the others | rms | within 95 % | measured points inside |")
    print("|---|---|---|---|---|---|")
    for name, aircraft in JSBSIM.items():
        folder = data / name
        model = run.init(name, aircraft, folder / "guide.csv")
        reports = sorted((folder / "SIM-01").iterdir())
        as_flown = global5000_as_flown(reports) if name == "jsbsim-global5000" else None
        for taught in (10, 20):
            adapted, found = judged(run, model, reports, reports[taught:], taught)
            points = folder / "static.csv"
            print(
                f"| {name} | {taught} | {found['mean']:+.2f} ± {found['std']:.2f} | "
                f"{math.hypot(found['mean'], found['std']):.2f} | {100 * found['coverage']:.0f} % | "
                f"{inside(run, adapted, points) if points.exists() else ''} | "
                f"{inside(run, adapted, points, as_flown) if as_flown else ''} |",
                flush=True,
            )


def initial(run, letter, preset, aircraft):
    sister = run.simulate(f"{letter}-sister", plan(100, f"Preset({preset})", more=EXACT_RECORDINGS))
    guide = run.work / f"{letter}-guide.csv"
    guide_of_segments(guide, run.segments(sister, letter))
    return run.init(letter, aircraft, guide)


def floors(program, plans):
    """Standard deviation that an oracle with the true aircraft leaves on the last thirty flights of each plan."""
    done = subprocess.run([program, "30", *map(str, plans)], capture_output=True, text=True, check=True)
    return [float(line.split()[2]) for line in done.stdout.splitlines()]


def spread(values):
    """Mean with its 95 % interval over fleets (normal)."""
    half = 1.96 * statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return f"{statistics.mean(values):.2f} ± {half:.2f}"


def virtual(run, first, count, floor):
    cases = [
        ("Citation X, drag +6 %", "citation_x", '(id: "drag_factor", size: 6.0)', initial(run, "x", "citation_x", X_AIRCRAFT)),
        ("Citation X, bad guide", "citation_x", "", run.init("xb", X_AIRCRAFT, ROOT / "fixtures/ghazi-2020/guide.csv")),
        ("A320, drag +6 %", "a320", '(id: "drag_factor", size: 6.0)', initial(run, "a", "a320", A_AIRCRAFT)),
    ]
    print(f"\n{count} fleets of each kind, seeds from {first}, the last thirty of seventy flights judge")
    print("| fleet | flights learnt | mean (range) | std (95 % interval of the mean) | rms | within 95 % (lowest) |")
    print("|---|---|---|---|---|---|")
    for number, (words, preset, effects, model) in enumerate(cases):
        fleets = [
            run.simulate(f"fleet-{number}-{seed}", plan(seed, f"Preset({preset})", effects, "flights: 70"))
            for seed in range(first, first + count)
        ]
        if floor:
            plans = [run.work / f"fleet-{number}-{seed}.ron" for seed in range(first, first + count)]
            print(f"| {words} | oracle | | {spread(floors(floor, plans))} | | |", flush=True)
        for taught in (1, 2, 3, 4, 5, 10, 20, 40):
            all_found = [judged(run, model, reports, reports[-30:], taught)[1] for reports in fleets]
            means = [found["mean"] for found in all_found]
            squares = statistics.mean(found["mean"] ** 2 + found["std"] ** 2 for found in all_found)
            covered = sum(found["coverage"] * found["n"] for found in all_found) / sum(found["n"] for found in all_found)
            print(
                f"| {words} | {taught} | {statistics.mean(means):+.2f} ({min(means):+.2f} to {max(means):+.2f}) | "
                f"{spread([found['std'] for found in all_found])} | {math.sqrt(squares):.2f} | "
                f"{100 * covered:.1f} % ({100 * min(found['coverage'] for found in all_found):.0f} %) |",
                flush=True,
            )


def exact(run, first, count):
    """Fleets of which the initial model is exactly right: standard deviation added by learning."""
    model = run.init("exact", X_AIRCRAFT, exact_guide_file(run))
    aircraft = exact_aircraft()
    print(f"\n{count} exactly true fleets, seeds from {first}")
    print("| flights learnt | points added, mean | worst | within 95 % |")
    print("|---|---|---|---|")
    fleets = []
    for seed in range(first, first + count):
        reports = run.simulate(f"exact-{seed}", plan(seed, aircraft, design="flights: 70", more=PLAIN))
        fleets.append((seed, reports, run.judge(model, reports[-30:])["std"]))
    for taught in (1, 2, 5, 10, 20, 40):
        found = [(judged(run, model, reports, reports[-30:], taught)[1], before, seed) for seed, reports, before in fleets]
        added = [(one["std"] - before, seed) for one, before, seed in found]
        covered = sum(one["coverage"] * one["n"] for one, *_ in found) / sum(one["n"] for one, *_ in found)
        print(
            f"| {taught} | {statistics.mean(by for by, _ in added):.3f} | {max(added)[0]:.3f} (seed {max(added)[1]}) | "
            f"{100 * covered:.1f} % |",
            flush=True,
        )


def exact_guide_file(run):
    guide = run.work / "exact-guide.csv"
    exact_guide(guide)
    return guide


# A drag rise by Lock's fourth-power law that begins at Mach 0.765 and adds 9 % of drag within 0.03.
BEND = (("quartic: 20.0,", "quartic: 3000.0,"), ("divergence_mach: 0.815,", "divergence_mach: 0.785274,"),
        ("fall_per_lift_coefficient: 0.10,", "fall_per_lift_coefficient: 0.0,"),
        ("critical_below_divergence: 0.1077,", "critical_below_divergence: 0.020274,"))  # fmt: skip


def bend(run, first, count):
    """A320 whose drag rise bends within one cell of 0.05, against a guide without it; flights without error judge."""
    text = (ROOT / "crates/simulate/presets/a320.ron").read_text()
    for old, new in BEND:
        assert old in text, old
        text = text.replace(old, new)
    aircraft = "Custom(" + text[text.index("\n(") + 1 :].strip() + ")"
    design = "flights: {}, low_share: 0.0, high_mach: Some((0.73, 0.795)), high_ft: Some((33000, 37000))"
    model = initial(run, "a", "a320", A_AIRCRAFT)
    bins = [(0.73, 0.755), (0.755, 0.765), (0.765, 0.775), (0.775, 0.785), (0.785, 0.795)]
    print(f"\nA drag rise that bends at Mach 0.765, {count} fleets, seeds from {first}: rms; largest error, %")
    print("| flights learnt | " + " | ".join(f"{low} to {high}" for low, high in bins) + " | within 95 % |")
    print("|---" * (len(bins) + 2) + "|")
    fleets = []
    for seed in range(first, first + count):
        reports = run.simulate(f"bend-{seed}", plan(seed, aircraft, design=design.format(40)))
        perfect = plan(seed + 5000, aircraft, design=design.format(30), more=EXACT_RECORDINGS)
        fleets.append((reports, run.simulate(f"bend-exact-{seed}", perfect)))
    for taught in (0, 10, 20, 40):
        rows = []
        for reports, judges in fleets:
            adapted = run.adapt("bend", model, [], reports[:taught]) if taught else model
            table = run.work / "bend.csv"
            run("evaluate", *judges, "--model", adapted, "-o", table)
            with table.open(newline="") as file:
                rows += [row for row in csv.DictReader(file) if row["error_percent"]]
        cells = []
        for low, high in bins:
            errors = [float(row["error_percent"]) for row in rows if low <= float(row["mach"]) < high]
            cells.append(f"{math.sqrt(statistics.mean(e * e for e in errors)):.2f}; {max(map(abs, errors)):.1f}")
        half = "error_half_width95_percent"
        known = [abs(float(row["error_percent"])) <= float(row[half]) for row in rows if row[half]]
        covered = f"{100 * statistics.mean(known):.0f} %" if known else ""
        print(f"| {taught} | " + " | ".join(cells) + f" | {covered} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("work", type=Path)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--seeds", type=int, nargs=2, default=(601, 6))
    parser.add_argument("--floor")
    parser.add_argument("--exact", type=int, nargs=2)
    parser.add_argument("--bend", type=int, nargs=2)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    run = Runner(arguments.program, arguments.work)
    if arguments.data:
        jsbsim(run, arguments.data)
    virtual(run, *arguments.seeds, arguments.floor)
    if arguments.exact:
        exact(run, *arguments.exact)
    if arguments.bend:
        bend(run, *arguments.bend)


if __name__ == "__main__":
    main()
