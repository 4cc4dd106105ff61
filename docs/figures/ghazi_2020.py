"""Figures and numbers of docs/src/validation/ghazi_2020.md.

    python3 docs/figures/ghazi_2020.py

from the repository's root; reads fixtures/ghazi-2020, writes docs/src/validation/figures/ghazi_2020_*.svg, prints the
rest. Standard library only. Everything is replayed with paper_law.py and compared with the program's golden files first.
"""

import json
import math
import random
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # leave no __pycache__ in the documentation

from paper_law import (
    Table, axis, fit, learn, polynomial, rows_of, segments, standard_day_points, statistics,
)
from svg import INK, ORANGE, BLUE, GREEN, GREY, Drawing

ROOT = Path(__file__).resolve().parents[2]
STUDY = ROOT / "fixtures/ghazi-2020"
FIGURES = ROOT / "docs/src/validation/figures"
PAPER_STATIC_LIMIT = 4.5  # %, largest error that the paper reports at its static points
PAPER_RATIO = 3.4  # by which the paper's standard deviation fell
ORDERS = 1000

COARSE = (axis(0.15, 0.55, 0.05), axis(0.50, 0.90, 0.05))
FINE = (axis(0.15, 0.55, 0.025), axis(0.50, 0.90, 0.025))

flights = segments(STUDY / "threshold-5/expected/SIM-750_segments.csv")
every = [point for flight in flights for point in flight]
static = standard_day_points(STUDY / "static.csv")
guide = fit(standard_day_points(STUDY / "guide.csv"))


def table(grid=COARSE):
    return Table(*grid, guide)


def line(name, adapted):
    flown, at_static = statistics(adapted.errors(every)), statistics(adapted.errors(static))
    fastest = " ".join(f"{adapted.error(point):.1f}" for point in static if point.mach == 0.90)
    share = 100 * len(adapted.adapted) / len(adapted.nodes)
    print(
        f"  {name:46} flights {flown[0]:+.2f} {flown[1]:.2f} {flown[2]:5.2f}   static {at_static[0]:+.2f} "
        f"{at_static[1]:.2f} {at_static[2]:5.2f}, M 0.90: {fastest}   nodes {share:.0f} %, updates {adapted.updates}, refits after {adapted.refits}"
    )


def check():
    """The replay must give the program's golden numbers: node by node, and in the summary."""
    worst = 0.0
    for threshold in (5, 1):
        folder = STUDY / f"threshold-{threshold}/expected"
        replayed, initial = learn(table(), flights, threshold), table()
        for row in rows_of(folder / "SIM-750_table.csv"):
            node = (
                replayed.lift_coefficients.index(float(row["lift_coefficient"])),
                replayed.machs.index(float(row["mach"])),
            )
            for name, found in (
                ("drag_coefficient", replayed.drag[node]),
                ("confidence", replayed.confidence[node]),
                ("initial_drag_coefficient", initial.drag[node]),
            ):
                worst = max(worst, abs(found / float(row[name]) - 1))
        tail = json.loads((folder / "summary.json").read_text())["tails"][0]
        for when, adapted in (("before", initial), ("after", replayed)):
            expected = tail["fuel_flow_error_percent"][when]
            found = statistics(adapted.errors(every))
            for name, value in zip(("mean", "std", "max_abs"), found):
                worst = max(worst, abs(value / expected[name] - 1))
        assert tail["refits"] == len(replayed.refits)
    assert worst < 1e-9, worst
    print(f"Replay against the golden tables and summaries: largest relative difference {worst:.1e}.")


def kind(adapted, point):
    """Whether a point's prediction rests on adapted nodes: "inside", "edge" or "outside"."""
    share = sum(weight for node, weight in adapted.weights(point).items() if node in adapted.adapted)
    return "inside" if share > 1 - 1e-9 else "outside" if share < 1e-9 else "edge"


def print_variants():
    print("Mean, standard deviation and largest error, %:")
    line("initial", table())
    for threshold in (5, 1):
        line(f"{threshold} %, as published", learn(table(), flights, threshold))
        line(f"{threshold} %, local only", learn(table(), flights, threshold, "none"))
        line(f"{threshold} %, refit after the last flight", learn(table(), flights, threshold, "last"))
    line("1 %, reset of confidences, no polynomial", learn(table(), flights, 1, polynomial_too=False))
    line("1 %, polynomial, no reset of confidences", learn(table(), flights, 1, reset=False))
    line("1 %, refit weights confidence - 1", learn(table(), flights, 1, less=1))
    line("5 %, the same, after the last flight", learn(table(), flights, 5, "last", less=1))
    backward = [flight[::-1] for flight in flights]
    line("5 %, local only, segments from last to first", learn(table(), backward, 5, "none"))
    line("1 %, local only, segments from last to first", learn(table(), backward, 1, "none"))
    line("1 %, local only, flights from last to first", learn(table(), flights[::-1], 1, "none"))
    line("1 %, cells of 0.025", learn(table(FINE), flights, 1))
    line("1 %, cells of 0.025, segments from last to first", learn(table(FINE), [f[::-1] for f in flights], 1))
    for threshold in (0, 0.5, 2, 3, 4):
        line(f"{threshold} %, as published", learn(table(), flights, threshold))
        line(f"{threshold} %, local only", learn(table(), flights, threshold, "none"))


