"""Fuel flow from an exported model: MODEL.json, and a table of predictions to compare with. Standard library only."""
import bisect
import csv
import json
import math
import sys

model = json.load(open(sys.argv[1], encoding="utf-8"))


def isa(altitude_m):
    """Static pressure and temperature of ISO 2533."""
    g, r, lapse = 9.80665, 287.05287, 0.0065
    if altitude_m <= 11000.0:
        t = 288.15 - lapse * altitude_m
        return 101325.0 * (t / 288.15) ** (g / (r * lapse)), t
    p11 = 101325.0 * (216.65 / 288.15) ** (g / (r * lapse))
    return p11 * math.exp(-g * (altitude_m - 11000.0) / (r * 216.65)), 216.65


def bilinear(x, y):
    """Drag coefficient, None outside the table."""
    xs, ys, values = model["lift_coefficient"], model["mach"], model["drag_coefficient"]
    if not (xs[0] <= x <= xs[-1] and ys[0] <= y <= ys[-1]):
        return None
    i = min(bisect.bisect_right(xs, x), len(xs) - 1) - 1
    j = min(bisect.bisect_right(ys, y), len(ys) - 1) - 1
    u, v = (x - xs[i]) / (xs[i + 1] - xs[i]), (y - ys[j]) / (ys[j + 1] - ys[j])
    low = values[i][j] * (1 - v) + values[i][j + 1] * v
    return low * (1 - u) + (values[i + 1][j] * (1 - v) + values[i + 1][j + 1] * v) * u


def fuel_flow(mass_kg, altitude_m, mach, deviation_k):
    p, t = isa(altitude_m)
    t += deviation_k
    rho, v = p / (287.05287 * t), mach * math.sqrt(1.4 * 287.05287 * t)
    force = 0.5 * rho * v * v * model["aircraft"]["wing_area_m2"]
    drag = bilinear(mass_kg * 9.80665 / force, mach)
    if drag is None:
        return None
    law = model["tsfc"]
    tsfc = law["static_kg_n_s"] * math.sqrt(t / 288.15) * (1 + mach) ** law["mach_exponent"]
    return force * drag * tsfc


for row in csv.DictReader(open(sys.argv[2], encoding="utf-8")):
    mass = float(row["mass_kg"]) if "mass_kg" in row else 0.45359237 * float(row["weight_lb"])
    altitude = 0.3048 * float(row["pressure_altitude_ft"])
    found = fuel_flow(mass, altitude, float(row["mach"]), float(row.get("isa_deviation_c") or 0.0))
    if row["fuel_flow_kg_s"]:
        print("value", found / float(row["fuel_flow_kg_s"]) - 1)
