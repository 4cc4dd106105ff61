//! Reports that contradict what a folder holds: other versions of a flight, pieces of one, other types, another book.

use std::path::{Path, PathBuf};

use crate::support::{Ran, adapt, bytes_below, cruisefit, fixture, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

/// A report whose text is changed.
fn changed(folder: &Path, flight: u32, name: &str, change: impl Fn(String) -> String) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, change(std::fs::read_to_string(report(flight)).unwrap())).unwrap();
    path
}

/// The two hours of flight 2 as flights `2A` and `2B`, each with a START of its own.
fn halves(folder: &Path) -> [PathBuf; 2] {
    const HEADER: usize = 10;
    let half = |text: String, which: usize| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let rows = lines.split_off(HEADER);
        let rows = rows.iter().filter_map(|row| {
            let (time, rest) = row.trim_start().split_once(' ')?;
            let time: i32 = time.parse().ok()?;
            let since = 3600 * i32::try_from(which).ok()?;
            (0..3600).contains(&(time - since)).then(|| format!("{} {rest}", time - since))
        });
        lines.extend(rows);
        let name = ["FLIGHT 2A", "FLIGHT 2B"][which];
        let text = lines.join("\n").replace("FLIGHT   0002", name) + "\n";
        text.replace("T10:26:00Z", ["T10:26:00Z", "T11:26:00Z"][which])
    };
    [0, 1].map(|which| changed(folder, 2, &format!("half{which}.txt"), |text| half(text, which)))
}

fn same_tail(one: &Path, other: &Path) {
    for name in ["models/SIM-01.ron", "segments/SIM-01.csv", "flights/SIM-01.csv"] {
        let (one, other) = (std::fs::read(one.join(name)), std::fs::read(other.join(name)));
        assert_eq!(one.unwrap(), other.unwrap(), "{name}");
    }
}

/// A flight whose two halves were learnt is learnt in place of both, and they in its place: never together.
#[test]
fn a_whole_flight_takes_the_place_of_its_halves_and_they_of_it() {
    for law in ["bayes", "paper"] {
        let scratch = tempfile::tempdir().unwrap();
        let model = initial_model(scratch.path());
        let [first, second] = halves(scratch.path());
        let learn = |name: &str, batches: &[&[&PathBuf]]| {
            let folder = scratch.path().join(name);
            for batch in batches {
                let batch: Vec<PathBuf> = batch.iter().map(|path| (*path).clone()).collect();
                adapt(&model, &folder, &batch, &["--law", law, "--relearn"]).expect(0);
            }
            folder
        };
        let (one, two, three) = (report(1), report(2), report(3));
        let in_halves = learn("halves", &[&[&one, &first, &second, &three]]);
        let whole = learn("whole", &[&[&one, &two, &three]]);
        same_tail(&learn("mended", &[&[&one, &first, &second, &three], &[&two]]), &whole);
        same_tail(&learn("cut", &[&[&one, &two, &three], &[&first, &second]]), &in_halves);
    }
}

/// Of two versions in one folder of reports nobody knows which is right: one that was learnt stays, night after night.
#[test]
fn a_version_is_not_relearnt_beside_the_one_that_was_learnt() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let lighter = |text: String| text.replace("ZFW      53700", "ZFW      53500");
    let corrected = changed(scratch.path(), 2, "corrected.txt", lighter);
    adapt(&model, &output, &[report(1), report(2)], &[]).expect(0);
    let learnt = bytes_below(&output);
    let both = [report(2), corrected.clone()];
    adapt(&model, &output, &both, &["--relearn"])
        .expect(1)
        .says("whose report is among these as it was learnt: leave one of the two out");
    assert_eq!(bytes_below(&output)["segments/SIM-01.csv"], learnt["segments/SIM-01.csv"]);
    adapt(&model, &output, &[corrected], &["--relearn"]).expect(0);
    assert_ne!(bytes_below(&output)["segments/SIM-01.csv"], learnt["segments/SIM-01.csv"]);
}

/// What a tail is known to be off its book is no slip of the next night; what it has never been is one.
#[test]
fn a_tail_is_judged_by_what_it_is_known_to_burn() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (output, ordinary) = (scratch.path().join("out"), scratch.path().join("ordinary"));
    let other_unit = |flight: u32| {
        let in_kg = |text: String| text.replace("lb/h lb/h lb", "kg/h kg/h lb");
        changed(scratch.path(), flight, &format!("{flight}.txt"), in_kg)
    };
    let refused = "off the book on average";
    adapt(&model, &output, &[other_unit(1)], &[]).expect(2).says(refused);
    adapt(&model, &output, &[other_unit(1)], &["--accept"]).expect(0);
    adapt(&model, &output, &[other_unit(2)], &[]).expect(0);
    adapt(&model, &ordinary, &[report(1)], &[]).expect(0);
    adapt(&model, &ordinary, &[other_unit(2)], &[]).expect(2).says(refused);
}

