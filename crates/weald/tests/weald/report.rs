//! The HTML page about a run: well-formed, complete in itself, and with the numbers of the run.
//!
//! `python3` must be there, whose XML parser is the judge of the markup.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use weald::export::report::Page;
use weald::export::{Export, Finished};
use weald::grid::Mask;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald::{Domain, Field, Landscape, Size};

/// A run with water, as a page.
fn page_of_a_run() -> String {
    let text = "[landscape]\nsize = [72, 56]\ncell = 20.0\nseed = 41\n[[step]]\ndo = \"diamond-square\"\nrelief = 300.0\n\
                [[step]]\ndo = \"hydraulic\"\niterations = 480\nboundary = \"open\"\n[[step]]\ndo = \"slope\"\n\
                [[output]]\nexport = \"report\"\nfile = \"page.html\"\nwidth = 300\n";
    let recipe = Recipe::parse("land of <rain> & \"wind\".toml", text, &Overrides::default()).expect("good");
    let folder = tempfile::tempdir().expect("a folder");
    let report = Run { recipe: &recipe, options: Options::into_folder(folder.path()) }.execute(&Silent);
    let report = report.expect("runs");
    let page = std::fs::read_to_string(folder.path().join("page.html")).expect("written");
    assert!(page.contains(&report.recipe_blake3) && page.contains(">41<"), "hash and seed are on the page");
    page
}

/// Two ridges with a valley between them, and a corner without data.
fn land() -> Landscape {
    let size = Size::new(60, 50).expect("small");
    let flags: Vec<bool> = (0..size.cells()).map(|cell| cell % 60 + cell / 60 > 12).collect();
    let mut landscape = Landscape::new(Domain { valid: Mask::new(size, flags), ..Domain::new(size, 30.0) });
    let height = |x: usize, y: usize| {
        4.0 * (x as f32 - 30.0).abs() + 3.0 * y as f32 + 0.3 * ((x * 7 + y * 3) % 5) as f32
    };
    landscape.insert("height", "m", Field::from_function(size, height));
    landscape
}

fn page(landscape: &Landscape) -> String {
    let page = Page { width: 240, ..Page::default() };
    let finished = Finished { landscape, steps: &[], recipe: "ridges.toml", hash: "ab12", seed: 3 };
    let parts = page.parts(&finished, Path::new("page.html")).expect("a page");
    assert_eq!(parts.len(), 1, "all is in one file");
    String::from_utf8(parts[0].bytes.clone()).expect("text")
}

