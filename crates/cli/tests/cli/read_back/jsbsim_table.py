"""JSBSim with an exported drag function: DRAG.xml, the table as CSV, a folder to work in. Relative errors of CD at nodes."""
import csv
import os
import sys
import xml.etree.ElementTree as xml

import jsbsim

drag, table, work = sys.argv[1:4]
aerodynamics = xml.parse(drag).getroot()
# The test sets the lift coefficient: JSBSim's own property follows from the lift.
lift = xml.fromstring(
    '<axis name="LIFT"><function name="aero/force/lift-test"><product><property>aero/qbar-psf</property>'
    "<property>metrics/Sw-sqft</property><property>test/lift-coefficient</property></product></function></axis>"
)
aerodynamics.insert(0, lift)
aircraft = xml.fromstring(
    '<fdm_config name="cf" version="2.0" release="ALPHA"><fileheader/>'
    '<metrics><wingarea unit="M2">94.94690688</wingarea><wingspan unit="M">28</wingspan><chord unit="M">4</chord>'
    '<location name="AERORP" unit="M"><x>0</x><y>0</y><z>0</z></location></metrics>'
    '<mass_balance><ixx unit="KG*M2">1e6</ixx><iyy unit="KG*M2">1e6</iyy><izz unit="KG*M2">1e6</izz>'
    '<emptywt unit="KG">30000</emptywt><location name="CG" unit="M"><x>0</x><y>0</y><z>0</z></location></mass_balance>'
    '<ground_reactions/><flight_control name="none"><property value="0.4">test/lift-coefficient</property></flight_control>'
    "</fdm_config>"
)
aircraft.append(aerodynamics)
folder = os.path.join(work, "aircraft", "cf")
os.makedirs(folder, exist_ok=True)
xml.ElementTree(aircraft).write(os.path.join(folder, "cf.xml"))

fdm = jsbsim.FGFDMExec(work)
fdm.set_debug_level(0)
fdm.set_aircraft_path("aircraft")
assert fdm.load_model("cf"), "JSBSim does not load the aircraft"
fdm["ic/h-sl-ft"] = 39000.0
for row in list(csv.DictReader(open(table, encoding="utf-8")))[::7]:
    fdm["ic/mach"] = float(row["mach"])
    fdm["test/lift-coefficient"] = float(row["lift_coefficient"])
    fdm.run_ic()
    # The function of drag takes the lift coefficient of the frame before.
    fdm.run_ic()
    area = fdm["aero/qbar-psf"] * fdm["metrics/Sw-sqft"]
    mach, lift = fdm["velocities/mach"], fdm["aero/cl-squared"] ** 0.5
    if abs(mach - float(row["mach"])) < 1e-9 and abs(lift - float(row["lift_coefficient"])) < 1e-9:
        print("value", fdm["aero/force/drag-cruisefit"] / area / float(row["drag_coefficient"]) - 1)
    else:
        print("not at the node:", mach, row["mach"], lift, row["lift_coefficient"], file=sys.stderr)
