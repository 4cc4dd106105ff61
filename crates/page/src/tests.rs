//! The page as a whole, of the flights in `fixtures` and of tails made up.

use std::collections::BTreeSet;

use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::segments_table;
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};

use crate::place::{Detail, Place};
use crate::{plot, report, samples, tail as section};

const MODEL: &str = include_str!("../../../fixtures/global5000/expected/SIM-01.ron");
const SEGMENTS: &[u8] = include_bytes!("../../../fixtures/global5000/expected/SIM-01_segments.csv");

/// What was learnt from the flights in `fixtures`, under some tail's name.
fn tail(name: &str, adapted: bool) -> TailResult {
    let model = ModelFile::from_text(MODEL).unwrap();
    let segments = segments_table::read(SEGMENTS).unwrap();
    let counts = TailCounts { flights: 12, flights_new: 12, samples: 900 };
    let notes = vec!["roll <not> recorded".to_owned()];
    let data = TailData { tail: name.to_owned(), model, segments, counts, notes, curve: None };
    if adapted {
        TailResult::adapted(data)
    } else {
        TailResult::as_given(data, pipeline::whole_model::Predicts::WholeModel)
    }
}

fn page(tails: &[TailResult], refused: Vec<RefusedSummary>) -> String {
    let reports = ReportsSummary { read: 12, refused, ..ReportsSummary::default() };
    let tails_summary = tails.iter().map(|tail| tail.summary.clone()).collect();
    report(&Summary { schema: SCHEMA, reports, tails: tails_summary }, tails, "A <run>")
}

/// Values of an attribute, in order.
fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let begin = format!(" {attribute}=\"");
    page.split(begin.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

fn check(page: &str) {
    for word in ["NaN", "inf\"", "inf ", "src=", "http:", "https:", "@import", "url("] {
        assert!(!page.contains(word), "{word}");
    }
    let ids = values(page, "id");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len(), "ids repeat");
    for link in values(page, "href") {
        assert!(unique.contains(link.trim_start_matches('#')), "{link}");
    }
    assert!(page.matches("<script").count() <= 1, "a name became a script");
    let drawings = page.matches("<svg").count() - page.matches("aria-hidden").count();
    assert_eq!(page.matches("role=\"img\"").count(), drawings);
    for label in values(page, "aria-labelledby").iter().flat_map(|labels| labels.split(' ')) {
        assert!(unique.contains(label), "{label}");
    }
    let header_cells = page.matches("<th").count() - page.matches("<thead").count();
    assert_eq!(page.matches(" scope=\"").count(), header_cells);
}

#[test]
fn a_page_of_real_flights() {
    let tails = [tail("SIM-01", true), tail("SIM-02", true)];
    let page = page(&tails, Vec::new());
    check(&page);
    assert!(page.starts_with("<!DOCTYPE html><html lang=\"en\">"));
    assert!(page.contains("href=\"#tail-SIM-01\"") && page.contains("id=\"tail-SIM-01\""));
    assert!(page.contains("law paper, threshold 1 %"));
    assert_eq!(page.matches("<details class=\"tail\"").count(), 2);
    assert_eq!(page.matches("<details class=\"tail\" open>").count(), 1);
    assert!(!page.contains("Refused reports"));
}

#[test]
fn same_results_same_bytes() {
    assert_eq!(page(&[tail("A", true)], Vec::new()), page(&[tail("A", true)], Vec::new()));
}

