"""Writes oracle.csv: cruise fuel flow of the Poll-Schumann model by pycontrails, the reference of ../poll_schumann.rs.

    pip install pycontrails==0.63.5
    python make_oracle.py > oracle.csv

pycontrails takes 287.05 J/(kg K) as the gas constant of air; here it is the standard atmosphere's, so that equations are
compared and not constants. Temperature and pressure are those of the standard atmosphere, written with the row.
"""

import math

import numpy as np
from pycontrails.models.ps_model import ps_aircraft_params, ps_model
from pycontrails.physics import constants

constants.R_d = 287.05287
LOWER_HEATING_VALUE_J_KG = 43.13e6


def standard(altitude_m):
    if altitude_m <= 11000.0:
        temperature = 288.15 - 0.0065 * altitude_m
        exponent = 9.80665 / (287.05287 * 0.0065)
        return temperature, 101325.0 * (temperature / 288.15) ** exponent
    _, tropopause = standard(11000.0)
    return 216.65, tropopause * math.exp(-9.80665 * (altitude_m - 11000.0) / (287.05287 * 216.65))


print("type_code,mass_kg,pressure_altitude_ft,mach,isa_deviation_k,"
      "lift_coefficient,drag_coefficient,efficiency,fuel_flow_kg_s")
parameters = ps_aircraft_params.load_aircraft_engine_params()
for code in sorted(parameters):
    p = parameters[code]
    for share, altitude_ft, less, deviation in [
        (0.55, 33000.0, 0.03, 0.0),
        (0.75, 37000.0, 0.0, 10.0),
        (0.90, 29000.0, -0.02, -12.0),
        (0.60, 21000.0, 0.25, 5.0),
    ]:
        mass = p.amass_oew + share * (p.amass_mtow - p.amass_oew)
        mach = np.array([p.m_des - less])
        standard_k, pressure = standard(altitude_ft * 0.3048)
        temperature = np.array([standard_k + deviation])
        pressure = np.array([pressure])
        reynolds = ps_model.reynolds_number(p.wing_surface_area, mach, temperature, pressure)
        lift = ps_model.lift_coefficient(p.wing_surface_area, mass, pressure, mach, 0.0)
        friction = ps_model.skin_friction_coefficient(reynolds)
        zero = ps_model.zero_lift_drag_coefficient(friction, p.psi_0)
        oswald = ps_model.oswald_efficiency_factor(zero, p)
        wave = ps_model.wave_drag_coefficient(mach, lift, p)
        drag = ps_model.airframe_drag_coefficient(zero, wave, lift, oswald, p.wing_aspect_ratio)
        thrust = ps_model.thrust_force(mass, lift, drag, 0.0, 0.0)
        thrust_coefficient = ps_model.engine_thrust_coefficient(thrust, mach, pressure, p.wing_surface_area)
        best = ps_model.thrust_coefficient_at_max_efficiency(mach, p.m_des, p.c_t_des)
        efficiency = ps_model.overall_propulsion_efficiency(mach, thrust_coefficient, best, p, 0.0)
        flow = ps_model.fuel_mass_flow_rate(pressure, temperature, mach, thrust_coefficient, efficiency,
                                            p.wing_surface_area, LOWER_HEATING_VALUE_J_KG)
        values = [mass, altitude_ft, float(mach[0]), deviation, float(lift[0]), float(drag[0]),
                  float(efficiency[0]), float(flow[0])]
        print(code + "," + ",".join(repr(float(value)) for value in values))
