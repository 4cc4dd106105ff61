"""Fleets whose truth is another model's: what `cruisefit` says of aircraft that burn what OpenAP says they burn.

    python3 -m pip install numpy openap==2.6.2
    python3 benches/openap_fleets.py FOLDER --seed 20263501 --types a320,a359 [--binary target/release/cruisefit]

Drag polar, sizes and fuel flow over thrust are OpenAP's (Sun, Hoekstra and Ellerbroek 2020, doi 10.3390/aerospace7080104); its
TSFC depends on thrust alone, on neither temperature nor altitude, so that the TSFC law of this program never has its form. A drag
rise is added (Lock's fourth power, Korn's critical Mach number, 13 drag counts at OpenAP's cruise Mach number), the true gravity and
the Earth's rotation, and 3 drag counts of trim drag for 10 %MAC. A report is two hours at one level with the errors of usual
sensors: noise, errors that a flight keeps, load sheet 0.6 %, heating value 0.3 %. Forty flights each: a baseline that teaches, from
a guide that is 2 to 6 % too good and tilted, and a year later nothing or one effect at about its typical size.

Asked: the taught model about every other fleet, and the model that only its guide has taught about the baseline (a table and a TSFC
that are off, no effect) and about one engine. Prints one line a question and the counts. Same seed and versions, same fleets.
"""
import argparse
import datetime
import json
import pathlib
import subprocess

import numpy as np
import openap

KNOT, FOOT, G0, GAS, GAMMA, EARTH_M, EARTH_RAD_S = 0.514444, 0.3048, 9.80665, 287.05287, 1.4, 6371000.0, 7.2921e-5
SAMPLES, STEP_S, FLIGHTS = 121, 60.0, 40
LEVELS_FT = [31000, 33000, 35000, 37000, 39000]
HIGHER = {"glf6": 8000}

NOTHING = "nothing"
FLEETS = [
    # The right answer, and what is done: shares, Mach number, K, pressure ratio, %MAC.
    ("baseline", {}),
    (NOTHING, {}), (NOTHING, {}), (NOTHING, {}), (NOTHING, {}),
    ("zero_lift_drag", {"zero_lift": 0.03}),
    ("induced_drag", {"induced": 0.06}),
    ("wave_drag", {"rise": 0.006}),
    ("trim_drag_cg", {"forward": 10.0}),
    ("tsfc_factor", {"tsfc": 0.02}),
    ("tsfc_engine_2", {"tsfc_2": 0.03}),
    ("engine_ageing", {"yearly": 0.015}),
    ("tsfc_throttle", {"throttle": 0.006}),
    ("zero_fuel_mass_bias", {"mass": 0.015}),
    ("mach_bias", {"mach": 0.004}),
    ("temperature_bias", {"temperature": 2.0}),
    ("static_pressure_bias", {"pressure": 0.003}),
    ("fuel_flow_gain", {"meters": 0.02}),
    ("fuel_flow_gain_1", {"meter_1": 0.03}),
]
UNTAUGHT = ["baseline", NOTHING, "tsfc_engine_2", "fuel_flow_gain_1"]


def standard_temperature_k(height_m):
    return np.where(height_m < 11000, 288.15 - 0.0065 * height_m, 216.65)


def standard_pressure_pa(height_m):
    below = 101325 * (standard_temperature_k(height_m) / 288.15) ** 5.25588
    return np.where(height_m < 11000, below, 22632.06 * np.exp(-G0 * (height_m - 11000) / (GAS * 216.65)))


def pressure_altitude_m(pressure_pa):
    below = (288.15 - 288.15 * (pressure_pa / 101325) ** (1 / 5.25588)) / 0.0065
    return np.where(pressure_pa > 22632.06, below, 11000 + GAS * 216.65 / G0 * np.log(22632.06 / pressure_pa))


