"""How fast each law learns: figures and tables of the page "Learning curves".

    python3 docs/figures/learning_curves.py target/release/cruisefit WORK [--jsbsim DIR] [--only study,jsbsim,...]

Flies the virtual fleets with `cruisefit simulate`, adapts with the first flights, judges by the last ones, writes
`docs/src/validation/figures/learning-*.svg`, and prints the page's tables. WORK is a folder for what lies between;
DIR holds the three fleets of forty flights flown in JSBSim, which the repository does not carry whole.
Standard library only.
"""

import argparse
import csv
import json
import math
import random
import re
import shutil
import statistics
import subprocess
from pathlib import Path

from svg import BLUE, GREEN, GREY, INK, ORANGE, SOFT, Drawing

ROOT = Path(__file__).resolve().parents[2]
FIGURES = ROOT / "docs/src/validation/figures"
TAUGHT = [1, 2, 5, 10, 20, 40]
LAWS = {
    "bayes": ["--law", "bayes"],
    "paper 5 %": ["--law", "paper", "--threshold", "5"],
    "paper 1 %": ["--law", "paper", "--threshold", "1"],
}
COLORS = {"initial": GREY, "bayes": BLUE, "paper 5 %": ORANGE, "paper 1 %": GREEN, "bayes, 180 days": INK}
FOOT = 0.3048
KNOT = 1852 / 3600

X_AIRCRAFT = """(
    name: "Cessna Citation X", type_code: "C750", engines: 2, wing_area_m2: 48.96,
    tsfc: (static_lb_per_lbf_h: 0.3616, mach_exponent: 1.25),
    table: (lift_coefficient: (0.10, 0.65, 0.05), mach: (0.50, 0.95, 0.05)),
)
"""
A_AIRCRAFT = """(
    name: "A320-like", type_code: "A320", engines: 2, wing_area_m2: 122.6,
    tsfc: (static_lb_per_lbf_h: 0.3246, mach_exponent: 1.30),
    table: (lift_coefficient: (0.20, 0.85, 0.05), mach: (0.45, 0.85, 0.05)),
)
"""
# Perfect sensors, one fuel, load sheets that are right: what a guide is made of.
EXACT_RECORDINGS = """    sensors: Perfect,
    scatter: (heating_value_percent: 0.0, zero_fuel_mass_percent: 0.0, throttle_split_percent: 0.0),
"""
# A truth that the model can hold: CD0 + K CL^2 and TSFC0 sqrt(theta) (1 + M)^n with the aircraft file's numbers.
EXACT_DRAG = (0.0230, 0.060)
PLAIN = """    physics: (reynolds_number: Off, trim_drag: Off, asymmetry: Off, part_load: Off, temperature_exponent: Off, offtake: Off),
    earth: (load_factor: Off, local_gravity: Off, rotating_earth: Off, isobaric_slope: Off, coriolis_along_path: Off),
"""


class Runner:
    def __init__(self, program, work):
        self.program, self.work = program, work

    def __call__(self, *arguments, text=False):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode == 2:
            raise SystemExit(f"{arguments}: {done.stderr}")
        return done.stdout if text else done

    def simulate(self, name, plan):
        folder = self.work / name
        if not folder.exists():
            file = self.work / f"{name}.ron"
            file.write_text(plan)
            self("simulate", file, "-o", folder)
        return sorted((folder / "V-01").glob("*.txt"))

    def init(self, name, aircraft, guide):
        model = self.work / f"{name}-initial.ron"
        if isinstance(aircraft, str):
            text, aircraft = aircraft, self.work / f"{name}-AIRCRAFT.ron"
            aircraft.write_text(text)
        self("init", "--aircraft", aircraft, "--guide", guide, "-o", model)
        return model

    def adapt(self, name, model, law, reports):
        folder = self.work / "adapted" / re.sub(r"[^\w.-]", "_", name)
        shutil.rmtree(folder, ignore_errors=True)
        folder.parent.mkdir(exist_ok=True)
        # Guides of other aircraft are meant.
        self("adapt", *reports, "--model", model, *law, "--accept", "-o", folder)
        return next((folder / "models").glob("*.ron"))

    def judge(self, model, reports):
        out = self.work / "judged.json"
        self("evaluate", *reports, "--model", model, "--json", out)
        tail = json.loads(out.read_text())["tails"][0]
        error = tail["fuel_flow_error_percent"]["before"]
        return {
            "mean": error["mean"],
            "std": error["std"],
            "max": error["max_abs"],
            "n": error["n"],
            "outside": tail["outside_table"],
            "coverage": tail.get("interval95_coverage"),
        }

    def segments(self, reports, name):
        out = self.work / f"{name}-segments.csv"
        self("segment", *reports, "-o", out)
        with out.open(newline="") as file:
            return list(csv.DictReader(file))


