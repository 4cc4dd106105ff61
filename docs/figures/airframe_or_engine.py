"""Airframe or engine: tables and figure of the page "Airframe or engine?".

    python3 docs/figures/airframe_or_engine.py target/release/cruisefit WORK [--seeds 521,522] [--only plain,plain-no-n2,gauges,full,full-no-n2]

A virtual Citation X flies 120 flights without an effect and the same 120 with one: the same weather, loads and sensor errors.
The first 40 without it teach a model; flights 41 to 100 with it are diagnosed; one effect by name is applied, the right one
and wrong ones; the extended models adapt to the same sixty; flights 101 to 120 judge fuel. Drag is judged by the table that the sixty
flights without the effect teach, times what the effect truly does to drag; and, kind `plain`, by the simulator's drag coefficient.
Writes `docs/src/validation/figures/airframe-or-engine.svg`, WORK/results.json, and prints the page's tables. Standard library only.
"""

import argparse
import csv
import json
import math
import shutil
import statistics
from pathlib import Path

from learning_curves import EXACT_RECORDINGS, FIGURES, FOOT, PLAIN, X_AIRCRAFT, Runner, guide_of_segments, isa_temperature, plan
from svg import BLUE, INK, ORANGE, SOFT, Drawing

TAUGHT, DIAGNOSED, JUDGING = 40, 60, 20
SIZE = 3.0
AIRCRAFT = X_AIRCRAFT.replace("mach: (0.50, 0.95, 0.05)", "mach: (0.50, 0.94, 0.02)")
# What is planted: truly more drag in per cent, and what may be applied: the right one first.
PLANTED = {
    "tsfc_engine_2": (0.0, ["tsfc_engine_2", "fuel_flow_gain_2", "drag_factor"]),
    "tsfc_factor": (0.0, ["tsfc_factor", "drag_factor"]),
    "drag_factor": (SIZE, ["drag_factor", "tsfc_factor"]),
}
GAUGES = "    columns: (fuel_quantity: On),\n"
# Of what is flown: everything, or below the drag rise, which no six coefficients follow, and without anti-ice.
ALL = "flights: {}"
CALM = ALL + ", anti_ice_share: 0, high_mach: Some((0.68, 0.80)), low_mach: Some((0.60, 0.68))"
# Beyond the presets' defaults, flown, N2 recorded, words.
KINDS = {
    "plain": (PLAIN, CALM, True, "plain, N2"),
    "plain-no-n2": (PLAIN, CALM, False, "plain, no N2"),
    "gauges": (PLAIN + GAUGES, CALM, True, "plain, N2 and gauges"),
    "full": ("", ALL, True, "full, N2"),
    "full-no-n2": ("", ALL, False, "full, no N2"),
}


def flown(run, name, seed, effects, kind):
    """Reports of one fleet, flown once."""
    folder = run.work / name
    if not folder.exists():
        more, design, _, _ = KINDS[kind]
        text = plan(seed, "Preset(citation_x)", effects, design.format(TAUGHT + DIAGNOSED + JUDGING), more)
        file = run.work / f"{name}.ron"
        file.write_text(text)
        run("simulate", file, "-o", folder, "--states")
    return sorted((folder / "V-01").glob("*[0-9].txt"))


def without_n2(run, reports, name):
    """The same reports as an aircraft sends them that does not record N2."""
    folder = run.work / f"{name}-no-n2"
    if not folder.exists():
        folder.mkdir()
        for report in reports:
            (folder / report.name).write_text(stripped(report.read_text()))
    return sorted(folder.glob("*.txt"))


def stripped(text):
    out, keep = [], None
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == "TIME":
            out.append("MISSING N2")
            keep = [i for i, word in enumerate(words) if not word.startswith("N2(")]
        out.append(" ".join(words[i] for i in keep) if keep else line)
    return "\n".join(out) + "\n"


