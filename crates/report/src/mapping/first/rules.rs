//! What columns are called, and of what kind their numbers are.

/// A quantity that is one column in one unit.
pub(super) struct Rule {
    pub(super) quantity: &'static str,
    pub(super) names: &'static [&'static str],
    pub(super) kind: Kind,
}

#[derive(Clone, Copy)]
pub(super) enum Kind {
    Altitude,
    Temperature,
    Mach,
    Speed,
    CalibratedSpeed,
    Angle,
    Mass,
    Percent,
    Discrete,
}

const fn rule(quantity: &'static str, names: &'static [&'static str], kind: Kind) -> Rule {
    Rule { quantity, names, kind }
}

/// The heading, of which the drift angle is the track less this.
pub(super) const HEADING: Rule = rule(
    "HDG",
    &["headingtrue", "trueheading", "hdgtrue", "truehdg", "heading", "hdg"],
    Kind::Angle,
);

pub(super) const ORDINARY: [Rule; 13] = [
    rule(
        "ALT",
        &[
            "pressurealtitude",
            "pressurealt",
            "pressalt",
            "palt",
            "altp",
            "altitudestd",
            "altstd",
            "altistd",
            "altitudepressure",
            "baroaltitude",
            "baroalt",
            "altb",
            "altitude",
            "alt",
            "flightlevel",
            "fl",
        ],
        Kind::Altitude,
    ),
    rule(
        "SAT",
        &[
            "staticairtemperature",
            "staticairtemp",
            "sat",
            "outsideairtemperature",
            "outsideairtemp",
            "oat",
            "airtemperature",
            "airtemp",
            "temperature",
        ],
        Kind::Temperature,
    ),
    rule("TAT", &["totalairtemperature", "totalairtemp", "tat"], Kind::Temperature),
    rule("MACH", &["machnumber", "mach", "machno", "mn", "m"], Kind::Mach),
    rule(
        "VTAS",
        &["trueairspeed", "trueairspd", "tas", "ktas", "vtas", "airspeedtrue"],
        Kind::Speed,
    ),
    rule("GSPD", &["groundspeed", "groundspd", "grndspd", "gndspd", "gspd", "gs"], Kind::Speed),
    rule("ROLL", &["rollangle", "roll", "bank", "bankangle"], Kind::Angle),
    rule("DRIFT", &["driftangle", "drift"], Kind::Angle),
    HEADING,
    rule("LAT", &["latitude", "lat"], Kind::Angle),
    rule("LON", &["longitude", "lon", "long"], Kind::Angle),
    rule("CG", &["centreofgravity", "centerofgravity", "cg", "cgpercentmac"], Kind::Percent),
    rule("A/I", &["antiice", "wingantiice", "engantiice", "ai"], Kind::Discrete),
];
pub(super) const CALIBRATED: Rule = rule(
    "",
    &["calibratedairspeed", "computedairspeed", "cas", "kcas", INDICATED, "kias"],
    Kind::CalibratedSpeed,
);
/// Not corrected for the error of its pressures' position.
pub(super) const INDICATED: &str = "ias";
pub(super) const TRACK: Rule = rule(
    "",
    &["trackangletrue", "tracktrue", "truetrack", "truetrk", "trktrue", "track", "trk"],
    Kind::Angle,
);
pub(super) const GROSS: Rule = rule(
    "",
    &[
        "grossweight",
        "grossweightsmoothed",
        "gw",
        "weight",
        "wt",
        "mass",
        "grossmass",
        "aircraftmass",
        "grosswt",
        "gwt",
        "wgt",
        "acgw",
        "acweight",
        "acwt",
        "acmass",
        "acgrossweight",
        "acgrosswt",
        "aircraftweight",
        "aircraftgrossweight",
    ],
    Kind::Mass,
);
/// That of the take-off, or what is left of it.
pub(super) const TAKE_OFF: Rule = rule(
    "",
    &["togw", "takeoffgrossweight", "takeoffweight", "takeoffmass", "tow", "rampweight"],
    Kind::Mass,
);
pub(super) const ZERO_FUEL: Rule = rule("", &["zerofuelweight", "zfw"], Kind::Mass);
pub(super) const COMPUTED_FUEL: Rule = rule("", &["fob", "fuelonboard", "totalfuel"], Kind::Mass);
/// Names that gauges have and a computed fuel on board has not: that is often the first quantity less what meters count, and would
/// bear out every meter.
pub(super) const GAUGES: Rule = rule(
    "FQ",
    &["fuelquantity", "fuelqty", "fq", "totalfuelquantity", "totalfuelqty", "fuelqtytotal"],
    Kind::Mass,
);
/// Gauges of the left, the right and the centre tanks.
pub(super) const TANKS: [Rule; 3] = [
    rule("", &["fqtyl", "fuelqtyl", "fuelqtyleft", "fuelquantityleft", "fql"], Kind::Mass),
    rule("", &["fqtyr", "fuelqtyr", "fuelqtyright", "fuelquantityright", "fqr"], Kind::Mass),
    rule(
        "",
        &[
            "fqtyc",
            "fuelqtyc",
            "fuelqtycenter",
            "fuelqtycentre",
            "fuelquantitycenter",
            "fuelquantitycentre",
            "fqc",
        ],
        Kind::Mass,
    ),
];
pub(super) const USED: Rule = rule("", &["fuelused", "fu", "fuelburn", "fuelburnt"], Kind::Mass);
pub(super) const ENGINE_NAMES: [(&str, &[&str]); 4] = [
    ("N1", &["n1"]),
    ("N2", &["n2"]),
    ("WF", &["fuelflow", "fflow", "ff", "wf", "ffuel"]),
    ("EGT", &["egt", "itt", "exhaustgastemperature"]),
];

/// The flow of all engines; a single engine's may stand beside it.
pub(super) const TOTAL_FLOW: [&str; 6] =
    ["fftotal", "totalff", "fuelflowtotal", "totalfuelflow", "wftotal", "totalwf"];

const NO_TYPE_YET: &str = "Text(\"TYPE\"),   // ?";

/// Texts of the header: key, names of columns, what there is without one.
pub(super) const TEXTS: [(&str, &[&str], &str); 3] = [
    (
        "aircraft",
        &["aircrafttype", "actype", "type", "typecode", "flplairctype", "aircraft", "ac"],
        NO_TYPE_YET,
    ),
    (
        "tail",
        &[
            "tail",
            "registration",
            "reg",
            "acident",
            "tailnumber",
            "tailno",
            "acreg",
            "acregistration",
            "aircraftregistration",
        ],
        "Text(\"TAIL\"),   // ?",
    ),
    (
        "flight",
        &[
            "flight",
            "flightnumber",
            "flightno",
            "flightid",
            "fltid",
            "fltnum",
            "flightnum",
            "flt",
            "fltno",
            "callsign",
            "systtrajid",
        ],
        "FileName,   // ? one flight; several in a file: Column(\"NAME\"), or new_flight_after_s",
    ),
];
