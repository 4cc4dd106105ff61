#!/usr/bin/env python3
"""The search of `diagnose` against a numpy prototype of the same method, on the same data, in the same run.

    cargo build --release --locked -p cruisefit-diagnose --example speed
    python3 docs/figures/diagnosis_speed.py PROTOTYPE.py target/release/examples/speed [CASES]

PROTOTYPE.py makes the data (600 segments of 60 flights, one planted effect), diagnoses it (signatures, whitening, evidence of
singles and pairs under 16 backgrounds, Gauss-Newton on the five leading models, agnostic functions) and is timed; the same
segments go through `speed` as CSV. Both run on one thread, taking turns; the shortest of seven runs counts.
"""
import os
os.environ.update(OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", OMP_NUM_THREADS="1")
import subprocess, sys, tempfile, time
import numpy as np

prototype, binary = sys.argv[1:3]
cases = int(sys.argv[3]) if len(sys.argv) > 3 else 5
source = open(prototype).read().split("if __name__")[0]
sys.argv = [prototype]
space = {"__name__": "prototype"}
exec(compile(source, prototype, "exec"), space)
RUNS = 7


def write(path, me):
    seconds = 1.55e9 + me["date"] * 365.25 * 86400
    flow = np.exp(me["tot"])
    share = 1 / (1 + np.exp(-me["spl"]))
    scale = 0.9 * np.exp(me["lnN2"])  # a deck's level is nuisance
    columns = [me["f"], me["M"], me["H"], me["SAT"], me["m"], me["FU"], me["lat"], me["trk"], me["vx"], me["GS"], me["roll"],
               me["acc"], 100 * me["cg"], seconds, flow * share, flow * (1 - share), 100 * scale, 100 * scale]
    with open(path, "w") as out:
        out.write("flight,mach,pressure_altitude_m,static_air_temperature_k,mass_kg,fuel_used_kg,latitude_deg,track_deg,"
                  "cross_wind_m_s,ground_speed_m_s,roll_deg,acceleration_m_s2,cg_percent_mac,date_s,"
                  "fuel_flow_1_kg_s,fuel_flow_2_kg_s,n2_1_percent,n2_2_percent\n")
        for row in zip(*columns):
            out.write(",".join(repr(float(v)) for v in row) + "\n")


ratios = []
for k, name in enumerate(["wave_drag", "drag_factor", "mach_bias", "tsfc_engine_1", "induced_drag"][:cases]):
    streams = [np.random.default_rng(s) for s in np.random.SeedSequence(40 + k).spawn(3)]
    flown = space["design"](streams[0], 60, 10, "mixed")
    truth = space["draw"](streams[1], [name], 1.0, "B0")
    me, _, _ = space["generate"](streams[2], flown, truth)
    me["extra"] = ""
    ours, search, whole = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "segments.csv")
        write(path, me)
        for _ in range(RUNS):
            start = time.perf_counter()
            result = space["diagnose"](me)
            search.append(time.perf_counter() - start)
            result["bg"].spk, result["bg"].tau = space["SPIKES"], space["TAUS"]
            space["refine"](me, result)
            try:
                space["outside"](me, result)
            except Exception as error:  # the prototype's own functions changed
                print("outside:", error)
            whole.append(time.perf_counter() - start)
            if not ours or len(ours) < 2:
                said = subprocess.run([binary, path], capture_output=True, text=True, check=True).stdout.split()
                ours.append(float(said[3]))
    ratios.append((min(search) / min(ours), min(whole) / min(ours)))
    print(f"{name:16} ours {min(ours):.4f} s (all), prototype search {min(search):.4f} s, all {min(whole):.4f} s: "
          f"{ratios[-1][0]:.1f} x, {ratios[-1][1]:.1f} x; ours says {said[-1]}")
print("median ratio: to its search alone %.1f, to search, refinement and agnostic functions %.1f"
      % tuple(np.median(np.array(ratios), axis=0)))
