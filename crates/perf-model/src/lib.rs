//! Aircraft, drag, TSFC, fuel flow both ways, initial model from a flight-planning guide.