class Truth:
    """An aircraft as it burns."""

    def __init__(self, name):
        self.name, self.aircraft = name, openap.prop.aircraft(name)
        model = openap.FuelFlow(name)
        self.polar, self.of_thrust = model.drag.polar["clean"], model.func_fuel
        self.area, self.engines = self.aircraft["wing"]["area"], self.aircraft["engine"]["number"]
        self.largest_thrust_n, self.cruise = model.engine["max_thrust"], self.aircraft["cruise"]["mach"]
        self.sweep = np.radians(self.aircraft["wing"]["sweep"])
        self.levels_ft = [level + HIGHER.get(name, 0) for level in LEVELS_FT]
        self.shift = 0.0
        self.shift = self.cruise - 0.09 - self.critical(0.5)
        mass, pressure = 0.78 * self.aircraft["mtow"], standard_pressure_pa(np.array(36000 * FOOT))
        surface = 0.5 * GAMMA * pressure * self.cruise**2 * self.area
        self.usual_corrected_n = surface * self.drag(mass * G0 / surface, self.cruise, {}) / self.engines * 101325 / pressure

    def critical(self, lift):
        cosine, thickness = np.cos(self.sweep), self.aircraft["wing"]["t/c"] or 0.12
        return 0.95 / cosine - thickness / cosine**2 - 0.1 * lift / cosine**3 - 0.108 + self.shift

    def drag(self, lift, mach, effect):
        rise = 20 * np.maximum(mach - self.critical(lift) + effect.get("rise", 0), 0) ** 4
        zero_lift = self.polar["cd0"] * (1 + effect.get("zero_lift", 0))
        return zero_lift + rise + self.polar["k"] * (1 + effect.get("induced", 0)) * lift**2

    def fuel_kg_s(self, thrust_n, pressure_pa, effect, years):
        """Of each engine at an equal share of the thrust."""
        each = thrust_n / self.engines
        flow = self.of_thrust(each / self.largest_thrust_n) * (1 + effect.get("tsfc", 0) + effect.get("yearly", 0) * years)
        part_load = each * 101325 / pressure_pa / self.usual_corrected_n - 1
        flow = flow * (1 + effect.get("throttle", 0) * (part_load / 0.25) ** 2)
        return np.array([flow * (1 + (effect.get("tsfc_2", 0) if engine == 1 else 0)) for engine in range(self.engines)])


def smooth(random, deviation, width_s, mean=0.0):
    width = width_s / STEP_S
    kernel = np.exp(-0.5 * (np.arange(-int(4 * width) - 1, int(4 * width) + 2) / width) ** 2)
    noise = random.normal(size=SAMPLES + 2 * len(kernel))
    return mean + deviation * np.convolve(noise, kernel / np.sqrt((kernel**2).sum()), "same")[len(kernel) : len(kernel) + SAMPLES]