/// What the table and the verdict say is what the document says, in the table's digits.
#[test]
fn numbers_are_those_of_the_document() {
    let tail = tail("A", true);
    let page = page(std::slice::from_ref(&tail), Vec::new());
    let json: serde_json::Value = serde_json::from_slice(
        &Summary { schema: SCHEMA, reports: ReportsSummary::default(), tails: vec![tail.summary] }
            .to_json(),
    )
    .unwrap();
    let errors = &json["tails"][0]["fuel_flow_error_percent"];
    for when in ["before", "after"] {
        let mean = errors[when]["mean"].as_f64().unwrap();
        assert!(page.contains(&format!("data-v=\"{mean}\">{mean:+.2}</td>")), "{when} {mean}");
        let std = errors[when]["std"].as_f64().unwrap();
        assert!(page.contains(&format!("data-v=\"{std}\">{std:.2}</td>")), "{when} {std}");
    }
    assert!(page.contains(&format!("{} flights", json["tails"][0]["flights"])));
    // A fuel factor f is a share of the prediction; of what was recorded it is f/(100 + f).
    let of_predicted = json["tails"][0]["fuel_factor_percent"]["value"].as_f64().unwrap();
    let error = 100.0 * of_predicted / (100.0 + of_predicted);
    let before = errors["before"]["mean"].as_f64().unwrap();
    assert!(page.contains(&format!("its own mean error is {before:+.2} %, “before”")), "{before}");
    assert!((of_predicted - error).abs() > 0.01, "the two differ: {error}");
    assert!(
        page.contains(&format!("It burns {of_predicted:.2} % more than its guide says")),
        "{of_predicted}"
    );
    assert!(page.contains(&format!("in % of recorded fuel flow: {error:+.2}")), "{error}");
}

#[test]
fn a_plot_is_one_drawing() {
    let svg = plot(&tail("<T>&", true), &[]).unwrap();
    assert_eq!(svg.matches("<svg").count(), 1);
    assert!(svg.contains("<title>&lt;T&gt;&amp;</title>") && !svg.contains("<T>"));
    assert!(svg.contains("drag polar at Mach") && svg.contains("error over time"));
    assert!(!svg.contains("NaN"));
    assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
    let one = plot(&tail("T", true), &["histogram"]).unwrap();
    // A figure on a slide tells its colours: the lines of the legend stand under the chart.
    assert!(one.contains("<text x=\"34\" y=\"10\">") && !one.contains("<li>"));
    let one = plot(&tail("T", true), &["surface"]).unwrap();
    assert!(one.contains("change of the drag surface") && !one.contains("drag polar"));
}

#[test]
fn a_model_as_given_has_no_after() {
    let page = page(&[tail("A", false)], Vec::new());
    check(&page);
    assert!(!page.contains("error after") && !page.contains("final table"));
}

#[test]
fn nothing_sent_is_markup() {
    let refused = RefusedSummary {
        path: "x/<b>.txt".to_owned(),
        line: Some(3),
        column: Some(1),
        reason: "found \"<i>\", expected TIME".to_owned(),
    };
    let page = page(&[tail("<T>&\"", true), tail("-T---", true)], vec![refused]);
    check(&page);
    assert!(page.contains("x/&lt;b&gt;.txt:3:1") && page.contains("found &quot;&lt;i&gt;"));
    assert!(page.contains("roll &lt;not&gt; recorded"));
    for raw in ["<T>", "<b>.txt", "<i>", "A <run>", "<not>"] {
        assert!(!page.contains(raw), "{raw}");
    }
}

#[test]
fn odd_tails_are_drawn_too() {
    for (k, view) in samples::views().iter().enumerate() {
        let place =
            Place { tail: "T", id: format!("t{k}"), most_points: 100, detail: Detail::Full };
        let figures = section::figures(view, &place).into_string();
        check(&figures);
        let thinned = view.points.len() > 100;
        assert_eq!(figures.contains("evenly chosen"), thinned, "what is left out is reported");
    }
}

#[test]
fn a_large_fleet_stays_readable() {
    let one = tail("T", true);
    let tails: Vec<TailResult> = (0..200)
        .map(|k| {
            let mut tail = one.clone();
            tail.tail = format!("T-{k:03}");
            tail.summary.tail.clone_from(&tail.tail);
            tail
        })
        .collect();
    let page = page(&tails, Vec::new());
    assert_eq!(page.matches("<details class=\"tail\"").count(), 200);
    for tail in &tails {
        assert!(page.contains(&format!(">{}</a>", tail.tail)), "{}", tail.tail);
    }
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
}
