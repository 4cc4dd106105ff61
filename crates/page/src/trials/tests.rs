use super::*;

#[test]
fn every_number_is_on_the_page() {
    let score = TrialScore {
        words: "The planted effect is on top".to_owned(),
        value: Some(0.8125),
        ci95: Some([0.57, 0.93]),
        of: Some(16),
    };
    let row = |found: &str, count| (found.to_owned(), count);
    let group = TrialGroup {
        name: "exact model <b>".to_owned(),
        cases: "16 single effects".to_owned(),
        scores: vec![score.clone()],
        confusion: [
            ("drag_factor".to_owned(), [row("drag_factor", 13), row("no_gap", 3)].into()),
            ("nothing".to_owned(), [row("no_gap", 7)].into()),
        ]
        .into(),
        calibration: vec![TrialCalibration {
            range: [0.9, 1.0],
            stated: 0.9612,
            right: 0.9231,
            ci95: [0.667, 0.986],
            of: 13,
        }],
        size_tenths: [1, 0, 2, 3, 1, 0, 1, 2, 3, 0],
    };
    let page = trials(&TrialsPage {
        plan: vec!["seed 17".to_owned()],
        seal_sha256: "abc".to_owned(),
        cases: 23,
        failed: vec![(4, "no <thrust>".to_owned())],
        goals: vec![TrialGoal {
            group: group.name.clone(),
            goal: "≥ 0.9".to_owned(),
            reached: score,
            met: Some(false),
        }],
        groups: vec![group],
    });
    for number in ["0.8125", "0.57", "0.93", "16", "0.9612", "0.9231", "0.667", "0.986", "13", "7"]
    {
        assert!(page.contains(&format!("data-v=\"{number}\"")), "{number}");
    }
    assert!(page.contains("seed 17") && page.contains("no &lt;thrust&gt;"));
    assert!(page.contains("0 of 1 goal met.") && page.contains("more cases would tell"), "{page}");
    assert!(!page.contains("<b>\"") && !page.contains("NaN"));
    let empty = trials(&TrialsPage::default());
    assert!(empty.contains("None of these cases has a goal") && !empty.contains("NaN"));
}