def flight(truth, random, tail, number, day, effect):
    """A cruise report."""
    level_m = random.choice(truth.levels_ft) * FOOT
    pressure_m = level_m + smooth(random, 2.5 * FOOT, 200)
    pressure = standard_pressure_pa(pressure_m) / (1 + effect.get("pressure", 0))
    warm = smooth(random, 1.2, 2400, random.normal(4 * np.sin(2 * np.pi * day / 365), 5))
    temperature = standard_temperature_k(pressure_m) + warm
    empty, largest = truth.aircraft["oew"], truth.aircraft["mtow"]
    lift = random.uniform(0.40, 0.58)
    wanted = lift * 0.5 * GAMMA * standard_pressure_pa(np.array(level_m)) * truth.cruise**2 * truth.area / G0
    start_mass = np.clip(wanted, 1.12 * empty, 0.97 * largest)
    zero_fuel = max(start_mass - random.uniform(0.10, 0.20) * largest, 1.02 * empty)
    start_mass = max(start_mass, zero_fuel + 0.10 * largest)
    mach = truth.cruise + random.uniform(-0.045, 0.02) - effect.get("mach", 0) + smooth(random, 0.0015, 400)
    speed = mach * np.sqrt(GAMMA * GAS * temperature)
    heading = random.uniform(0, 360)
    east = speed * np.sin(np.radians(heading)) + smooth(random, 3, 1500, random.normal(12, 12))
    north = speed * np.cos(np.radians(heading)) + smooth(random, 3, 1500, random.normal(0, 6))
    ground, drift = np.hypot(east, north), (np.degrees(np.arctan2(east, north)) - heading + 180) % 360 - 180
    latitude = random.uniform(15, 50) + np.cumsum(north * STEP_S) / EARTH_M * 57.29578
    longitude = random.uniform(-60, 20) + np.cumsum(east * STEP_S) / EARTH_M / np.cos(np.radians(latitude)) * 57.29578
    roll = smooth(random, 0.15, 600, random.normal(0, 0.35))
    gravity = 9.780327 * (1 + 0.0053024 * np.sin(np.radians(latitude)) ** 2) - 3.086e-6 * pressure_m
    gravity -= 2 * EARTH_RAD_S * east * np.cos(np.radians(latitude)) + ground**2 / (EARTH_M + pressure_m)
    acceleration, heating = np.gradient(ground, STEP_S), random.normal(0, 0.003)
    surface, balance = 0.5 * GAMMA * pressure * mach**2 * truth.area, random.uniform(19, 31) - effect.get("forward", 0)
    mass, flows, thrusts, used, centers = start_mass, [], [], [], []
    for k in range(SAMPLES):
        lift = mass * gravity[k] / np.cos(np.radians(roll[k])) / surface[k]
        centers.append(balance + 6 * (start_mass - mass) / start_mass)
        drag = truth.drag(lift, mach[k], effect) + 3e-4 * (25 - centers[-1]) / 10 * lift / 0.4
        thrusts.append(surface[k] * drag + mass * acceleration[k])
        flows.append(truth.fuel_kg_s(thrusts[-1], pressure[k], effect, day / 365) * (1 + heating))
        used.append(start_mass - mass)
        mass -= flows[-1].sum() * STEP_S
    flows, thrusts = np.array(flows), np.array(thrusts)
    impact = pressure * ((1 + 0.2 * mach**2) ** 3.5 - 1) - effect.get("pressure", 0) * pressure
    static = pressure * (1 + effect.get("pressure", 0))
    indicated = np.sqrt(5 * ((impact / static + 1) ** (2 / 7) - 1)) + effect.get("mach", 0)
    recorded_mach = indicated + random.normal(0, 0.0007) + random.normal(0, 0.0007, SAMPLES)
    sat = temperature * (1 + 0.2 * mach**2) / (1 + 0.2 * indicated**2) + effect.get("temperature", 0)
    sat = sat + random.normal(0, 0.25) + random.normal(0, 0.25, SAMPLES)
    meters = np.ones(truth.engines) + effect.get("meters", 0)
    meters[0] += effect.get("meter_1", 0)
    counted = np.concatenate([[0], np.cumsum((flows * meters).sum(1) * STEP_S)[:-1]])
    metered = flows * meters * (1 + random.normal(0, 0.002, truth.engines)) * (1 + random.normal(0, 0.004, flows.shape))
    speed_n2 = 74 + 24 * np.sqrt(thrusts / truth.engines * 101325 / pressure / truth.usual_corrected_n) + 6 * (mach - truth.cruise)
    speed_n2 = 1.13 * speed_n2 * np.sqrt(temperature / 288.15)
    rotors = speed_n2[:, None] + random.normal(0, 0.06, truth.engines) + random.normal(0, 0.06, flows.shape)
    before, sheet = 0.015 * start_mass, (zero_fuel - effect.get("mass", 0) * start_mass) * (1 + random.normal(0, 0.006))
    columns = [
        ("TIME", "s", np.arange(SAMPLES) * STEP_S, 0),
        ("ALT", "ft", pressure_altitude_m(static) / FOOT + random.normal(0, 12) + random.normal(0, 4, SAMPLES), 0),
        ("SAT", "degC", sat - 273.15, 1), ("MACH", "-", recorded_mach, 4),
        ("VTAS", "kt", recorded_mach * np.sqrt(GAMMA * GAS * sat) / KNOT, 1),
        ("GSPD", "kt", ground / KNOT + random.normal(0, 0.1, SAMPLES), 1),
        ("ROLL", "deg", roll + random.normal(0, 0.1, SAMPLES), 1), ("DRIFT", "deg", drift + random.normal(0, 0.1, SAMPLES), 1),
        *((f"N2({engine + 1})", "%", rotors[:, engine], 1) for engine in range(truth.engines)),
        *((f"WF({engine + 1})", "kg/h", 3600 * metered[:, engine], 0) for engine in range(truth.engines)),
        ("FU", "kg", before + counted, 0), ("LAT", "deg", latitude, 3), ("LON", "deg", longitude, 3),
        ("HDG", "deg", np.full(SAMPLES, heading), 1), ("CG", "%MAC", np.array(centers), 1),
    ]
    start = datetime.datetime(2019, 1, 1) + datetime.timedelta(days=float(day))
    lines = [
        "CRUISE-REPORT 1", f"AIRCRAFT {truth.name.upper()}", f"TAIL {tail}", f"FLIGHT {number:04}", f"START {start:%Y-%m-%dT%H:%M:%SZ}",
        f"ZFW {sheet:.0f} kg", f"FOB {start_mass - zero_fuel + before:.0f} kg",
        " ".join(name for name, *_ in columns), " ".join(unit for _, unit, *_ in columns),
    ]
    lines += [" ".join(f"{values[k]:.{digits}f}" for _, _, values, digits in columns) for k in range(SAMPLES)]
    return "\n".join(lines) + "\n"