def isa_temperature(meters):
    return 288.15 - 0.0065 * min(meters, 11000)


def isa_pressure(meters):
    pressure = 101325 * (isa_temperature(meters) / 288.15) ** 5.255879813
    return pressure * (math.exp(-9.80665 * (meters - 11000) / (287.05287 * 216.65)) if meters > 11000 else 1)


def plan(seed, aircraft, effects="", design="flights: 60", more=""):
    return (
        f"(\n    seed: {seed},\n    aircraft: {aircraft},\n{more}"
        f'    effects: [{effects}],\n    tails: [(tail: "V-01", flights: Designed(({design})))],\n)\n'
    )


def guide_of_segments(path, rows):
    """A guide that says what an aircraft without any error burns."""
    lines = ["mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h,isa_deviation_c"]
    for row in rows:
        meters, sat = float(row["pressure_altitude_m"]), float(row["static_air_temperature_k"])
        lines.append(
            f"{float(row['mass_kg']):.3f},{meters / FOOT:.2f},{float(row['true_airspeed_m_s']) / KNOT:.3f},"
            f"{3600 * float(row['fuel_flow_kg_s']):.4f},{sat - isa_temperature(meters):.3f}"
        )
    path.write_text("\n".join(lines) + "\n")


def exact_guide(path):
    """The flight-planning guide of the aircraft EXACT_DRAG, from the model's own equations."""
    zero_lift, induced = EXACT_DRAG
    lines = ["mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h"]
    for feet in range(25000, 45001, 4000):
        temperature, pressure = isa_temperature(feet * FOOT), isa_pressure(feet * FOOT)
        for mach in (0.52, 0.60, 0.68, 0.76, 0.84, 0.90):
            for mass in (11000, 12500, 14000, 15500):
                force = 0.7 * pressure * mach**2 * 48.96
                lift = mass * 9.80665 / force
                if lift < 0.60:
                    tsfc = 0.3616 / (3600 * 9.80665) * math.sqrt(temperature / 288.15) * (1 + mach) ** 1.25
                    flow = 3600 * tsfc * force * (zero_lift + induced * lift**2)
                    speed = mach * math.sqrt(1.4 * 287.05287 * temperature) / KNOT
                    lines.append(f"{mass},{feet},{speed:.5f},{flow:.5f}")
    path.write_text("\n".join(lines) + "\n")


def exact_aircraft():
    """The Citation X preset with a drag that the six coefficients hold exactly."""
    text = (ROOT / "crates/simulate/presets/citation_x.ron").read_text()
    static = 0.3616 / (3600 * 9.80665)
    for old, new in [
        ("coefficient: 0.0206,", f"coefficient: {EXACT_DRAG[0]},"),
        ("creep_per_mach: 0.10,", "creep_per_mach: 0.0,"),
        ("factor: 0.060,", f"factor: {EXACT_DRAG[1]},"),
        ("growth_per_mach2: 0.5,", "growth_per_mach2: 0.0,"),
        ("quartic: 20.0,", "quartic: 0.0,"),
        ("static_kg_n_s: 1.0242e-5,", f"static_kg_n_s: {static!r},"),
    ]:
        assert old in text, old
        text = text.replace(old, new)
    return "Custom(" + text[text.index("\n(") + 1 :].strip() + ")"


def with_half_life(run, model, reports, days):
    changed = model.with_name(model.stem + f"-half-life-{days}.ron")
    print(run("tune", *reports, "--model", model, "--half-life", days, "-o", changed, text=True))
    return changed


