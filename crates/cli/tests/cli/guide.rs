//! `cruisefit guide`: from a type's name to a model.

use crate::support::cruisefit;

#[test]
fn a_type_is_enough_to_begin() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("a320");
    let ran = cruisefit(&[
        "guide".as_ref(),
        "--type".as_ref(),
        "a20n".as_ref(),
        "-o".as_ref(),
        output.as_os_str(),
    ]);
    let text = ran.expect(0).stdout;
    assert!(text.contains("within 5 %") && text.contains("TSFC law misses"), "{text}");
    let aircraft = std::fs::read_to_string(output.join("AIRCRAFT.ron")).unwrap();
    assert!(aircraft.contains("type_code: \"A20N\""), "{aircraft}");
    let model = folder.path().join("MODEL.ron");
    let ran = cruisefit(&[
        "init".as_ref(),
        "--aircraft".as_ref(),
        output.join("AIRCRAFT.ron").as_os_str(),
        "--guide".as_ref(),
        output.join("guide.csv").as_os_str(),
        "-o".as_ref(),
        model.as_os_str(),
    ]);
    ran.expect(0);
    cruisefit(&["show".as_ref(), model.as_os_str()]).expect(0);
}

#[test]
fn the_list_and_an_unknown_type() {
    let text = cruisefit(&["guide", "--list"]).expect(0).stdout;
    assert_eq!(text.lines().count(), 68);
    assert!(text.contains("A20N  Airbus A320-NEO; also A19N, C919, MC23"), "{text}");
    cruisefit(&["guide", "--type", "C172", "-o", "nowhere"])
        .expect(2)
        .says("no public model of C172");
}

/// The public model has a number of engines, and no engine options.
#[test]
fn another_number_of_engines_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("a320");
    let guide = |engines: &str| {
        let output = output.to_str().unwrap();
        cruisefit(&["guide", "--type", "A320", "--engines", engines, "-o", output])
    };
    guide("4").expect(2).says("the public model of A320 has 2 engines, not 4");
    guide("CFM56-5B4/P").expect(2).says("knows no engine options");
    assert!(!output.exists());
    guide("2").expect(0);
    assert!(output.join("guide.csv").exists());
}

/// A P-8 is represented by a 737-800, which has as many engines; a C-17 by a 767, which has not.
#[test]
fn a_represented_type_is_said_to_be_another_aircraft() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("p8");
    let guide = |code: &str| {
        cruisefit(&[
            "guide".as_ref(),
            "--type".as_ref(),
            code.as_ref(),
            "-o".as_ref(),
            output.as_os_str(),
        ])
    };
    let text = guide("p8").expect(0).stdout;
    let whose = "a model of B738, with its wing, masses and 2 engines, and not of P8";
    assert!(text.contains(whose) && text.contains("nobody states"), "{text}");
    let aircraft = std::fs::read_to_string(output.join("AIRCRAFT.ron")).unwrap();
    assert!(aircraft.contains(whose) && aircraft.contains("(B738), for P8"), "{aircraft}");
    guide("C17").expect(2).says("C17 has 4 engines and B764, the type that represents it, has 2");
}

#[test]
fn a_guide_in_the_wrong_unit_is_refused_until_it_is_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    cruisefit(&[
        "guide".as_ref(),
        "--type".as_ref(),
        "A320".as_ref(),
        "-o".as_ref(),
        folder.path().as_os_str(),
    ])
    .expect(0);
    let halved: Vec<String> = std::fs::read_to_string(path("guide.csv"))
        .unwrap()
        .lines()
        .map(|line| match line.rsplit_once(',') {
            Some((others, flow)) if flow.parse::<f64>().is_ok() => {
                format!("{others},{}", 0.5 * flow.parse::<f64>().unwrap())
            }
            _ => line.to_owned(),
        })
        .collect();
    std::fs::write(path("half.csv"), halved.join("\n")).unwrap();
    let init = |more: &[&str]| {
        let (aircraft, guide, model) = (path("AIRCRAFT.ron"), path("half.csv"), path("MODEL.ron"));
        let mut arguments = vec![
            "init",
            "--aircraft",
            aircraft.to_str().unwrap(),
            "--guide",
            guide.to_str().unwrap(),
            "-o",
            model.to_str().unwrap(),
        ];
        arguments.extend(more);
        cruisefit(&arguments)
    };
    init(&[]).expect(2).says("lift-to-drag ratio of");
    assert!(!path("MODEL.ron").exists());
    init(&["--accept"]).expect(0);
}