def print_flights(runs):
    print("Flight by flight: segments, lift coefficient, Mach number; mean and largest error: " + ", ".join(runs))
    for flight in flights:
        errors = [statistics(adapted.errors(flight)) for adapted in runs.values()]
        print(
            f"  {flight[0].name} {len(flight):2} {flight[0].lift_coefficient:.3f} {flight[-1].lift_coefficient:.3f} "
            f"{flight[0].mach:.2f}  " + "  ".join(f"{mean:+6.2f} {largest:5.2f}" for mean, _, largest in errors)
        )
    for name, adapted in runs.items():
        print(f"  {name}: {sum(abs(error) > 5 for error in adapted.errors(every))} of {len(every)} segments beyond 5 %")
    adapted = runs["5 %"]
    for name, moved in (("within 5 % from the start and never moved", False), ("moved", True)):
        chosen = [p for p in every if (abs(adapted.error(p) - runs["initial"].error(p)) > 1e-9) == moved]
        share = sum(adapted.errors(chosen)) / len(every)
        print(f"  5 %: {len(chosen)} segments {name}: mean {statistics(adapted.errors(chosen))[0]:+.2f}, share of the mean {share:+.2f}")


def print_static(runs):
    initial = runs["initial"]
    for threshold in ("5 %", "1 %"):
        local, published = runs[threshold + " local"], runs[threshold]
        print(f"Static points by the nodes that {threshold} adapted: initial, local only, as published; beyond {PAPER_STATIC_LIMIT} %")
        for name in ("inside", "edge", "outside"):
            chosen = [point for point in static if kind(published, point) == name]
            text = ""
            for adapted in (initial, local, published):
                errors = adapted.errors(chosen)
                text += "  {:+.2f} {:.2f} {:5.2f}".format(*statistics(errors))
                text += f" ({sum(abs(error) > PAPER_STATIC_LIMIT for error in errors)})"
            print(f"  {name:8} {len(chosen):2}{text}")
    errors = [[abs(a.error(p)) > PAPER_STATIC_LIMIT for p in static] for a in (initial, runs["5 %"], runs["1 %"])]
    print(f"  beyond {PAPER_STATIC_LIMIT} %: {[sum(e) for e in errors]} of {len(static)}")
    print("Worst at 5 %: mass, pressure altitude, Mach, CL; error initial, 5 %, 1 %; the guide's own error -100 e")
    for point in sorted(static, key=lambda point: -abs(runs["5 %"].error(point)))[:10]:
        own = 5 + 30 * (point.mach - 0.70) - 25 * (point.lift_coefficient - 0.32)
        values = [runs[name].error(point) for name in ("initial", "5 %", "1 %")]
        print(
            f"  {point.name[0]:.0f} {point.name[1]:.0f} {point.mach:.2f} {point.lift_coefficient:.3f}  "
            + " ".join(f"{value:+6.2f}" for value in values)
            + f"  {own:+6.2f}  {kind(runs['5 %'], point)}, {kind(runs['1 %'], point)}"
        )


def print_floor():
    """What no table over lift coefficient and Mach number can follow."""
    coefficients = fit(static, [1 / point.drag_coefficient**2 for point in static])
    errors = [
        100 * (1 - polynomial(coefficients, point.lift_coefficient, point.mach) / point.drag_coefficient) for point in static
    ]
    print("Polynomial (15) fitted to the 45 static points themselves: {:+.2f} {:.2f} {:.2f}".format(*statistics(errors)))
    print("Observed drag at one Mach number and lift coefficient, higher against lower level:")
    by_place = {}
    for point in static:
        by_place.setdefault((point.mach, point.name[1]), []).append(point)
    for mach, low in sorted(by_place):
        for high in sorted(level for other, level in by_place if other == mach and level > low):
            above = by_place[mach, high]
            squares = [point.lift_coefficient**2 for point in above]
            for point in by_place[mach, low]:
                at = point.lift_coefficient**2
                if min(squares) <= at <= max(squares):
                    drag = sum(
                        a.drag_coefficient * math.prod((at - other) / (square - other) for other in squares if other != square)
                        for a, square in zip(above, squares)
                    )
                    print(f"  M {mach:.2f}, CL {point.lift_coefficient:.3f}: FL{high / 100:.0f} against FL{low / 100:.0f} {100 * (drag / point.drag_coefficient - 1):+.2f} %")


