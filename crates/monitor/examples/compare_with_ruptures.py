"""Our change points against those of ruptures (PyPI) on the same series.

    cargo run --release -p cruisefit-monitor --example planted_changes -- SEED CASES --series > series.csv
    python3 compare_with_ruptures.py series.csv

ruptures needs a penalty. Two are shown for PELT on the mean (KernelCPD with the linear kernel: cost "l2" in C): BIC's 2 s² ln n with the noise
estimated from differences of neighbours as ours is, and three times that. A step counts as found within 3 flights; a change
farther than 30 flights from every step is false.
"""

import csv
import math
import sys

import numpy
import ruptures

NEAR, FAR = 3, 30


def noise(y):
    return float(numpy.median(numpy.abs(numpy.diff(y)))) / 0.67449 / math.sqrt(2)


def pelt(y, factor):
    penalty = factor * 2 * noise(y) ** 2 * math.log(len(y))
    return ruptures.KernelCPD(kernel="linear", min_size=2).fit(y).predict(pen=penalty)[:-1]


def numbers(text, kind=int):
    return [kind(word) for word in text.split()]


def main(path):
    csv.field_size_limit(1 << 24)
    scores = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            y = numpy.array(numbers(row["deviations_percent"], float))
            steps = numbers(row["steps"])
            for name, found in (
                ("ours", numbers(row["found"])),
                ("PELT, BIC", pelt(y, 1)),
                ("PELT, 3 BIC", pelt(y, 3)),
            ):
                score = scores.setdefault((row["kind"], row["noise_percent"], name), [0, 0, 0, 0])
                score[0] += len(y)
                score[1] += len(steps)
                score[2] += sum(any(abs(s - f) <= NEAR for f in found) for s in steps)
                score[3] += sum(all(abs(s - f) > FAR for s in steps) for f in found)
    print(f"{'planted':26} noise  method       found within {NEAR}  false per 300")
    for (kind, spread, name), (flights, planted, hit, wrong) in scores.items():
        share = f"{hit / planted:.3f}" if planted else "-"
        print(f"{kind:26} {spread:>5}  {name:11}  {share:>14}  {300 * wrong / flights:13.3f}")


if __name__ == "__main__":
    main(sys.argv[1])