def aircraft_file(truth, random):
    """AIRCRAFT.ron and guide.csv: TSFC constants that fit two Mach numbers, fuel flow some per cent too small."""
    temperature, pressure = standard_temperature_k(np.array(35000 * FOOT)), standard_pressure_pa(np.array(35000 * FOOT))

    def tsfc(mach):
        thrust = 0.5 * GAMMA * pressure * mach**2 * truth.area * truth.drag(0.5, mach, {})
        return truth.fuel_kg_s(thrust, pressure, {}, 0).sum() / thrust / np.sqrt(temperature / 288.15)

    low, high = truth.cruise - 0.06, truth.cruise
    exponent = float(np.clip(np.log(tsfc(high) / tsfc(low)) / np.log((1 + high) / (1 + low)), 0, 1.5))
    static = tsfc(high) / (1 + high) ** exponent * 3600 * 9.80665
    ron = (
        f'(name: "{truth.name}", type_code: "{truth.name.upper()}", engines: {truth.engines}, wing_area_m2: {truth.area},\n'
        f" tsfc: (static_lb_per_lbf_h: {static:.4f}, mach_exponent: {exponent:.2f}),\n table: (lift_coefficient: (0.25, 0.75, 0.05), "
        f"mach: ({truth.cruise - 0.10:.2f}, {truth.cruise + 0.06:.2f}, 0.02)))\n"
    )
    level, tilts = random.uniform(-0.06, -0.02), random.normal(0, 0.015, 2)
    rows = ["mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h"]
    for feet in sorted({*truth.levels_ft, truth.levels_ft[0] - 2000, truth.levels_ft[-1] + 2000}):
        temperature, pressure = standard_temperature_k(np.array(feet * FOOT)), standard_pressure_pa(np.array(feet * FOOT))
        for mass in np.linspace(1.12 * truth.aircraft["oew"], 0.98 * truth.aircraft["mtow"], 7):
            for mach in np.arange(truth.cruise - 0.09, truth.cruise + 0.031, 0.02):
                surface = 0.5 * GAMMA * pressure * mach**2 * truth.area
                lift = mass * G0 / surface
                if 0.25 < lift < 0.75:
                    flow = truth.fuel_kg_s(surface * truth.drag(lift, mach, {}), pressure, {}, 0).sum()
                    flow *= 1 + level + tilts[0] * (lift - 0.5) / 0.15 + tilts[1] * (mach - truth.cruise) / 0.05
                    knots = mach * np.sqrt(GAMMA * GAS * temperature) / KNOT
                    rows.append(f"{mass:.0f},{feet},{knots:.2f},{3600 * flow:.1f}")
    return ron, "\n".join(rows) + "\n"