def orders():
    """The ten flights in random orders: fall of the standard deviation, mean, largest error."""
    cases = {
        "cells of 0.05, as published": (COARSE, "published"),
        "cells of 0.05, local only": (COARSE, "none"),
        "cells of 0.025": (FINE, "published"),
    }
    found = {}
    print(f"Threshold 1 %, {ORDERS} random orders of the flights: 5 %, 50 %, 95 % of the orders")
    for name, (grid, refits) in cases.items():
        shuffled, results = random.Random(2020), []
        initial = statistics(table(grid).errors(every))[1]
        for _ in range(ORDERS):
            order = flights[:]
            shuffled.shuffle(order)
            mean, deviation, largest = statistics(learn(table(grid), order, 1, refits).errors(every))
            results.append((initial / deviation, mean, largest))
        own = statistics(learn(table(grid), flights, 1, refits).errors(every))
        found[name] = ([ratio for ratio, _, _ in results], initial / own[1])
        text = ""
        for k, quantity in enumerate(("ratio", "mean", "largest")):
            ranked = sorted(result[k] for result in results)
            text += f"   {quantity} {ranked[ORDERS // 20]:.2f} {ranked[ORDERS // 2]:.2f} {ranked[-ORDERS // 20]:.2f}"
        reached = sum(ratio >= PAPER_RATIO for ratio, _, _ in results)
        print(f"  {name:28}{text}   ratio {PAPER_RATIO} or more in {reached}, in the order of table 5 {initial / own[1]:.2f}")
    return found


def draw_histograms(runs):
    drawing = Drawing(720, 500, "Errors of predicted fuel flow over the 127 segments of the ten flights")
    names = {"initial": ORANGE, "5 %": BLUE, "1 %": GREEN, "1 % local": GREY}
    titles = {
        "initial": "before", "5 %": "after, threshold 5 % (no refit was due)", "1 %": "after, threshold 1 %, with global refit",
        "1 % local": "after, threshold 1 %, local only",
    }
    for k, (name, color) in enumerate(names.items()):
        errors = runs[name].errors(every)
        mean, deviation, largest = statistics(errors)
        panel = drawing.panel(60, 28 + 112 * k, 640, 84, (-5, 13), (0, 45))
        panel.frame(x_ticks=range(-4, 13, 2), y_ticks=(0, 20, 40), x_labels=k == 3)
        panel.vertical(0, INK, 1.2)
        for left in range(-5, 13):
            count = sum(left <= error < left + 1 for error in errors)
            if count:
                panel.bar(left, left + 1, count, color)
        panel.vertical(mean, INK, 1.6, "6 3")
        panel.title(titles[name], f"mean {mean:+.2f} %, standard deviation {deviation:.2f} %, largest {largest:.2f} %")
    drawing.text(380, 494, "error of predicted fuel flow, % (recorded less predicted, of recorded); dashed: mean", "middle")
    drawing.text(16, 240, "segments", "middle", turn=-90)
    drawing.write(FIGURES / "ghazi_2020_flights.svg")


def draw_static(runs):
    drawing = Drawing(720, 520, "Errors at the 45 static points over Mach number and lift coefficient")
    shapes = {"inside": "disc", "edge": "half", "outside": "ring"}
    titles = {"initial": "before", "5 %": "after, threshold 5 %", "1 %": "after, threshold 1 %"}
    colors = {"initial": ORANGE, "5 %": BLUE, "1 %": GREEN}
    for row, (quantity, limits, ticks) in enumerate(
        (("mach", (0.57, 0.93), (0.6, 0.7, 0.8, 0.9)), ("lift_coefficient", (0.13, 0.55), (0.2, 0.3, 0.4, 0.5)))
    ):
        for column, name in enumerate(titles):
            panel = drawing.panel(58 + 222 * column, 30 + 228 * row, 206, 172, limits, (-6, 18))
            panel.band(-PAPER_STATIC_LIMIT, PAPER_STATIC_LIMIT)
            panel.frame(x_ticks=ticks, y_ticks=range(-5, 18, 5), y_labels=column == 0)
            panel.horizontal(0, INK, 1.2)
            for point in static:
                shape = "ring" if name == "initial" else shapes[kind(runs[name], point)]
                panel.mark(getattr(point, quantity), runs[name].error(point), shape, colors[name])
            if row == 0:
                panel.title(titles[name], "")
        drawing.text(380, 240 + 228 * row, ("Mach number", "lift coefficient")[row], "middle")
    drawing.text(14, 230, "error of predicted fuel flow, %", "middle", turn=-90)
    x = 60
    for shape, text, width in (
        ("ring", "no node adapted", 130), ("half", "some of the four nodes adapted", 225), ("disc", "all adapted", 110),
    ):
        drawing.mark(x, 496, shape, BLUE)
        drawing.text(x + 9, 500, text)
        x += width
    drawing.rectangle(x, 489, 22, 14, "#eef3f6", "#bbb")
    drawing.text(x + 28, 500, f"within ±{PAPER_STATIC_LIMIT} %")
    drawing.write(FIGURES / "ghazi_2020_static.svg")