def learning_curve(run, name, model, reports, judged):
    """{law: {taught: judgement}}; taught 0 is the initial model."""
    judges, teachers = reports[-judged:], reports[: len(reports) - judged]
    initial = run.judge(model, judges)
    curves = {}
    for law, options in LAWS.items():
        curves[law] = {0: initial}
        for taught in [n for n in TAUGHT if n <= len(teachers)]:
            adapted = run.adapt(f"{name}-{law}-{taught}", model, options, teachers[:taught])
            curves[law][taught] = run.judge(adapted, judges)
    print_curves(name, curves)
    return curves


def print_curves(name, curves):
    any_law = next(iter(curves.values()))
    taught = list(any_law)
    print(f"\n{name}: {any_law[0]['n']} segments judge, {any_law[0]['outside']} outside the table")
    print("| taught | " + " | ".join(map(str, taught)) + " |")
    print("|---" * (len(taught) + 1) + "|")
    for law, curve in curves.items():
        cells = (f"{c['mean']:+.2f} ± {c['std']:.2f}" for c in curve.values())
        print(f"| {law} | " + " | ".join(cells) + " |")
    cells = (f"{100 * c['coverage']:.1f} %" if c["coverage"] is not None else "" for c in curves["bayes"].values())
    print("| coverage, bayes | " + " | ".join(cells) + " |")


def nice_step(span):
    for step in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10):
        if span / step <= 6:
            return step
    return 20


def line(panel, points, color, marks=True):
    for (x1, y1), (x2, y2) in zip(points, points[1:]):
        panel.drawing.stroke(panel.across(x1), panel.up(y1), panel.across(x2), panel.up(y2), color, 1.8)
    for x, y in points if marks else ():
        panel.mark(x, y, "disc", color)


def legend(drawing, x, y, names):
    for name in names:
        drawing.stroke(x, y - 4, x + 22, y - 4, COLORS[name], 2.2)
        drawing.text(x + 28, y, name if name == "initial" else "law " + name)
        x += 52 + 7.2 * len("law " + name)


def curves_figure(file, title, fleets):
    """One column per fleet: mean above, standard deviation below."""
    width, height, left, gap = 250, 170, 62, 38
    drawing = Drawing(max(440, left + len(fleets) * (width + gap)), 2 * height + 150, title)
    legend(drawing, left, 20, LAWS)
    low = {"mean": min(0, *(c["mean"] for _, curves in fleets for v in curves.values() for c in v.values())), "std": 0}
    high = {k: max(c[k] for _, curves in fleets for v in curves.values() for c in v.values()) for k in low}
    for row, key in enumerate(("mean", "std")):
        step = nice_step(high[key] - low[key])
        bottom, top = step * math.floor(low[key] / step), step * math.ceil(1.02 * high[key] / step)
        ticks = [bottom + step * k for k in range(round((top - bottom) / step) + 1)]
        for column, (name, curves) in enumerate(fleets):
            taught = list(next(iter(curves.values())))
            x, y = left + column * (width + gap), 62 + row * (height + 38)
            panel = drawing.panel(x, y, width, height, (-0.3, len(taught) - 0.7), (bottom, top))
            panel.frame([], ticks, y_labels=column == 0)
            if key == "mean":
                panel.horizontal(0, INK, 1)
                panel.title(name, "")
            for index, count in enumerate(taught):
                drawing.text(panel.across(index), y + height + 15, str(count), "middle", SOFT)
            for law in reversed(LAWS):
                line(panel, [(i, c[key]) for i, c in enumerate(curves[law].values())], COLORS[law])
        words = "mean error, %" if key == "mean" else "standard deviation, %"
        drawing.text(16, 62 + row * (height + 38) + height / 2, words, "middle", SOFT, turn=-90)
    drawing.text(left, 2 * height + 138, "flights that taught (0: initial model)", color=SOFT)
    drawing.write(FIGURES / file)


def study(run):
    fixture = ROOT / "fixtures/ghazi-2020"
    model = run.init("ghazi", fixture / "AIRCRAFT.ron", fixture / "guide.csv")
    reports = sorted((fixture / "reports").rglob("*.txt"))
    return learning_curve(run, "study, last 5 of 10 judge", model, reports, 5)