def diagnosis(run, name, model, reports, options=()):
    """First diagnosis, and the model extended by it or the reason why there is none."""
    folder, extended = run.work / f"{name}-found", run.work / f"{name}-extended"
    for old in (folder, extended):
        shutil.rmtree(old, ignore_errors=True)
    done = run("diagnose", *reports, "--model", model, "-o", folder, "--apply", extended, *options)
    found = json.loads((folder / "diagnosis.json").read_text())["diagnoses"][0]
    written = sorted(extended.glob("*.ron"))
    said = [line for line in (done.stdout + done.stderr).splitlines() if "applied" in line]
    return found, written[0] if written else None, " ".join(said)


def drag_in(named):
    """Per cent of drag that a named diagnosis adds."""
    added = named["addition"]["effects"] if named else []
    return sum(effect["size"] for effect in added if effect["effect"] == "drag_factor")


class Table:
    """Drag of an exported model, with the drag effects applied to it."""

    def __init__(self, run, model, more_percent):
        out = run.work / "table.csv"
        run("export", model, "-o", out)
        with out.open(newline="") as file:
            rows = [[float(row[key]) for key in ("lift_coefficient", "mach", "drag_coefficient")] for row in csv.DictReader(file)]
        self.lifts, self.machs = sorted({row[0] for row in rows}), sorted({row[1] for row in rows})
        self.drag = {(row[0], row[1]): row[2] * (1 + more_percent / 100) for row in rows}

    def at(self, lift, mach):
        low, share_l = cell(self.lifts, lift)
        left, share_m = cell(self.machs, mach)
        value = 0
        for i, weight_l in ((low, 1 - share_l), (low + 1, share_l)):
            for j, weight_m in ((left, 1 - share_m), (left + 1, share_m)):
                value += weight_l * weight_m * self.drag[self.lifts[i], self.machs[j]]
        return value


def cell(axis, value):
    index = max(i for i in range(len(axis) - 1) if axis[i] <= value or i == 0)
    return index, (value - axis[index]) / (axis[index + 1] - axis[index])


def inside(table, lift, mach):
    return table.lifts[0] <= lift <= table.lifts[-1] and table.machs[0] <= mach <= table.machs[-1]