/// A model of the fixture's aircraft under another type's name.
fn model_of_type(folder: &Path, type_code: &str, guide: &Path) -> PathBuf {
    let (aircraft, model) = (folder.join("OTHER.ron"), folder.join("OTHER_MODEL.ron"));
    let text = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    std::fs::write(&aircraft, text.replace("\"global5000\"", &format!("{type_code:?}"))).unwrap();
    let words = ["init".as_ref(), "--aircraft".as_ref(), aircraft.as_os_str()];
    let more = ["--guide".as_ref(), guide.as_os_str(), "-o".as_ref(), model.as_os_str()];
    cruisefit(&[&words[..], &more[..], &["--accept".as_ref()]].concat()).expect(0);
    model
}

/// One report in which the type is mistyped costs itself, whether it is the tail's first or last; it is not learnt into the
/// model of the tail's own type.
#[test]
fn a_report_of_another_type_costs_itself() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let other = model_of_type(scratch.path(), "A320", &fixture("guide.csv"));
    let mistyped = |flight: u32| {
        let name = format!("mistyped{flight}.txt");
        changed(scratch.path(), flight, &name, |text| {
            text.replace("AIRCRAFT global5000", "AIRCRAFT A320")
        })
    };
    let more = ["--model", other.to_str().unwrap()];
    let said = "found aircraft type \"A320\", expected \"global5000\", the type of tail SIM-01";
    let right = scratch.path().join("right");
    adapt(&model, &right, &[report(2), report(3)], &[]).expect(0);
    for stray in [1, 4] {
        let output = scratch.path().join(format!("out{stray}"));
        let batch = [mistyped(stray), report(2), report(3)];
        adapt(&model, &output, &batch, &more).expect(1).says(said);
        same_tail(&output, &right);
        // What the folder holds decides, not how many reports of a night are right.
        adapt(&model, &output, &[mistyped(5), mistyped(6), report(4)], &more).expect(1).says(said);
    }
    let evaluated = |batch: &[PathBuf]| -> Ran {
        let mut words: Vec<std::ffi::OsString> = vec!["evaluate".into()];
        words.extend(batch.iter().map(|path| path.clone().into_os_string()));
        for path in [&model, &other] {
            words.extend(["--model".into(), path.clone().into_os_string()]);
        }
        cruisefit(&words)
    };
    evaluated(&[mistyped(1), report(2), report(3)]).expect(1).says(said);
}

/// A tail that was begun with a book that has been revised since is refused; the others of the night are learnt.
#[test]
fn a_tail_of_another_book_does_not_end_the_night() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let other = model_of_type(scratch.path(), "A320", &fixture("guide.csv"));
    let of_other_tail = |flight: u32| {
        changed(scratch.path(), flight, &format!("other{flight}.txt"), |text| {
            text.replace("AIRCRAFT global5000", "AIRCRAFT A320").replace("SIM-01", "SIM-02")
        })
    };
    let more = ["--model", other.to_str().unwrap()];
    adapt(&model, &output, &[report(1), of_other_tail(1)], &more).expect(0);
    let revised = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let shorter: Vec<&str> = revised.lines().take(revised.lines().count() - 1).collect();
    let guide = scratch.path().join("revised.csv");
    std::fs::write(&guide, shorter.join("\n") + "\n").unwrap();
    let aircraft = scratch.path().join("OTHER.ron");
    let words = ["init".as_ref(), "--aircraft".as_ref(), aircraft.as_os_str(), "--guide".as_ref()];
    let to = ["-o".as_ref(), other.as_os_str(), "--force".as_ref()];
    cruisefit(&[&words[..], &[guide.as_os_str()], &to[..]].concat()).expect(0);
    adapt(&model, &output, &[report(2), of_other_tail(2)], &more)
        .expect(1)
        .says("tail SIM-02 was begun with another");
    let flights = std::fs::read_to_string(output.join("flights/SIM-01.csv")).unwrap();
    assert_eq!(flights.lines().count(), 3);
    // Where nothing is begun alike, it is the run that asks for something else, and changes nothing.
    adapt(&model, &output, &[of_other_tail(2)], &more).expect(2).says("(tail SIM-02)");
}

/// What a tail has learnt beyond its table is not dropped by an option of one night.
#[test]
fn a_tail_keeps_what_it_has_learnt_beyond_its_table() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let six: Vec<PathBuf> = (1..=6).map(report).collect();
    adapt(&model, &output, &six, &[]).expect(0);
    let before = bytes_below(&output);
    adapt(&model, &output, &[report(7)], &["--no-remainder"])
        .expect(2)
        .says("more than the table was learnt, which --no-remainder would drop");
    assert_eq!(bytes_below(&output), before);
}