def draw_map(runs):
    drawing = Drawing(720, 400, "Where the ten flights were, and the nodes that they adapted")
    for column, (name, color) in enumerate((("5 %", BLUE), ("1 %", GREEN))):
        adapted = runs[name]
        panel = drawing.panel(58 + 338 * column, 30, 318, 290, (0.48, 0.92), (0.13, 0.57))
        panel.frame(
            x_ticks=adapted.machs[::2], y_ticks=adapted.lift_coefficients[::2], y_labels=column == 0,
            x_lines=adapted.machs, y_lines=adapted.lift_coefficients,
        )
        panel.vertical(0.8194, ORANGE, 1.4, "5 3")
        for i, j in adapted.nodes:
            if (i, j) in adapted.adapted:
                panel.mark(adapted.machs[j], adapted.lift_coefficients[i], "node", color)
        for flight in flights:
            for point in flight:
                panel.mark(point.mach, point.lift_coefficient, "dot", INK)
        for point in static:
            panel.mark(point.mach, point.lift_coefficient, "cross", ORANGE)
        panel.title(f"threshold {name}", f"{len(adapted.adapted)} of {len(adapted.nodes)} nodes")
    drawing.text(380, 356, "Mach number", "middle")
    drawing.text(14, 175, "lift coefficient", "middle", turn=-90)
    x = 60
    for shape, color, text, width in (
        ("node", BLUE, "adapted node", 115), ("dot", INK, "segment", 85), ("cross", ORANGE, "static point", 105),
    ):
        drawing.mark(x, 383, shape, color)
        drawing.text(x + 12, 387, text)
        x += width
    drawing.stroke(x - 6, 383, x + 18, 383, ORANGE, 1.4, "5 3")
    drawing.text(x + 26, 387, "the guide's largest Mach number")
    drawing.write(FIGURES / "ghazi_2020_map.svg")


def draw_orders(found):
    drawing = Drawing(720, 360, "Fall of the standard deviation for random orders of the ten flights, threshold 1 %")
    for k, ((name, (ratios, own)), color) in enumerate(zip(found.items(), (GREEN, GREY, BLUE))):
        panel = drawing.panel(60, 28 + 104 * k, 640, 74, (1, 6), (0, 600))
        panel.frame(x_ticks=range(1, 7), y_ticks=(0, 300, 600), x_labels=k == 2)
        for step in range(10, 60, 2):
            count = sum(step / 10 <= ratio < (step + 2) / 10 for ratio in ratios)
            if count:
                panel.bar(step / 10, (step + 2) / 10, count, color)
        panel.vertical(PAPER_RATIO, ORANGE, 1.6, "6 3")
        panel.vertical(own, INK, 1.6)
        reached = sum(ratio >= PAPER_RATIO for ratio in ratios)
        panel.title(name, f"in the order of table 5: {own:.2f}; {reached} of {len(ratios)} orders reach {PAPER_RATIO}")
    drawing.text(380, 352, "standard deviation before over after; line: order of table 5; dashed: the paper's 3.4", "middle")
    drawing.text(16, 165, "orders", "middle", turn=-90)
    drawing.write(FIGURES / "ghazi_2020_orders.svg")


def main():
    check()
    runs = {
        "initial": table(),
        "5 %": learn(table(), flights, 5),
        "1 %": learn(table(), flights, 1),
        "5 % local": learn(table(), flights, 5, "none"),
        "1 % local": learn(table(), flights, 1, "none"),
    }
    print_variants()
    print_flights(runs)
    print_static(runs)
    print_floor()
    FIGURES.mkdir(parents=True, exist_ok=True)
    draw_histograms(runs)
    draw_static(runs)
    draw_map(runs)
    draw_orders(orders())


if __name__ == "__main__":
    main()