def states_of(report):
    with report.with_name(report.stem + "-states.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def true_segments(run, reports, name):
    """For each segment of reports that have states: means of the true states of its samples."""
    states, means = {report.stem: states_of(report) for report in reports}, []
    for row in run.segments(reports, name):
        samples = [states[row["flight"]][int(i)] for i in row["rows"].split(";")]
        mean = {key: statistics.fmean(float(s[key]) for s in samples) for key in ("lift_coefficient", "mach", "drag_coefficient")}
        mean["fuel_flow"] = statistics.fmean(float(s["fuel_flow_kg_s_1"]) + float(s["fuel_flow_kg_s_2"]) for s in samples)
        mean["row"] = row
        means.append(mean)
    return means


def fuel_error(run, model, segments):
    """Mean of predicted over truly burnt fuel flow less one, %, at flight points that a planner would ask for."""
    points = run.work / "points.csv"
    lines = ["mass_kg,pressure_altitude_ft,mach,isa_deviation_c"]
    for segment in segments:
        row = segment["row"]
        meters, sat = float(row["pressure_altitude_m"]), float(row["static_air_temperature_k"])
        lines.append(f"{row['mass_kg']},{meters / FOOT:.4f},{row['mach']},{sat - isa_temperature(meters):.5f}")
    points.write_text("\n".join(lines) + "\n")
    rows = csv.DictReader(run("predict", "--model", model, points, text=True).splitlines())
    pairs = [(float(r["fuel_flow_kg_s"]), s["fuel_flow"]) for r, s in zip(rows, segments) if r["fuel_flow_kg_s"]]
    return 100 * statistics.fmean(math.log(p / t) for p, t in pairs)


def against(table, reference, points, factor):
    """Mean, rms, share within 0.5 %, of a table against another's value times `factor`, at points."""
    off = [100 * (table.at(*p) / (factor * reference(p)) - 1) for p in points if inside(table, *p)]
    return {
        "mean": statistics.fmean(off),
        "rms": math.sqrt(statistics.fmean(v * v for v in off)),
        "largest": max(map(abs, off)),
        "within": statistics.fmean(abs(v) <= 0.5 for v in off),
        "n": len(off),
    }


def case(run, model, guide_model, planted, seed, kind, clean):
    """One effect planted in one fleet."""
    drag, applied = PLANTED[planted]
    _, _, n2, _ = KINDS[kind]
    truth = kind.split("-")[0]
    name = f"{truth}-{seed}-{planted}"
    effects = f'(id: "{planted}", size: {SIZE})'
    original = flown(run, name, seed, effects, kind)
    reports = original if n2 else without_n2(run, original, name)
    later, judging = reports[TAUGHT : TAUGHT + DIAGNOSED], original[TAUGHT + DIAGNOSED :]
    found, _, said = diagnosis(run, "free", model, later)
    result = {"planted": planted, "seed": seed, "kind": kind, "verdict": found, "said": said, "after": {}}
    segments = true_segments(run, original[TAUGHT : TAUGHT + DIAGNOSED], "truth")
    points = [(s["lift_coefficient"], s["mach"]) for s in segments]
    true_drag = {(s["lift_coefficient"], s["mach"]): s["drag_coefficient"] for s in segments}
    judges = true_segments(run, judging, "judging")
    choices = [(None, guide_model, None)]
    for effect in applied:
        named, extended, said = diagnosis(run, effect, model, later, ["--effects", effect])
        result["after"][effect] = {"said": said, "applied": named["addition"], "gap": named["gap"], "verdict": named["verdict"]}
        if extended:
            choices.append((effect, extended, named))
    for effect, start, named in choices:
        adapted = run.adapt(f"{kind}-{effect}", start, ["--law", "bayes"], later)
        table = Table(run, adapted, drag_in(named))
        answer = result["after"].setdefault(effect or "nothing", {})
        answer["drag"] = against(table, lambda p: clean["table"].at(*p), points, 1 + drag / 100)
        answer["drag_true"] = against(table, lambda p: true_drag[p], points, 1.0)
        answer["fuel"] = fuel_error(run, adapted, judges)
        answer["fuel_beyond_clean"] = answer["fuel"] - clean["fuel"]
    return result


def fleet(run, seed, kind):
    """All effects in one fleet."""
    more, design, n2, _ = KINDS[kind]
    truth = kind.split("-")[0]
    exact = run.simulate(f"{truth}-sister", plan(500, "Preset(citation_x)", "", design.format(60), EXACT_RECORDINGS + more))
    guide = run.work / f"{truth}-guide.csv"
    if not guide.exists():
        guide_of_segments(guide, run.segments(exact, f"{truth}-sister"))
    guide_model = run.init(truth, AIRCRAFT, guide)
    name = f"{truth}-{seed}-clean"
    original = flown(run, name, seed, "", kind)
    reports = original if n2 else without_n2(run, original, name)
    model = run.adapt(f"{kind}-taught", guide_model, ["--law", "bayes"], reports[:TAUGHT])
    taught = run.work / "taught.ron"
    shutil.copy(model, taught)
    later = run.adapt(f"{kind}-clean", guide_model, ["--law", "bayes"], reports[TAUGHT : TAUGHT + DIAGNOSED])
    clean = {"table": Table(run, later, 0.0)}
    segments = true_segments(run, original[TAUGHT : TAUGHT + DIAGNOSED], "truth")
    true_drag = {(s["lift_coefficient"], s["mach"]): s["drag_coefficient"] for s in segments}
    clean["drag_true"] = against(clean["table"], lambda p: true_drag[p], list(true_drag), 1.0)
    clean["fuel"] = fuel_error(run, later, true_segments(run, original[TAUGHT + DIAGNOSED :], "judging"))
    quiet = Table(run, taught, 0.0)
    clean["taught"] = against(quiet, lambda p: clean["table"].at(*p), list(true_drag), 1.0)
    found, _, _ = diagnosis(run, "clean", taught, reports[TAUGHT : TAUGHT + DIAGNOSED])
    results = [{"planted": "nothing", "seed": seed, "kind": kind, "verdict": found, **{k: v for k, v in clean.items() if k != "table"}}]
    results += [case(run, taught, guide_model, planted, seed, kind, clean) for planted in PLANTED]
    return results


def counted(values):
    """Values with how often each occurs, the most frequent first."""
    found = {}
    for value in values:
        found[value] = found.get(value, 0) + 1
    ordered = sorted(found.items(), key=lambda item: (-item[1], item[0]))
    return "; ".join(value if count == len(values) else f"{value} ({count})" for value, count in ordered)


def spread(values, digits=2, sign="+"):
    """Mean and range."""
    if not values:
        return "–"
    middle, low, high = (f"{v:{sign}.{digits}f}" for v in (statistics.fmean(values), min(values), max(values)))
    middle, low, high = (v.lstrip("+-") if float(v) == 0 else v.replace("-", "−") for v in (middle, low, high))
    return middle if low == high else f"{middle} ({low} to {high})"


def words(ids, joined):
    return joined.join(f"`{name}`" for name in ids)


def side(effect):
    """Which of the two an effect is of; a flow meter of neither."""
    if effect.startswith("fuel_flow_gain"):
        return "meter"
    if effect.startswith(("tsfc", "engine", "power", "anti_ice")):
        return "engine"
    return "airframe"


def print_verdicts(results):
    """Whether class and effects of a verdict hold the right side alone, both, or the wrong one alone."""
    print("\n| fleet | planted | leads | engine or meter only | airframe only | both | no gap | probability | closure | where |")
    print("|---" * 10 + "|")
    for kind, (_, _, _, title) in KINDS.items():
        for planted in ("nothing", *PLANTED):
            found = [r["verdict"] for r in results if (r["kind"], r["planted"]) == (kind, planted)]
            if not found:
                continue
            verdicts = [f["verdict"] for f in found]
            leads = [words(v["effects"][:1], "") if v["kind"] == "effects" else v["kind"].replace("_", " ") for v in verdicts]
            named = [v for v in verdicts if v["kind"] == "effects"]
            sides = [{side(e) for e in (*v["effects"][:1], *v["class"])} for v in named]
            only_engine = sum("airframe" not in s for s in sides)
            only_airframe = sum(s == {"airframe"} for s in sides)
            both = len(sides) - only_engine - only_airframe
            places = [f["where"][0]["slice"] if f["where"] else "none" for f in found]
            closures = [v["closure"] for v in verdicts if v["closure"] is not None]
            cells = [title, planted if planted == "nothing" else f"`{planted}`", counted(leads)]
            cells += [str(only_engine), str(only_airframe), str(both), str(sum(v["kind"] == "no_gap" for v in verdicts))]
            cells += [spread([v["probability"] for v in named], sign=""), spread(closures, sign=""), counted(places)]
            print("| " + " | ".join(cells) + " |")


def print_tables(results):
    print("\n| fleet | planted | applied | by the program | size, % | 95 % holds 3 % | drag − truth, mean % | rms % | within 0.5 % | fuel − clean, % |")
    print("|---" * 10 + "|")
    for kind, (_, _, _, title) in KINDS.items():
        for planted, (_, choices) in PLANTED.items():
            mine = [r["after"] for r in results if (r["kind"], r["planted"]) == (kind, planted)]
            if not mine:
                continue
            for choice in ("nothing", *choices):
                answers = [after[choice] for after in mine]
                done = [a for a in answers if "drag" in a]
                sizes = [e for a in done if a.get("applied") for e in a["applied"]["effects"]]
                held = [abs(e["size"] - SIZE) <= 1.96 * e["standard_deviation"] for e in sizes]
                program = "–"
                if choice != "nothing":
                    program = counted(["applied" if "drag" in a else a["verdict"]["kind"].replace("_", " ") for a in answers])
                cells = [title, f"`{planted}`", choice if choice == "nothing" else f"`{choice}`", program]
                cells += [spread([e["size"] for e in sizes]), f"{sum(held)} of {len(held)}" if held else "–"]
                cells += [spread([a["drag"]["mean"] for a in done]), spread([a["drag"]["rms"] for a in done], sign="")]
                cells += [spread([100 * a["drag"]["within"] for a in done], 0, "") + (" %" if done else "")]
                cells += [spread([a["fuel_beyond_clean"] for a in done])]
                print("| " + " | ".join(cells) + " |")


def print_truth(results):
    print("\n| fleet | planted | applied | drag − simulator's, mean % | rms % | within 0.5 % |")
    print("|---" * 6 + "|")
    for kind, (_, _, _, title) in KINDS.items():
        clean = [r for r in results if (r["kind"], r["planted"]) == (kind, "nothing")]
        rows = [("nothing", "nothing", [r["drag_true"] for r in clean])] if clean else []
        for planted, (_, choices) in PLANTED.items():
            mine = [r["after"] for r in results if (r["kind"], r["planted"]) == (kind, planted)]
            for choice in ("nothing", *choices):
                rows.append((planted, choice, [a[choice]["drag_true"] for a in mine if "drag_true" in a.get(choice, {})]))
        for planted, choice, found in rows:
            if found:
                marked = [word if word == "nothing" else f"`{word}`" for word in (planted, choice)]
                cells = [title, *marked, spread([f["mean"] for f in found]), spread([f["rms"] for f in found], sign="")]
                print("| " + " | ".join([*cells, spread([100 * f["within"] for f in found], 0, "") + " %"]) + " |")


def figure(results):
    """Drag of the adapted model against the truth, by what was applied: one mark a fleet."""
    kinds = {"plain": ("disc", BLUE), "plain-no-n2": ("ring", ORANGE)}
    width, height, left = 280, 210, 62
    drawing = Drawing(left + 3 * (width + 20) + 20, height + 132, "Drag after adapting, against the truth")
    for place, (kind, (shape, color)) in enumerate(kinds.items()):
        drawing.mark(left + 8 + 150 * place, 16, shape, color)
        drawing.text(left + 20 + 150 * place, 20, ["N2 recorded", "N2 not recorded"][place])
    for column, (planted, (_, choices)) in enumerate(PLANTED.items()):
        applied = ["nothing", *choices]
        panel = drawing.panel(left + column * (width + 20), 62, width, height, (-0.5, len(applied) - 0.5), (-4, 4))
        panel.frame([], range(-4, 5), y_labels=column == 0)
        panel.horizontal(0, INK, 1)
        panel.title(f"{planted} +3 %", "")
        for index, choice in enumerate(applied):
            drawing.text(panel.across(index), 62 + height + 18 + 16 * (index % 2), choice, "middle", SOFT)
            for side, (kind, (shape, color)) in enumerate(kinds.items()):
                afters = [r["after"][choice] for r in results if (r["kind"], r["planted"]) == (kind, planted)]
                for place, value in enumerate(a["drag"]["mean"] for a in afters if "drag" in a):
                    panel.mark(index + 0.22 * (2 * side - 1) + 0.03 * (place - 2.5), value, shape, color)
    drawing.text(16, 62 + height / 2, "drag less truth, %", "middle", SOFT, turn=-90)
    drawing.text(left, height + 118, "applied before adapting; no mark: the program applied nothing", color=SOFT)
    drawing.write(FIGURES / "airframe-or-engine.svg")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("work", type=Path)
    arguments.add_argument("--seeds", default="521,522,523,524,525")
    arguments.add_argument("--only", default=",".join(KINDS))
    options = arguments.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    run = Runner(options.program, options.work)
    results = []
    for seed in map(int, options.seeds.split(",")):
        for kind in options.only.split(","):
            results += fleet(run, seed, kind)
            (options.work / "results.json").write_text(json.dumps(results, indent=1))
            print(kind, seed, flush=True)
    print_verdicts(results)
    print_tables(results)
    print_truth(results)
    figure(results)


if __name__ == "__main__":
    main()
