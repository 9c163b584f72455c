//! What a page holds, and what it holds of results that are not all there.

use crate::synthetic::{Blocks, FOLDER, HISTORY, complete, file, summary, write_frames};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_io::writers::json::Summary;
use signorini_report::{PageOptions, ReportError, check_page, page};
use std::path::Path;

fn text(fs: &MemoryFs) -> String {
    let bytes = page(fs, Path::new(FOLDER), &PageOptions::default()).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The sections of the page, in their order.
fn sections(page: &str) -> Vec<&str> {
    let parts = page.split("<section id=\"").skip(1);
    parts
        .filter_map(|part| part.split_once('"').map(|(id, _)| id))
        .collect()
}

/// All `data-key`s with their `data-value`s.
fn numbers(page: &str) -> Vec<(String, String)> {
    let parts = page.split("data-key=\"").skip(1);
    parts
        .map(|part| {
            let (key, rest) = part.split_once('"').unwrap();
            let value = rest.strip_prefix(" data-value=\"").unwrap();
            (key.to_owned(), value.split_once('"').unwrap().0.to_owned())
        })
        .collect()
}

#[test]
fn a_page_has_all_sections_in_their_order() {
    let all = [
        "verdict",
        "model",
        "contacts",
        "view",
        "histories",
        "convergence",
        "health",
        "provenance",
    ];
    assert_eq!(sections(&text(&complete())), all);
}

#[test]
fn every_number_of_a_table_is_that_of_the_summary_or_of_the_history() {
    let page = text(&complete());
    let values: serde_json::Value = serde_json::from_str(&summary().text()).unwrap();
    let rows: Vec<Vec<&str>> = HISTORY
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let all = numbers(&page);
    assert!(all.len() > 30, "{}", all.len());
    for (key, value) in all {
        let number: f64 = value.parse().unwrap();
        let wanted = if let Some(place) = key.strip_prefix("history.csv:") {
            let (row, column) = place.split_once(':').unwrap();
            let column = rows[0].iter().position(|name| *name == column).unwrap();
            rows[row.parse::<usize>().unwrap() + 1][column]
                .parse()
                .unwrap()
        } else {
            values
                .pointer(&format!("/{key}"))
                .unwrap()
                .as_f64()
                .unwrap()
        };
        assert_eq!(number, wanted, "{key}");
    }
}

#[test]
fn numbers_are_those_of_the_file_to_the_last_digit() {
    let number = (
        "work_external".to_owned(),
        "0.00011567142010628889".to_owned(),
    );
    assert!(numbers(&text(&complete())).contains(&number));
}

#[test]
fn what_was_run_is_said_in_sentences() {
    let page = text(&complete());
    for sentence in [
        "36 nodes, 8 elements, 54 unknowns.",
        "steel: linear-elastic, E = 210000.0; nu = 0.3",
        "foot: a (secondary) may not pass through b (primary); method mortar, enforced by Lagrange multipliers, friction 0.3, finite sliding",
        "base is held in x, y",
        "top moves: uz = -0.1",
        "side is loaded: force = (0.0, 1.0, 0.0)",
        "Two blocks &lt;of&gt; 1/2",
        "no convergence",
    ] {
        assert!(page.contains(sentence), "{sentence}");
    }
}

#[test]
fn a_page_loads_nothing_and_its_data_cannot_end_a_script() {
    let fs = complete();
    let mut evil = summary();
    evil.diagnostics
        .push(signorini_io::writers::json::DiagnosticSummary {
            code: "S0001".into(),
            message: "</script><script>alert(1)</script>".into(),
        });
    evil.write(&fs, &file("summary.json")).unwrap();
    let history = HISTORY.replace("foot.work_friction", "\"</script><b>\"");
    fs.write(&file("history.csv"), history.as_bytes()).unwrap();
    let page = text(&fs);
    assert!(!page.contains("alert(1)</script>") && !page.contains("</script><b>"));
    let page = page.replace("src=\"data:", "");
    for outside in ["src=\"", "href=\"http", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let count = |what: &str| page.matches(what).count();
    assert_eq!(count("<script"), count("</script>"));
}

#[test]
fn a_killed_run_has_a_page_without_a_verdict() {
    let fs = complete();
    fs.remove(&file("summary.json")).unwrap();
    let page = text(&fs);
    assert!(
        page.contains(
            "the run goes on or was killed; 2 converged increments on disk, up to time 1"
        )
    );
    assert!(page.contains("Extremes over all increments"));
    assert!(page.contains("The run has no summary: there is no audit of its states."));
    assert!(page.contains("id=\"stage\""));
}

#[test]
fn a_damaged_summary_is_named_and_the_rest_is_shown() {
    let fs = complete();
    fs.write(&file("summary.json"), b"{\"status\": \"sol")
        .unwrap();
    let page = text(&fs);
    assert!(page.contains("summary.json: "));
    assert!(page.contains("id=\"stage\""));
}

#[test]
fn a_failed_run_says_so_in_red() {
    let fs = complete();
    let failed = Summary {
        status: "not converged".into(),
        exit_code: 5,
        ..summary()
    };
    failed.write(&fs, &file("summary.json")).unwrap();
    let page = text(&fs);
    assert!(page.contains("<div class=\"banner failed\""));
    assert!(page.contains("Not converged · 2 increments, 7 iterations, 1 cut-back<"));
}

#[test]
fn a_missed_expectation_is_neither_solved_nor_failed() {
    let fs = complete();
    let mut missed = summary();
    missed.exit_code = 1;
    missed.expectations[0].ok = false;
    missed.write(&fs, &file("summary.json")).unwrap();
    let page = text(&fs);
    assert!(page.contains("<div class=\"banner missed\""));
    assert!(page.contains("1 of 1 expectation not met"));
}

#[test]
fn no_increment_gives_a_page_that_says_so() {
    let fs = complete();
    let header = HISTORY.lines().next().unwrap().to_owned() + "\n";
    fs.write(&file("history.csv"), header.as_bytes()).unwrap();
    fs.write(&file("convergence.csv"), b"step,increment\n")
        .unwrap();
    let page = text(&fs);
    assert!(page.contains("No increment has converged: history.csv has no rows."));
    assert!(page.contains("No increment converged and no iteration was written."));
}

#[test]
fn results_without_frames_have_tables_and_no_view() {
    let fs = complete();
    fs.remove(&file("results.pvd")).unwrap();
    fs.remove(&file("contact.pvd")).unwrap();
    let page = text(&fs);
    assert!(page.contains("The results hold no frames for a view"));
    assert!(!page.contains("id=\"stage\""));
    assert!(numbers(&page).len() > 30);
}

#[test]
fn a_damaged_frame_leaves_out_the_view_and_is_named() {
    let fs = complete();
    fs.write(&file("frames/volume_0002.vtu"), b"<VTKFile")
        .unwrap();
    let page = text(&fs);
    assert!(page.contains("frames/volume_0002.vtu: "));
    assert!(!page.contains("id=\"stage\""));
}

#[test]
fn a_model_in_the_plane_without_contact_has_a_page() {
    let fs = MemoryFs::default();
    let plane = Blocks { n: 3, plane: true };
    write_frames(&fs, &plane, 2);
    let page = text(&fs);
    assert!(page.contains("\"plane\":true"));
    assert!(page.contains("The results hold no contact."));
    assert!(page.contains("The folder has no case.resolved.toml"));
}

#[test]
fn bodies_of_revolution_show_only_the_axial_force() {
    let fs = complete();
    let resolved = String::from_utf8(fs.read(&file("case.resolved.toml")).unwrap()).unwrap();
    let resolved = resolved.replace("space = \"3d\"", "space = \"axisymmetric\"");
    fs.write(&file("case.resolved.toml"), resolved.as_bytes())
        .unwrap();
    let page = text(&fs);
    let keys: Vec<String> = numbers(&page).into_iter().map(|(key, _)| key).collect();
    let has = |key: &str| keys.iter().any(|other| other == key);
    assert!(has("contacts/foot/force/1"));
    for key in [
        "force/0",
        "force/2",
        "moment/0",
        "moment/2",
        "imbalance_moment",
    ] {
        assert!(!has(&format!("contacts/foot/{key}")), "{key}");
    }
    assert!(page.contains("\"name\":\"foot.force_y\""));
    assert!(!page.contains("\"name\":\"foot.force_x\""));
    assert!(page.contains("sum of all reactions, y") && !page.contains("sum of all reactions, x"));
}

#[test]
fn the_view_is_a_picture_until_the_script_draws_it() {
    assert!(text(&complete()).contains("id=\"still\" src=\"data:image/png;base64,"));
}

#[test]
fn parts_are_named_by_the_contacts_whose_secondary_sides_they_carry() {
    let parts = "\"parts\":[\"part 1\",\"part 2, secondary side of foot\"]";
    assert!(text(&complete()).contains(parts));
}

#[test]
fn two_runs_are_compared_column_by_column() {
    let fs = complete();
    let other = Path::new("other.out");
    let history = HISTORY.replace("32.15563034983922,", "33.15563034983922,");
    fs.write(&other.join("history.csv"), history.as_bytes())
        .unwrap();
    let options = PageOptions {
        compare: Some(other.into()),
        ..PageOptions::default()
    };
    let page = page(&fs, Path::new(FOLDER), &options).unwrap();
    let page = String::from_utf8(page).unwrap();
    assert!(sections(&page).contains(&"comparison"));
    let row = page.split("<td>foot.force_z</td>").nth(1).unwrap();
    let row = row.split("</tr>").next().unwrap();
    assert!(
        row.contains("data-value=\"33.15563034983922\"") && row.contains("data-value=\"1.0\""),
        "{row}"
    );
}

#[test]
fn a_folder_without_results_is_refused_with_a_remedy() {
    let fs = MemoryFs::default();
    fs.write(Path::new("a/notes.txt"), b"nothing").unwrap();
    let error = page(&fs, Path::new("a"), &PageOptions::default()).unwrap_err();
    assert!(matches!(error, ReportError::NotResults { .. }));
    assert!(
        error
            .to_string()
            .starts_with("a holds no results: none of summary.json, ")
    );
    assert!(error.help().contains("signorini run"));
    assert_eq!(error.exit_code(), 3);
}

#[test]
fn the_page_of_a_check_shows_lines_findings_and_cells() {
    let grid = Blocks { n: 2, plane: false };
    let lines = ["36 nodes".to_owned(), "  27 points within reach".to_owned()];
    let findings = ["warning[S0301]: body \"upper\" is held only by contact".to_owned()];
    let page = check_page(
        "Two blocks",
        "mm-N-MPa",
        &grid.volume(0.0),
        &lines,
        &findings,
    );
    let page = String::from_utf8(page).unwrap();
    assert_eq!(sections(&page), ["verdict", "model", "view"]);
    assert!(page.contains("27 points within reach") && page.contains("is held only by contact"));
    assert!(page.contains("id=\"stage\"") && page.contains("1 finding"));
    let torn = check_page("t", "", b"<VTKFile", &lines, &[]);
    assert!(String::from_utf8(torn).unwrap().contains("check.vtu: "));
}