def jsbsim(run, folder):
    fixture = ROOT / "fixtures/global5000"
    model = run.init("global5000", fixture / "AIRCRAFT.ron", fixture / "guide.csv")
    fleets = []
    for tail, words in [("SIM-01", "as built"), ("SIM-02", "zero-lift drag +3 %"), ("SIM-05", "Mach reads +0.004")]:
        reports = sorted((folder / tail).glob("*.txt"))
        fleets.append((f"{tail}, {words}", learning_curve(run, f"{tail}, last 20 of 40 judge", model, reports, 20)))
        print(f"\n{tail}: the first ten teach, the other thirty judge")
        for law, options in LAWS.items():
            judged = run.judge(run.adapt(f"{tail}-ten-{law}", model, options, reports[:10]), reports[10:])
            cover = "" if judged["coverage"] is None else f", coverage {100 * judged['coverage']:.1f} %"
            print(f"  {law}: {judged['mean']:+.2f} ± {judged['std']:.2f}, largest {judged['max']:.2f}, n {judged['n']}{cover}")
    return fleets


def virtual(run, letter):
    preset, aircraft = {"x": ("citation_x", X_AIRCRAFT), "a": ("a320", A_AIRCRAFT)}[letter]
    sister = run.simulate(f"{letter}-sister", plan(100, f"Preset({preset})", more=EXACT_RECORDINGS))
    guide = run.work / f"{letter}-sister-guide.csv"
    guide_of_segments(guide, run.segments(sister, f"{letter}-sister"))
    good = run.init(f"{letter}-good", aircraft, guide)
    if letter == "x":
        bad = run.init("x-bad", X_AIRCRAFT, ROOT / "fixtures/ghazi-2020/guide.csv")
        design, words = "flights: 60", "the study's bad guide"
    else:
        fixture = ROOT / "fixtures/a320-generic"
        bad = run.init("a-bad", fixture / "AIRCRAFT.ron", fixture / "guide.csv")
        design, words = "flights: 60, low_share: 0.0", "another's guide"
    fleets = []
    for seed, title, effects, model, ranges in [
        (1, "drag +6 %", '(id: "drag_factor", size: 6.0)', good, "flights: 60"),
        (2, "drag rise 0.012 Mach early", '(id: "wave_drag", size: 0.012)', good, "flights: 60"),
        (3, words, "", bad, design),
    ]:
        reports = run.simulate(f"{letter}-{seed}", plan(seed, f"Preset({preset})", effects, ranges))
        name = f"{preset}, {title}, last 20 of 60 judge"
        fleets.append((title, learning_curve(run, name, model, reports, 20)))
    return fleets