def make(folder, name, seed):
    """The fleets of a type, where they are not there already."""
    if (folder / "guide.csv").exists():
        return
    truth, of_type = Truth(name), [seed, *name.encode()]
    for index, (_, effect) in enumerate(FLEETS):
        place = folder / f"F-{index:02}"
        place.mkdir(parents=True)
        random = np.random.default_rng([*of_type, index])
        for number in range(1, FLIGHTS + 1):
            day = (365 if index else 0) + 2.5 * number + random.uniform(0, 1)
            report = flight(truth, random, place.name, number + (100 if index else 0), day, effect)
            (place / f"{number:04}.txt").write_text(report)
    ron, guide = aircraft_file(truth, np.random.default_rng([*of_type, 99]))
    (folder / "AIRCRAFT.ron").write_text(ron)
    (folder / "guide.csv").write_text(guide)


def run(binary, *command):
    subprocess.run([binary, *map(str, command), "--quiet", "--no-progress"], check=False, stdout=subprocess.DEVNULL)


def asked(binary, folder, model, index, kind):
    """What the diagnosis of a fleet says: verdict, first cause, its probability, the class as printed, place."""
    out = folder / f"{kind}-{index:02}"
    run(binary, "diagnose", folder / f"F-{index:02}", "--model", model, "-o", out)
    found = json.loads((out / "diagnosis.json").read_text())["diagnoses"][0]
    verdict, causes = found["verdict"], found["causes"]
    first = causes[0] if causes else {"effect": "-", "probability": 0.0}
    return {
        "planted": FLEETS[index][0], "verdict": verdict["kind"], "effects": verdict["effects"], "class": verdict["class"],
        "first": first["effect"], "probability": first["probability"], "gap": found["gap"]["mean_percent"],
        "where": found["where"][0]["slice"] if found["where"] else "-",
    }


def told(kind, name, answer):
    right = answer["planted"] in [*answer["effects"], *answer["class"]]
    if kind == "untaught" and answer["planted"] in ("baseline", NOTHING):
        # A table and a TSFC that are off: the table, or outside the library; no effect of the aircraft, of the sensors, of the air.
        right = answer["effects"][:1] in ([], ["drag_table"])
    elif answer["planted"] == NOTHING:
        right = answer["verdict"] == "no_gap"
    silent = answer["verdict"] == "no_gap"
    sure = answer["verdict"] == "effects" and answer["probability"] >= 0.9
    result = "right" if right else "silent" if silent else "WRONG AND SURE" if sure else "not right, not sure"
    print(
        f"{kind:8} {name:5} {answer['planted']:20} {result:20} gap {answer['gap']:+.2f} %  {answer['verdict']:15} "
        f"{answer['first']} {answer['probability']:.2f}  where {answer['where']}", flush=True,
    )
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--types", default="b738", help="OpenAP's names, separated by commas")
    parser.add_argument("--seed", type=int, default=20263501)
    parser.add_argument("--binary", default="target/release/cruisefit")
    arguments = parser.parse_args()
    counts = {}
    for name in arguments.types.split(","):
        folder = arguments.folder / name
        make(folder, name, arguments.seed)
        guide, taught = folder / "MODEL.ron", folder / "taught"
        run(arguments.binary, "init", "--aircraft", folder / "AIRCRAFT.ron", "--guide", folder / "guide.csv", "-o", guide, "--accept", "--force")
        run(arguments.binary, "adapt", folder / "F-00", "--model", guide, "-o", taught)
        questions = [("taught", taught / "models/F-00.ron", index) for index in range(1, len(FLEETS))]
        questions += [("untaught", guide, index) for index, (planted, _) in enumerate(FLEETS) if planted in UNTAUGHT]
        for kind, model, index in questions:
            answer = asked(arguments.binary, folder, model, index, kind)
            planted = "nothing" if answer["planted"] in ("baseline", NOTHING) else "an effect"
            of = counts.setdefault((kind, planted), {})
            result = told(kind, name, answer)
            of[result] = of.get(result, 0) + 1
    for (kind, planted), of in counts.items():
        print(f"{kind}, {planted}: {sum(of.values())} questions; " + ", ".join(f"{n} {result}" for result, n in sorted(of.items())))


if __name__ == "__main__":
    main()
