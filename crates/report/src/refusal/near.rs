//! The name that a misspelt one is like.

/// The candidate nearest to a name: at most a third of its letters are inserted, left out, replaced or exchanged with the next,
/// upper and lower case aside; or it is cut off at its half or later.
#[must_use]
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let lower = name.to_lowercase();
    let distance = |candidate: &str| {
        let candidate = candidate.to_lowercase();
        // Half of a name and more is one slip: it was not written to its end.
        let cut_off = candidate.starts_with(&lower)
            && 2 * lower.len() >= candidate.len()
            && candidate != lower;
        if cut_off { 1 } else { strsim::osa_distance(&lower, &candidate) }
    };
    candidates
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|(distance, candidate)| 3 * distance <= candidate.len().max(name.len()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn what_is_near() {
        assert_eq!(nearest("kts", ["kt", "m/s"]), Some("kt"));
        assert_eq!(nearest("altitud_ft", ["time", "altitude_ft"]), Some("altitude_ft"));
        // Letters that changed places are one slip.
        assert_eq!(nearest("mahc", ["mass", "mach"]), Some("mach"));
        assert_eq!(nearest("x", ["altitude_ft"]), None);
        assert_eq!(nearest("acropol", ["traffic-a320", "acropole-a320"]), Some("acropole-a320"));
        assert_eq!(nearest("alt", ["altitude_ft"]), None);
    }
}