def seeds(run, count=10):
    """Ten fleets of each kind, of the full truth and of one that is a function of lift coefficient and Mach number."""
    presets = {"x": ("citation_x", X_AIRCRAFT), "a": ("a320", A_AIRCRAFT)}
    kinds = [("drag +6 %", '(id: "drag_factor", size: 6.0)'), ("drag rise 0.012 early", '(id: "wave_drag", size: 0.012)')]
    print("\nten fleets of each kind, the first ten flights teach, the next thirty judge: mean (range) of mean and std")
    for letter, (preset, aircraft) in presets.items():
        for truth, more in (("full", ""), ("plain", PLAIN)):
            name = f"{letter}-{truth}"
            sister = run.simulate(f"{name}-sister", plan(100, f"Preset({preset})", more=EXACT_RECORDINGS + more))
            guide = run.work / f"{name}-guide.csv"
            guide_of_segments(guide, run.segments(sister, name))
            good = run.init(name, aircraft, guide)
            cases = [(words, effects, good) for words, effects in kinds]
            if letter == "x":
                cases.append(("bad guide", "", run.init("x-bad", aircraft, ROOT / "fixtures/ghazi-2020/guide.csv")))
            for words, effects, model in cases:
                reports = run.simulate(f"{name}-{re.sub('[^a-z0-9]', '', words)}-long", plan(10, f"Preset({preset})", effects, "flights: 360", more))
                judged = run.judge(run.adapt("long", model, LAWS["bayes"], reports[:300]), reports[300:])
                print(
                    f"| {preset}, {truth} truth | {words} | bayes, 300 teach, 60 judge | {judged['mean']:+.2f} | {judged['std']:.2f} | "
                    f"| {100 * judged['coverage']:.1f} % |"
                )
                found = {law: [] for law in ("initial", *LAWS)}
                for seed in range(11, 11 + count):
                    text = plan(seed, f"Preset({preset})", effects, "flights: 40", more)
                    reports = run.simulate(f"{name}-{re.sub('[^a-z0-9]', '', words)}-{seed}", text)
                    found["initial"].append(run.judge(model, reports[10:]))
                    for law, options in LAWS.items():
                        adapted = run.adapt("seeds", model, options, reports[:10])
                        found[law].append(run.judge(adapted, reports[10:]))
                for law, all_judged in found.items():
                    parts = []
                    for key in ("mean", "std"):
                        v = [judged[key] for judged in all_judged]
                        parts.append(f"{statistics.mean(v):+.2f} ({min(v):+.2f} to {max(v):+.2f})")
                    met = sum(abs(j["mean"]) <= 0.4 and j["std"] <= 0.85 for j in all_judged)
                    cover = ""
                    if law == "bayes":
                        inside = sum(round(j["coverage"] * j["n"]) for j in all_judged)
                        lowest = min(j["coverage"] for j in all_judged)
                        cover = f"{100 * inside / sum(j['n'] for j in all_judged):.1f} % (lowest {100 * lowest:.1f} %)"
                    print(f"| {preset}, {truth} truth | {words} | {law} | {' | '.join(parts)} | {met} of {count} | {cover} |")


def exact(run, seeds=20):
    """Fleets whose initial model is exactly true: what adaptation adds, and whether intervals and nodes cover."""
    guide = run.work / "exact-guide.csv"
    exact_guide(guide)
    model = run.init("exact", X_AIRCRAFT, guide)
    with_exact = exact_aircraft()
    added = {law: {n: [] for n in TAUGHT} for law in LAWS}
    shift = {law: {n: [] for n in TAUGHT} for law in LAWS}
    inside = {n: [0, 0] for n in TAUGHT}
    nodes = {n: [0, 0, 0] for n in TAUGHT}
    initial_mean, initial_std = [], []
    tuned_inside, tuned_added = {n: [0, 0] for n in TAUGHT}, {n: [] for n in TAUGHT}
    for seed in range(1, seeds + 1):
        reports = run.simulate(f"exact-{seed}", plan(seed, with_exact, more=PLAIN))
        judges = reports[-20:]
        before = run.judge(model, judges)
        initial_mean.append(before["mean"])
        initial_std.append(before["std"])
        for law, options in LAWS.items():
            for taught in TAUGHT:
                adapted = run.adapt(f"exact-{law}", model, options, reports[:taught])
                after = run.judge(adapted, judges)
                added[law][taught].append(after["std"] - before["std"])
                shift[law][taught].append(after["mean"] - before["mean"])
                if law == "bayes":
                    inside[taught][0] += round(after["coverage"] * after["n"])
                    inside[taught][1] += after["n"]
                    for lift, _, counts, std, informed in shown_nodes(run, adapted):
                        truth = 1e4 * (EXACT_DRAG[0] + EXACT_DRAG[1] * lift**2)
                        if informed:
                            nodes[taught][0] += abs(counts - truth) <= 1.96 * std
                            nodes[taught][1] += 1
                            nodes[taught][2] += std / truth
        tuned = run.work / "exact-tuned.ron"
        run("tune", *reports[:40], "--model", model, "-o", tuned)
        for taught in TAUGHT:
            after = run.judge(run.adapt("exact-tuned", tuned, LAWS["bayes"], reports[:taught]), judges)
            tuned_added[taught].append(after["std"] - before["std"])
            tuned_inside[taught][0] += round(after["coverage"] * after["n"])
            tuned_inside[taught][1] += after["n"]
    print(f"\nexactly true, {seeds} fleets: initial mean {statistics.mean(initial_mean):+.3f} ± {statistics.stdev(initial_mean):.3f}")
    print(f"initial std {statistics.mean(initial_std):.3f}, {min(initial_std):.3f} to {max(initial_std):.3f}")
    print("| taught | " + " | ".join(map(str, TAUGHT)) + " |")
    for law in LAWS:
        for words, values in (("added std", added[law]), ("added mean", shift[law])):
            cells = (f"{statistics.mean(v):+.3f} ({min(v):+.2f} to {max(v):+.2f})" for v in values.values())
            print(f"| {law}, {words} | " + " | ".join(cells) + " |")
    print("| coverage of unseen segments | " + " | ".join(f"{100 * a / b:.1f} %" for a, b in inside.values()) + " |")
    print("| the same, settings tuned on 40 flights | " + " | ".join(f"{100 * a / b:.1f} %" for a, b in tuned_inside.values()) + " |")
    cells = (f"{statistics.mean(v):+.3f} ({min(v):+.2f} to {max(v):+.2f})" for v in tuned_added.values())
    print("| bayes tuned, added std | " + " | ".join(cells) + " |")
    print("| coverage of informed nodes | " + " | ".join(f"{100 * a / b:.1f} % of {b}" for a, b, _ in nodes.values()) + " |")
    print("| stated std of informed nodes | " + " | ".join(f"{100 * c / b:.2f} %" for _, b, c in nodes.values()) + " |")
    drawing = Drawing(620, 330, "What adaptation adds to a model that is exactly true")
    legend(drawing, 62, 20, LAWS)
    top = 0.5 * math.ceil(max(statistics.mean(v) for law in added.values() for v in law.values()) / 0.5)
    panel = drawing.panel(62, 40, 530, 230, (-0.3, len(TAUGHT) - 0.7), (-0.25, top))
    panel.frame([], [0.25 * k for k in range(round(4 * top) + 1)])
    panel.horizontal(0, INK, 1)
    for law in reversed(LAWS):
        line(panel, [(i, statistics.mean(added[law][n])) for i, n in enumerate(TAUGHT)], COLORS[law])
    for index, count in enumerate(TAUGHT):
        drawing.text(panel.across(index), 286, str(count), "middle", SOFT)
    drawing.text(327, 310, f"flights that taught; mean of {seeds} fleets", "middle", SOFT)
    drawing.text(16, 155, "standard deviation added, points", "middle", SOFT, turn=-90)
    drawing.write(FIGURES / "learning-exact.svg")


