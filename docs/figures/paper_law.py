"""The law of Ghazi et al. 2020 written a second time, from its equations and not from the program.

Initial model from a guide, equations (12) to (15); local adaptation, (25) to (28); global refit, (29).
It exists to check the program's golden files, and to ask "what if" where the program has no switch on purpose.
It does not read reports and finds no segments: their mean states come from a file that the program wrote.
Standard library only.
"""

import csv
import math

GRAVITY = 9.80665  # m/s2
GAS_CONSTANT = 287.05287  # J/(kg K)
SEA_LEVEL_TEMPERATURE = 288.15  # K
WING_AREA = 48.96  # m2, as in AIRCRAFT.ron
TSFC_STATIC = 0.3616 / (3600 * GRAVITY)  # kg/(N s), as in AIRCRAFT.ron
TSFC_MACH_EXPONENT = 1.25  # as in AIRCRAFT.ron
POUND = 0.45359237  # kg
FOOT = 0.3048  # m
KNOT = 1852 / 3600  # m/s


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def isa(altitude):
    """Temperature (K) and static pressure (Pa) at a pressure altitude (m), ISO 2533."""
    exponent = GRAVITY / (GAS_CONSTANT * 0.0065)
    temperature = SEA_LEVEL_TEMPERATURE - 0.0065 * min(altitude, 11000)
    pressure = 101325 * (temperature / SEA_LEVEL_TEMPERATURE) ** exponent
    if altitude > 11000:
        pressure *= math.exp(-GRAVITY * (altitude - 11000) / (GAS_CONSTANT * temperature))
    return temperature, pressure


def speed_of_sound(temperature):
    return math.sqrt(1.4 * GAS_CONSTANT * temperature)


def tsfc(mach, temperature):
    theta = temperature / SEA_LEVEL_TEMPERATURE
    return TSFC_STATIC * math.sqrt(theta) * (1 + mach) ** TSFC_MACH_EXPONENT


class Point:
    """A segment or a static point: where it is in the table, and the drag coefficient that its fuel flow stands for.

    `percent_per_cd` is what a unit of drag coefficient is worth in per cent of the recorded fuel flow: the error of a
    table is percent_per_cd * (observed - predicted drag coefficient), equations (22) to (24).
    """

    def __init__(self, name, mass, altitude, temperature, mach, speed, fuel_flow, acceleration):
        dynamic_pressure = 0.5 * isa(altitude)[1] / (GAS_CONSTANT * temperature) * speed**2
        force = dynamic_pressure * WING_AREA
        specific = tsfc(mach, temperature)
        self.name = name
        self.mach = mach
        self.lift_coefficient = mass * GRAVITY / force
        self.drag_coefficient = (fuel_flow / specific - mass * acceleration) / force
        self.percent_per_cd = 100 * force * specific / fuel_flow


def segments(path):
    """Flights in order, each a list of its segments in order of time."""
    flights = {}
    for row in rows_of(path):
        number = {name: float(row[name]) for name in row if name not in ("tail", "flight", "start", "rows") and row[name]}
        flights.setdefault(row["flight"], []).append(
            Point(
                row["flight"],
                number["mass_kg"],
                number["pressure_altitude_m"],
                number["static_air_temperature_k"],
                number["mach"],
                number["true_airspeed_m_s"],
                number["fuel_flow_kg_s"],
                number["acceleration_m_s2"],
            )
        )
    return [flights[name] for name in sorted(flights)]


def standard_day_points(path):
    """Rows of a guide or of the static points."""
    points = []
    for row in rows_of(path):
        altitude = float(row["pressure_altitude_ft"]) * FOOT
        temperature = isa(altitude)[0]
        if "mach" in row:
            mach = float(row["mach"])
            speed = mach * speed_of_sound(temperature)
        else:
            speed = float(row["true_airspeed_kt"]) * KNOT
            mach = speed / speed_of_sound(temperature)
        name = (float(row["weight_lb"]), float(row["pressure_altitude_ft"]))
        fuel_flow = float(row["fuel_flow_lb_h"]) * POUND / 3600
        points.append(Point(name, name[0] * POUND, altitude, temperature, mach, speed, fuel_flow, 0.0))
    return points


def basis(lift_coefficient, mach):
    """Equation (15)."""
    square = lift_coefficient**2
    return [1.0, mach, mach**2, square, mach * square, mach**2 * square]


def least_squares(rows, values, weights):
    """By QR: Gram and Schmidt, each column twice against those before it."""
    roots = [math.sqrt(weight) for weight in weights]
    columns = [[root * row[k] for root, row in zip(roots, rows)] for k in range(len(rows[0]))]
    right = [root * value for root, value in zip(roots, values)]
    orthogonal, triangle = [], [[0.0] * len(columns) for _ in columns]
    for k, column in enumerate(columns):
        for _ in range(2):
            for l, base in enumerate(orthogonal):
                share = math.fsum(a * b for a, b in zip(base, column))
                triangle[l][k] += share
                column = [a - share * b for a, b in zip(column, base)]
        triangle[k][k] = math.sqrt(math.fsum(a * a for a in column))
        orthogonal.append([a / triangle[k][k] for a in column])
    solution = [0.0] * len(columns)
    for k in reversed(range(len(columns))):
        known = sum(triangle[k][l] * solution[l] for l in range(k + 1, len(columns)))
        solution[k] = (math.fsum(a * b for a, b in zip(orthogonal[k], right)) - known) / triangle[k][k]
    return solution