/// A tail whose files are damaged costs itself: the others are monitored and evaluated, and it is learnt anew once all of its
/// reports are at hand, to the bytes that it had.
#[test]
fn a_damaged_tail_costs_itself_until_it_is_learnt_anew() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let of_other_tail = |flight: u32| {
        changed(scratch.path(), flight, &format!("other{flight}.txt"), |text| {
            text.replace("SIM-01", "SIM-02")
        })
    };
    let all = [report(1), report(2), of_other_tail(1), of_other_tail(2)];
    adapt(&model, &output, &all, &[]).expect(0);
    let whole = bytes_below(&output);
    for file in ["models/SIM-02.ron", "segments/SIM-02.csv", "deviations/SIM-02.csv"] {
        let mut bytes = whole[file].clone();
        bytes.extend(b"x");
        std::fs::write(output.join(file), bytes).unwrap();
    }
    let folder = output.to_str().unwrap();
    let monitored = cruisefit(&["monitor", folder]).expect(1);
    monitored.says("tail SIM-02 is not monitored").prints("SIM-01");
    let batch = [report(3), of_other_tail(3)].map(|path| path.to_str().unwrap().to_owned());
    cruisefit(&["evaluate", &batch[0], &batch[1], "--model", folder])
        .expect(1)
        .says("tail SIM-02 has no model")
        .prints("SIM-01");
    // Not from a part of its flights: the rest would be lost.
    adapt(&model, &output, &[of_other_tail(1)], &["--relearn"]).expect(2).says("is not touched");
    adapt(&model, &output, &all, &["--relearn"]).expect(0).says("SIM-02 is learnt anew");
    let mended = bytes_below(&output);
    for file in ["models/SIM-02.ron", "segments/SIM-02.csv", "deviations/SIM-02.csv"] {
        assert_eq!(mended[file], whole[file], "{file}");
    }
    cruisefit(&["monitor", folder]).expect(0);
}

/// Learning a damaged tail anew loses nothing: not a flight whose report is not at hand or cannot be used, not the law, and not
/// what an option of one night would drop.
#[test]
fn a_damaged_tail_is_learnt_anew_only_as_it_was() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    adapt(&model, &output, &[report(1), report(2), report(3)], &[]).expect(0);
    let path = output.join("models/SIM-01.ron");
    let sound = std::fs::read(&path).unwrap();
    std::fs::write(&path, [&sound[..], b"x"].concat()).unwrap();
    let before = bytes_below(&output);
    let relearn = |batch: &[PathBuf], more: &[&str]| {
        adapt(&model, &output, batch, &[&["--relearn"], more].concat())
    };
    let lost = "flight 0001 of 2019-03-14T10:45:00Z, which it has learnt, would be lost";
    relearn(&[report(2), report(3), report(4)], &[]).expect(2).says(lost);
    let cut = changed(scratch.path(), 1, "cut.txt", |text| text[..text.len() / 20].to_owned());
    relearn(&[cut, report(2), report(3)], &[]).expect(2).says("is not touched");
    let all = [report(1), report(2), report(3)];
    relearn(&all, &["--law", "paper"]).expect(2).says("was changed or damaged");
    relearn(&all, &["--criteria", "airbus-report-02-short"]).expect(2);
    assert_eq!(bytes_below(&output), before);
    relearn(&all, &[]).expect(0).says("is learnt anew");
    assert_eq!(std::fs::read(&path).unwrap(), sound);
}

/// What is refused for a setting, or cannot be read, is not damaged: nothing is learnt in its place.
#[test]
fn a_sound_tail_is_not_learnt_anew() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let six: Vec<PathBuf> = (1..=6).map(report).collect();
    adapt(&model, &output, &six, &[]).expect(0);
    let before = bytes_below(&output);
    let others: Vec<PathBuf> = (7..=12).map(report).collect();
    for batch in [&six, &others] {
        adapt(&model, &output, batch, &["--relearn", "--no-remainder"])
            .expect(2)
            .says("which --no-remainder would drop");
        assert_eq!(bytes_below(&output), before);
    }
    // In place of a file that the user may not read, for the tests may run as root: a folder cannot be read either.
    let segments = output.join("segments/SIM-01.csv");
    let kept = std::fs::read(&segments).unwrap();
    std::fs::remove_file(&segments).unwrap();
    std::fs::create_dir(&segments).unwrap();
    adapt(&model, &output, &others, &["--relearn"]).expect(2).says("is not touched");
    std::fs::remove_dir(&segments).unwrap();
    std::fs::write(&segments, kept).unwrap();
    assert_eq!(bytes_below(&output), before);
}