def shown_nodes(run, model):
    """Lift coefficient, Mach number, drag and its standard deviation in counts, informed or not, as `show` prints."""
    machs = []
    for text in run("show", model, text=True).splitlines():
        if text.startswith("CL \\ M"):
            machs = [float(word) for word in text.split()[3:]]
        elif machs and re.match(r"0\.\d+ ", text):
            lift = float(text.split()[0])
            cells = re.findall(r"([\d.]+)±([\d.]+)([~*]?)", text)
            for mach, (counts, std, mark) in zip(machs, cells):
                yield lift, mach, float(counts), float(std), mark == "*"


def ageing(run):
    """2 % a year in TSFC over four years; after every ten flights the next ten judge."""
    guide = run.work / "exact-guide.csv"
    exact_guide(guide)
    model = run.init("ageing", X_AIRCRAFT, guide)
    effects = '(id: "engine_ageing", size: 2.0)'
    design = 'flights: 120, dates: ("2018-01-05T12:00:00Z", "2022-01-05T12:00:00Z")'
    reports = run.simulate("ageing", plan(7, exact_aircraft(), effects, design, PLAIN))
    cases = {law: (model, options) for law, options in LAWS.items()}
    cases["bayes, 180 days"] = (with_half_life(run, model, reports, 180), LAWS["bayes"])
    cases["bayes, half-life found"] = (with_half_life(run, model, reports, "search"), LAWS["bayes"])
    curves = {"initial": []}
    for start in range(10, 111, 10):
        next_ten = reports[start : start + 10]
        curves["initial"].append((start, run.judge(model, next_ten)))
        for name, (initial, options) in cases.items():
            adapted = run.adapt(f"ageing-{name}", initial, options, reports[:start])
            curves.setdefault(name, []).append((start, run.judge(adapted, next_ten)))
    print("\nageing 2 % a year")
    print("| taught | " + " | ".join(str(start) for start, _ in curves["initial"]) + " |")
    for name, curve in curves.items():
        print(f"| {name} | " + " | ".join(f"{c['mean']:+.2f} ± {c['std']:.2f}" for _, c in curve) + " |")
    for name in ("bayes", "bayes, 180 days", "bayes, half-life found"):
        print(f"| coverage {name} | " + " | ".join(f"{100 * c['coverage']:.0f} %" for _, c in curves[name]) + " |")
    drawing = Drawing(720, 370, "An aircraft that ages 2 % a year")
    legend(drawing, 62, 20, ["initial", "bayes", "bayes, 180 days"])
    legend(drawing, 62, 40, ["paper 5 %", "paper 1 %"])
    values = [c["mean"] for curve in curves.values() for _, c in curve]
    low, high = math.floor(min(values)), math.ceil(max(values))
    panel = drawing.panel(62, 58, 630, 250, (5, 115), (low, high))
    panel.frame(range(10, 111, 10), range(low, high + 1))
    panel.horizontal(0, INK, 1)
    for name, color in COLORS.items():
        line(panel, [(start, c["mean"]) for start, c in curves[name]], color)
    drawing.text(377, 350, "flights that taught, of 120 in four years", "middle", SOFT)
    drawing.text(16, 183, "mean error of the next ten, %", "middle", SOFT, turn=-90)
    drawing.write(FIGURES / "learning-ageing.svg")