def polynomial(coefficients, lift_coefficient, mach):
    return sum(p * b for p, b in zip(coefficients, basis(lift_coefficient, mach)))


def fit(points, weights=None):
    weights = weights or [1.0] * len(points)
    design = [basis(point.lift_coefficient, point.mach) for point in points]
    return least_squares(design, [point.drag_coefficient for point in points], weights)


def axis(first, last, step):
    return [round(first + step * k, 9) for k in range(round((last - first) / step) + 1)]


def cell_of(value, breakpoints):
    """The cell [x_i, x_i+1) that holds a value, and how far into it; a breakpoint within 1e-9 is meant."""
    for breakpoint in breakpoints:
        if abs(value - breakpoint) <= 1e-9:
            value = breakpoint
    index = max(i for i in range(len(breakpoints) - 1) if i == 0 or value >= breakpoints[i])
    assert breakpoints[0] <= value <= breakpoints[-1], "outside the table"
    return index, (value - breakpoints[index]) / (breakpoints[index + 1] - breakpoints[index])


class Table:
    def __init__(self, lift_coefficients, machs, coefficients):
        self.lift_coefficients, self.machs = lift_coefficients, machs
        self.nodes = [(i, j) for i in range(len(lift_coefficients)) for j in range(len(machs))]
        self.drag = {
            (i, j): polynomial(coefficients, lift_coefficients[i], machs[j]) for i, j in self.nodes
        }
        self.confidence = dict.fromkeys(self.nodes, 1.0)
        self.adapted = set()
        self.updates = 0
        self.refits = []

    def weights(self, point):
        i, u = cell_of(point.lift_coefficient, self.lift_coefficients)
        j, v = cell_of(point.mach, self.machs)
        return {
            (i, j): (1 - u) * (1 - v),
            (i + 1, j): u * (1 - v),
            (i, j + 1): (1 - u) * v,
            (i + 1, j + 1): u * v,
        }

    def error(self, point):
        """Equation (24), %."""
        predicted = sum(weight * self.drag[node] for node, weight in self.weights(point).items())
        return point.percent_per_cd * (point.drag_coefficient - predicted)

    def errors(self, points):
        return [self.error(point) for point in points]

    def adapt(self, point):
        """Equations (25) to (28)."""
        weights = self.weights(point)
        (i, j), (k, l) = min(weights), max(weights)
        diagonal = math.hypot(
            self.lift_coefficients[k] - self.lift_coefficients[i], self.machs[l] - self.machs[j]
        )
        for (i, j), weight in weights.items():
            if weight <= 1e-9:
                continue
            near = math.hypot(
                point.lift_coefficient - self.lift_coefficients[i], point.mach - self.machs[j]
            )
            delta, confidence = near / diagonal, self.confidence[i, j]
            if confidence == 1 or delta == 0:
                gain = 1.0
            else:
                gain = (1 - delta) / (1 - delta**confidence)
            self.drag[i, j] += gain * (point.drag_coefficient - self.drag[i, j])
            self.confidence[i, j] = confidence + 1 - delta
            self.adapted.add((i, j))
        self.updates += 1

    def refit(self, less=0, polynomial_too=True, reset=True):
        """Equation (29), with weights of the confidence less `less`."""
        design = [basis(self.lift_coefficients[i], self.machs[j]) for i, j in self.nodes]
        weights = [self.confidence[node] - less for node in self.nodes]
        coefficients = least_squares(design, [self.drag[node] for node in self.nodes], weights)
        for i, j in self.nodes:
            if polynomial_too and self.confidence[i, j] == 1:
                self.drag[i, j] = polynomial(coefficients, self.lift_coefficients[i], self.machs[j])
            if reset:
                self.confidence[i, j] = 1.0


def learn(table, flights, threshold, refits="published", **refit):
    """Adapts a table to flights. `refits`: "published", "none" or "last" (after the last flight, whatever the share)."""
    for number, flight in enumerate(flights, start=1):
        for point in flight:
            if abs(table.error(point)) > threshold:
                table.adapt(point)
        visited = sum(confidence > 1 for confidence in table.confidence.values())
        due = 10 * visited > 3 * len(table.nodes) if refits == "published" else number == len(flights)
        if refits != "none" and due:
            table.refit(**refit)
            table.refits.append(number)
    return table


def statistics(errors):
    """Mean, standard deviation (n - 1), largest absolute value."""
    mean = math.fsum(errors) / len(errors)
    variance = math.fsum((error - mean) ** 2 for error in errors) / (len(errors) - 1)
    return mean, math.sqrt(variance), max(abs(error) for error in errors)