/// Puts markup to Python's XML parser, and gives what its last line prints for it.
fn judged(markup: &str, question: &str) -> String {
    let script = format!(
        "import sys, xml.etree.ElementTree as tree\nroot = tree.fromstring(sys.stdin.buffer.read())\nprint({question})"
    );
    let python = Command::new("python3")
        .args(["-c", &script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap_or_else(|cause| {
            panic!("python3 does not start ({cause}); install it: apt-get install python3")
        });
    let mut input = python.stdin.as_ref().expect("piped");
    input.write_all(markup.as_bytes()).expect("python reads");
    let output = python.wait_with_output().expect("python ends");
    assert!(output.status.success(), "the page is not well-formed XML");
    String::from_utf8(output.stdout).expect("text").trim().to_owned()
}

#[test]
fn a_page_is_well_formed_and_needs_nothing_but_itself() {
    let page = page_of_a_run();
    assert_eq!(judged(&page, "root.find('body/main/header/h1').text"), "land of <rain> & \"wind\"");
    for foreign in ["http:", "https:", "<script", "<link", "url(", "@import", "src=\"/"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert_eq!(
        judged(
            &page,
            "len([i for i in root.iter('img') if not i.get('src').startswith('data:image/png;base64,')])"
        ),
        "0"
    );
    let headings = judged(&page, "'|'.join(h.text for h in root.iter('h2'))");
    assert_eq!(headings, "The ground|Rivers|Layers|Steps|Budgets|Measures|Where it came from");
    let silent = judged(
        &page,
        "[s.attrib for s in root.iter('svg') if not s.get('aria-label')] + [i for i in root.iter('img') if not i.get('alt')]",
    );
    assert_eq!(silent, "[]", "every picture says what it shows");
}

#[test]
fn a_page_shows_every_layer_and_step_of_the_run_with_its_budget_and_its_network() {
    let page = page_of_a_run();
    for layer in ["water", "sediment", "flux_x", "flux_y", "erosion", "deposition", "slope"] {
        assert!(page.contains(&format!("<th scope=\"row\">{layer}</th>")), "{layer} in the table");
        assert!(page.contains(&format!("alt=\"Map of the layer {layer}\"")), "{layer} as a map");
    }
    assert!(page.contains("<th scope=\"row\">2. hydraulic</th><td class=\"number\">480</td>"));
    assert!(page.contains("Water in m³") && page.contains("Solid in m³"));
    for measure in ["chan", "reach", "drains", "pits"] {
        assert!(page.contains(&format!("<th scope=\"row\">{measure}</th>")), "{measure}");
    }
}

#[test]
fn the_bars_of_the_histogram_hold_every_cell_with_data_once() {
    let land = land();
    let page = page(&land);
    let sum =
        judged(&page, "sum(int(r.get('data-cells')) for r in root.iter('rect') if r.get('class') == 'bar')");
    assert!(land.domain.valid_cells() < 3000, "some cells have no data");
    assert_eq!(sum, land.domain.valid_cells().to_string());
}

/// Points of the first line of a class: across and down.
fn points(page: &str, class: &str) -> Vec<(f64, f64)> {
    let start = format!("<polyline class=\"{class}\" points=\"");
    let (_, rest) = page.split_once(&start).unwrap_or_else(|| panic!("there is a line {class}"));
    let (line, _) = rest.split_once('"').expect("an attribute ends");
    let point = |pair: &str| {
        let (x, y) = pair.split_once(',').expect("two numbers");
        (x.parse().expect("a number"), y.parse().expect("a number"))
    };
    line.split(' ').map(point).collect()
}

#[test]
fn the_hypsometric_curve_falls_from_the_highest_to_the_lowest_ground() {
    let curve = points(&page(&land()), "curve hypsometric");
    assert!(curve.len() > 100 && curve[0].0 < curve[curve.len() - 1].0);
    assert!(curve.windows(2).all(|pair| pair[1].0 >= pair[0].0 && pair[1].1 >= pair[0].1));
    assert!(curve[curve.len() - 1].1 - curve[0].1 > 200.0, "it uses the height of the chart");
}

#[test]
fn no_river_rises_on_its_way_down() {
    let page = page(&land());
    let profile = points(&page, "curve profile series-0");
    assert!(profile.len() > 20, "the valley has a river");
    // From the head, far from the end on the right, down to the end on the left: down the page.
    assert!(profile.windows(2).all(|pair| pair[1].0 <= pair[0].0 && pair[1].1 >= pair[0].1 - 0.11));
    assert!(profile[profile.len() - 1].1 - profile[0].1 > 50.0, "the river falls");
    assert!(
        page.contains("The recipe has no steps <code>flow</code>"),
        "the page says where its rivers are from"
    );
}

#[test]
fn flat_ground_and_a_single_cell_have_a_page_too() {
    for (columns, rows) in [(1, 1), (1, 9), (24, 24)] {
        let size = Size::new(columns, rows).expect("small");
        let mut flat = Landscape::new(Domain::new(size, 1.0));
        flat.insert("height", "m", Field::filled(size, 7.0));
        let bars = judged(&page(&flat), "len([r for r in root.iter('rect') if r.get('class') == 'bar'])");
        assert_eq!(bars, "1", "{columns} × {rows}");
    }
}

#[test]
fn a_recipe_for_a_page_writes_the_page_alone() {
    let text =
        "[landscape]\nsize = 24\n[[step]]\ndo = \"fbm\"\n[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";
    let recipe = |text: &str| Recipe::parse("r.toml", text, &Overrides::default()).expect("good");
    let hash = recipe(text).hash();
    let page = recipe(text).for_page(Path::new("r.html")).expect("there is a height");
    assert_eq!(page.hash(), hash);
    let folder = tempfile::tempdir().expect("a folder");
    let options = Options { report: false, ..Options::into_folder(folder.path()) };
    Run { recipe: &page, options }.execute(&Silent).expect("runs");
    let names: Vec<_> = std::fs::read_dir(folder.path())
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name())
        .collect();
    assert_eq!(names, ["r.html"]);
    let without =
        text.replace("do = \"fbm\"", "do = \"fbm\"\ninto = \"hills\"").replace("\"height\"", "\"hills\"");
    let error = recipe(&without).for_page(Path::new("r.html")).expect_err("no height").to_string();
    assert!(error.contains("a page needs layer `height`"), "{error}");
}

#[test]
fn the_heights_of_a_landscape_by_the_sea_are_those_of_its_land() {
    let median = |page: &str| -> f64 {
        let (_, rest) = page.split_once("Half of the land lies below ").expect("the caption");
        rest.split(' ').next().and_then(|word| word.parse().ok()).expect("a number")
    };
    let mut by_the_sea = land();
    let whole = median(&page(&by_the_sea));
    by_the_sea.domain.sea_level = Some(whole);
    let page = page(&by_the_sea);
    assert!(median(&page) > whole + 10.0, "the floor of the sea does not count: {}", median(&page));
    assert!(page.contains(&format!("the sea at {whole} m covers ")), "it says how much is sea");
}