def points_csv(path, rows):
    lines = ["mass_kg,pressure_altitude_ft,mach,isa_deviation_c"]
    for row in rows:
        meters, sat = float(row["pressure_altitude_m"]), float(row["static_air_temperature_k"])
        lines.append(
            f"{row['mass_kg']},{meters / FOOT:.4f},{row['mach']},{sat - isa_temperature(meters):.5f}"
        )
    path.write_text("\n".join(lines) + "\n")


def predicted(run, model, points):
    """Fuel flow of the points: by the table alone, and by the table with what the model remembers that no table can hold."""
    flows = {}
    for kind, options in (("table", ["--table-only"]), ("with remainder", [])):
        table = csv.DictReader(run("predict", "--model", model, points, *options, text=True).splitlines())
        flows[kind] = [float(row["fuel_flow_kg_s"]) if row["fuel_flow_kg_s"] else None for row in table]
    return flows


def grid(run, folder):
    """The learnt correction at flown points on a coarse and on a finer grid."""
    fixture = ROOT / "fixtures/global5000"
    text = (fixture / "AIRCRAFT.ron").read_text()

    def stepped(step):
        changed = text.replace("(0.10, 0.80, 0.05)", f"(0.10, 0.80, {step})")
        return changed.replace("(0.50, 0.95, 0.05)", f"(0.50, {0.94 if step == 0.02 else 0.95}, {step})")

    for tail in ("SIM-01", "SIM-02", "SIM-05"):
        reports = sorted((folder / tail).glob("*.txt"))
        points = run.work / "points.csv"
        points_csv(points, run.segments(reports, tail))
        for steps, count in (((0.05, 0.02), 10), ((0.05, 0.02), 40), ((0.025, 0.0125), 10), ((0.025, 0.0125), 40)):
            flows = []
            for step in steps:
                model = run.init("grid", stepped(step), fixture / "guide.csv")
                adapted = run.adapt("grid", model, LAWS["bayes"], reports[:count])
                flows.append((predicted(run, model, points), predicted(run, adapted, points)))
            for kind in ("table", "with remainder"):
                (a0, a1), (b0, b1) = [(before[kind], after[kind]) for before, after in flows]
                x = [100 * (b / p - d / q) for p, b, q, d in zip(a0, a1, b0, b1)]
                y = [100 * (d / b - 1) for b, d in zip(a1, b1)]
                start = [100 * (q / p - 1) for p, q in zip(a0, b0)]
                print(
                    f"grid {steps[0]} to {steps[1]}, {tail}, {count} taught, {kind}, {len(x)} points: "
                    f"correction rms {rms(x):.3f}, largest {biggest(x):.3f} points; prediction rms {rms(y):.3f} %, "
                    f"largest {biggest(y):.3f} %; initial rms {rms(start):.3f} %, largest {biggest(start):.3f} %",
                    flush=True,
                )


