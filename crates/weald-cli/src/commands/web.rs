//! `weald web`.

use std::path::{Path, PathBuf};

use tiny_http::{Header, Request, Response, Server};

use crate::failure::Failure;
use crate::{interrupt, stdout};

/// What every page has.
const INDEX: &str = "index.html";

pub(crate) fn web(folder: Option<PathBuf>, serve: Option<u16>) -> Result<(), Failure> {
    let folder = found(folder)?;
    let Some(port) = serve else {
        let shown = folder.display();
        return stdout::print(&format!(
            "{shown}\nany web server serves this folder; to try it: weald web {shown} --serve\n"
        ));
    };
    let server = Server::http(("127.0.0.1", port)).map_err(|cause| {
        Failure::run(format!(
            "port {port} cannot be had: {cause}; give another by --serve PORT, or 0 for a free one"
        ))
    })?;
    let address = server.server_addr().to_ip().map_or_else(String::new, |address| address.to_string());
    stdout::print(&format!("http://{address}/\n"))?;
    interrupt::end_at_once()?;
    for request in server.incoming_requests() {
        // Who asked and went away needs no answer.
        let _ = answer(&folder, request);
    }
    Ok(())
}

/// The folder of the page.
fn found(folder: Option<PathBuf>) -> Result<PathBuf, Failure> {
    if let Some(folder) = folder {
        return if folder.join(INDEX).is_file() {
            Ok(folder)
        } else {
            Err(Failure::usage(format!("{} has no {INDEX}: it is no page of Weald", folder.display())))
        };
    }
    let beside = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.join("web")));
    let usual = [beside, Some(PathBuf::from("target/page"))];
    let there = usual.into_iter().flatten().find(|folder| folder.join(INDEX).is_file());
    there.ok_or_else(|| {
        let remedy = "give its folder, or make it: cargo run --release -p weald-dev -- web";
        Failure::usage(format!("there is no page beside this program nor in target/page; {remedy}"))
    })
}

/// Answers with a file of the folder, packed where the browser can unpack it.
fn answer(folder: &Path, request: Request) -> std::io::Result<()> {
    let asked = request.url().split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let name = if asked.is_empty() { INDEX } else { asked };
    // A page has no folders: a name with a way in it is none of its files.
    let is_name = !name.contains(['/', '\\', '%']) && !name.starts_with('.');
    let path = folder.join(name);
    if !is_name || !path.is_file() {
        return request.respond(Response::from_string("there is no such file\n").with_status_code(404));
    }
    let unpacks = request
        .headers()
        .iter()
        .any(|header| header.field.equiv("Accept-Encoding") && header.value.as_str().contains("br"));
    let packed = folder.join(format!("{name}.br"));
    let (path, is_packed) = if unpacks && packed.is_file() { (packed, true) } else { (path, false) };
    let mut response =
        Response::from_data(std::fs::read(path)?).with_header(header("Content-Type", kind_of(name)));
    if is_packed {
        response.add_header(header("Content-Encoding", "br"));
    }
    request.respond(response)
}

fn header(field: &str, value: &str) -> Header {
    Header::from_bytes(field, value).expect("both are plain ASCII")
}

fn kind_of(name: &str) -> &'static str {
    match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    }
}