/// A folder behind a link is started over where it lies: the link leads to the new one.
#[cfg(unix)]
#[test]
fn a_folder_behind_a_link_is_started_over_where_it_lies() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (real, link) = (scratch.path().join("real"), scratch.path().join("link"));
    adapt(&model, &real, &[report(1)], &[]).expect(0);
    std::os::unix::fs::symlink(&real, &link).unwrap();
    adapt(&model, &link, &[report(2), report(3)], &["--restart"]).expect(0);
    assert!(link.is_symlink() && scratch.path().join("real.1/STATE.ron").exists());
    let flights = std::fs::read_to_string(real.join("flights/SIM-01.csv")).unwrap();
    assert_eq!(flights.lines().count(), 3);
}

/// The flights of a tail are held against the book of their own type: with a mistyped report first they were held against that of
/// another, by which they burn half.
#[test]
fn a_mistyped_first_report_does_not_choose_the_book_of_its_tail() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let twice = |(place, line): (usize, &str)| match line.rsplit_once(',') {
        Some((rest, flow)) if place > 0 => {
            format!("{rest},{}\n", 2.0 * flow.parse::<f64>().unwrap())
        }
        _ => format!("{line}\n"),
    };
    let text = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let guide = scratch.path().join("thirsty.csv");
    std::fs::write(&guide, text.lines().enumerate().map(twice).collect::<String>()).unwrap();
    let other = model_of_type(scratch.path(), "A320", &guide);
    let stray = changed(scratch.path(), 1, "mistyped.txt", |text| {
        text.replace("AIRCRAFT global5000", "AIRCRAFT A320")
    });
    let ran = |command: &str| {
        let mut words: Vec<std::ffi::OsString> = vec![command.into()];
        words.extend([&stray, &report(2), &report(3)].map(|path| path.clone().into_os_string()));
        for path in [&model, &other] {
            words.extend(["--model".into(), path.clone().into_os_string()]);
        }
        if command == "diagnose" {
            words.extend(["-o".into(), scratch.path().join("diagnosed").into_os_string()]);
        }
        cruisefit(&words)
    };
    let diagnosed = ran("diagnose").expect(1);
    assert!(diagnosed.stdout.contains("2 reports read, 1 refused"), "{}", diagnosed.stdout);
    assert!(!ran("check").stdout.contains("off the book"));
}

/// A report that is cut off is no better version of the flight that was learnt whole, whatever is asked for.
#[test]
fn the_beginning_of_a_report_does_not_take_the_place_of_the_whole() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    adapt(&model, &output, &[report(1), report(2)], &[]).expect(0);
    let learnt = bytes_below(&output)["segments/SIM-01.csv"].clone();
    let cut = changed(scratch.path(), 2, "cut.txt", |text| {
        text.lines().take(30).flat_map(|line| [line, "\n"]).collect()
    });
    adapt(&model, &output, &[report(1), cut], &["--relearn"])
        .expect(1)
        .says("of which it is a shorter version");
    assert_eq!(bytes_below(&output)["segments/SIM-01.csv"], learnt);
}

/// One report with a mistyped type costs itself on a night without another report of a known tail: new tails are learnt.
#[test]
fn a_mistyped_report_does_not_end_a_night_of_new_tails() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let other = model_of_type(scratch.path(), "A320", &fixture("guide.csv"));
    let more = ["--model", other.to_str().unwrap()];
    let renamed = |flight: u32, tail: &str, aircraft: &str| {
        changed(scratch.path(), flight, &format!("{tail}{flight}.txt"), |text| {
            text.replace("SIM-01", tail).replace("AIRCRAFT global5000", aircraft)
        })
    };
    adapt(&model, &output, &[report(1)], &more).expect(0);
    let stray = renamed(2, "SIM-01", "AIRCRAFT A320");
    let new = renamed(3, "SIM-02", "AIRCRAFT A320");
    adapt(&model, &output, &[stray, new], &more)
        .expect(1)
        .says("found aircraft type \"A320\", expected \"global5000\", the type of tail SIM-01");
    assert!(output.join("models/SIM-02.ron").exists());
}

/// A new tail does not enter a folder by another law or other trim criteria than its tails have.
#[test]
fn a_new_tail_learns_as_the_others_of_its_folder_do() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let new = changed(scratch.path(), 2, "new.txt", |text| text.replace("SIM-01", "SIM-02"));
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    let before = bytes_below(&output);
    adapt(&model, &output, std::slice::from_ref(&new), &["--law", "paper"])
        .expect(2)
        .says("bayes against paper");
    adapt(&model, &output, std::slice::from_ref(&new), &["--criteria", "airbus-report-02-short"])
        .expect(2)
        .says("trim criteria");
    assert_eq!(bytes_below(&output), before);
    adapt(&model, &output, &[new], &[]).expect(0);
}