def rms(values):
    return math.sqrt(statistics.fmean(v * v for v in values))


def biggest(values):
    return max(map(abs, values))


def outliers(run, folder):
    """Two per cent of the segments burn 10 % more than they did: fuel flow of their samples is raised in the reports."""
    fixture = ROOT / "fixtures/global5000"
    model = run.init("outliers", fixture / "AIRCRAFT.ron", fixture / "guide.csv")
    for tail in ("SIM-01", "SIM-02", "SIM-05"):
        reports = sorted((folder / tail).glob("*.txt"))
        rows = run.segments(reports, tail)
        points = run.work / "points.csv"
        points_csv(points, rows)
        for count in (10, 40):
            taught = {path.stem for path in reports[:count]}
            mine = [row for row in rows if row["flight"] in taught]
            clean = predicted(run, run.adapt("clean", model, LAWS["bayes"], reports[:count]), points)
            worst, all_rms, number = {}, {}, max(1, round(0.02 * len(mine)))
            for seed in range(1, 11):
                hit = {}
                for row in random.Random(seed).sample(mine, number):
                    hit.setdefault(row["flight"], set()).update(map(int, row["rows"].split(";")))
                spoilt = []
                for path in reports[:count]:
                    copy = run.work / "spoilt" / path.name
                    copy.parent.mkdir(exist_ok=True)
                    copy.write_text(raised(path.read_text(), hit.get(path.stem, set())))
                    spoilt.append(copy)
                dirty = predicted(run, run.adapt("dirty", model, LAWS["bayes"], spoilt), points)
                for kind in clean:
                    change = [100 * (d / c - 1) for c, d in zip(clean[kind], dirty[kind])]
                    worst.setdefault(kind, []).append(biggest(change))
                    all_rms.setdefault(kind, []).append(rms(change))
            for kind in clean:
                print(
                    f"outliers {tail}, {count} taught, {kind}: {number} of {len(mine)} segments, 10 draws: "
                    f"rms {statistics.mean(all_rms[kind]):.3f} %, largest of a draw: median {statistics.median(worst[kind]):.3f} %, "
                    f"worst {max(worst[kind]):.3f} %; draws with all below 0.2 %: {sum(w < 0.2 for w in worst[kind])}",
                    flush=True,
                )


def raised(text, rows):
    """WF columns of the samples `rows` times 1.1."""
    out, columns, sample = [], None, -2
    for words in text.splitlines():
        if words.startswith("TIME "):
            columns = [i for i, name in enumerate(words.split()) if name.startswith("WF(")]
            sample = -1
        elif columns:
            if sample in rows:
                fields = words.split()
                for i in columns:
                    fields[i] = f"{1.1 * float(fields[i]):.1f}"
                words = " ".join(fields)
            sample += 1
        out.append(words)
    return "\n".join(out) + "\n"


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("work", type=Path)
    arguments.add_argument("--jsbsim", type=Path)
    arguments.add_argument("--only", default="study,jsbsim,virtual,seeds,exact,ageing,grid,outliers")
    options = arguments.parse_args()
    parts = options.only.split(",")
    options.work.mkdir(parents=True, exist_ok=True)
    run = Runner(options.program, options.work)
    if "study" in parts:
        curves_figure("learning-study.svg", "Learning curves, study", [("ten flights of the study", study(run))])
    if "virtual" in parts:
        curves_figure("learning-citation-x.svg", "Learning curves, virtual Citation X", virtual(run, "x"))
        curves_figure("learning-a320.svg", "Learning curves, virtual A320", virtual(run, "a"))
    if "seeds" in parts:
        seeds(run)
    if "exact" in parts:
        exact(run)
    if "ageing" in parts:
        ageing(run)
    if options.jsbsim:
        if "jsbsim" in parts:
            curves_figure("learning-jsbsim.svg", "Learning curves, fleets flown in JSBSim", jsbsim(run, options.jsbsim))
        if "grid" in parts:
            grid(run, options.jsbsim)
        if "outliers" in parts:
            outliers(run, options.jsbsim)


if __name__ == "__main__":
    main()
