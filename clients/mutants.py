#!/usr/bin/env python3
"""Changes the code in a few hundred places, one at a time, and sees which changes the tests notice.

    clients/mutants.py [--sample 330] [--crate NAME] [--state target/mutants] [--changed WORD]...

The changes (mutants) are those that cargo-mutants lists; a fixed part of each crate is drawn, by a hash. All of them are
put into one copy of the tree, each behind a switch, so that it is built once:

    a < b   becomes   (if weald_core::mutant(7) { a <= b } else { a < b })

Every test then runs alone in a process, which notes the switches that it passes and its seconds. A mutant is tried
with the tests that pass its switch: those of its own crate first (of its own module, then the quickest), then those of
other crates, until one fails. One that takes ten times its seconds and 20 more has failed, too.

What was built, noted and found stays in the folder of `--state`; a second call goes on there and tries those again that
no test had noticed, with the tests that are new, and with those whose names have a WORD of `--changed`. Another tree or
sample needs another folder.

Needs `cargo install cargo-mutants` and tree-sitter: run it with the Python of `clients/install mutants`.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time

import tree_sitter
import tree_sitter_rust

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEED = "weald"
# Of each crate at least so many are drawn.
FEWEST = 8
# A test of more seconds is left out.
SLOWEST = 60
# Seconds that the tests of its own crate, and then those of the others, may take for one mutant.
PATIENCE = 90
# Crates that need no weald-core in the copy: it itself, and what has no mutants.
UNTOUCHED = ("crates/weald-core/", "crates/weald-dev/")
# More memory than any test needs, less than a machine has: a mutant may ask for ever more.
MEMORY = 16 << 30
WORKERS = 2

# What the copy's weald-core is given. A mutant of number 0 there is none; two values are no mutants.
SWITCH = r'''
/// Whether this mutant is the one that is switched on.
#[doc(hidden)]
#[inline(always)]
pub fn mutant(number: u32) -> bool {
    let active = mutants::ACTIVE.load(std::sync::atomic::Ordering::Relaxed);
    if active < mutants::RECORDING { active == number } else { mutants::first(number, active) }
}

mod mutants {
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

    pub(crate) const RECORDING: u32 = u32::MAX - 1;
    pub(crate) static ACTIVE: AtomicU32 = AtomicU32::new(u32::MAX);
    static REACHED: [AtomicBool; 4096] = [const { AtomicBool::new(false) }; 4096];

    #[cold]
    pub(crate) fn first(number: u32, active: u32) -> bool {
        if active == RECORDING {
            if !REACHED[number as usize].swap(true, Ordering::Relaxed) {
                let folder = std::env::var_os("WEALD_REACHED").unwrap_or_default();
                let _ = std::fs::write(std::path::Path::new(&folder).join(number.to_string()), "");
            }
            return false;
        }
        let asked = std::env::var("WEALD_MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        ACTIVE.store(if std::env::var_os("WEALD_REACHED").is_some() { RECORDING } else { asked }, Ordering::Relaxed);
        super::mutant(number)
    }
}
'''


def listed(only):
    """All mutants of the published crates, in the order in which they are drawn, by crate."""
    found = json.loads(subprocess.check_output(["cargo", "mutants", "--list", "--json", "--workspace"], cwd=ROOT))
    equals = collections.Counter()
    crates = collections.defaultdict(list)
    for mutant in found:
        package, file = mutant["package"], mutant["file"]
        if package == "weald-dev" or not file.startswith(f"crates/{package}/src/") or only not in (None, package):
            continue
        # Where a line stands may change: what counts is which of all equal changes of a file it is.
        what = f"{file}: " + re.sub(r"^[^:]*:\d+:\d+: ", "", mutant["name"])
        equals[what] += 1
        mutant["key"] = f"{what} #{equals[what]}"
        crates[package].append(mutant)
    for mutants in crates.values():
        mutants.sort(key=lambda mutant: hashlib.sha256(f"{SEED} {mutant['key']}".encode()).digest())
    return dict(sorted(crates.items()))


def shares(crates, sample):
    """How many are drawn of each crate: by its part of all, and no fewer than some."""
    left, small = sample, set()
    while True:
        total = sum(len(mutants) for name, mutants in crates.items() if name not in small)
        parts = {name: left * len(mutants) / total for name, mutants in crates.items() if name not in small}
        under = {name for name, part in parts.items() if part < FEWEST}
        if not under:
            break
        small |= under
        left = sample - FEWEST * len(small)
        if len(small) == len(crates):
            return dict.fromkeys(crates, -(-sample // len(crates)))
    drawn = {name: int(part) for name, part in parts.items()}
    for name in sorted(parts, key=lambda name: int(parts[name]) - parts[name])[: left - sum(drawn.values())]:
        drawn[name] += 1
    return drawn | dict.fromkeys(small, FEWEST)


def text_before(mutant):
    """A hash of its file down to the line where the mutant ends: tests at its end may be added."""
    lines = (ROOT / mutant["file"]).read_bytes().split(b"\n")[: mutant["span"]["end"]["line"]]
    return hashlib.sha256(b"\n".join(lines)).hexdigest()


class Source:
    """A file, and what is put into it."""

    def __init__(self, text, path):
        self.text, self.path, self.inserts = text, path, []
        self.lines = text.split(b"\n")
        self.tree = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language())).parse(text)
        self.call = b"crate::mutant" if path.startswith("crates/weald-core/") else b"::weald_core::mutant"

    def at(self, place):
        line = self.lines[place["line"] - 1].decode()
        before = sum(len(line) + 1 for line in self.lines[: place["line"] - 1])
        return before + len(line[: place["column"] - 1].encode())

    def raw(self, start, end):
        return self.text[start:end]

    def wrap(self, number, start, end, before, after):
        """Puts text around a part, with comments by which the part is found again."""
        self.inserts.append((start, end, len(self.inserts), b"/*<%d*/" % number + before, after + b"/*%d>*/" % number))

    def change(self, number, mutant):
        """Puts a mutant behind its switch; the reason why not, if it cannot be."""
        start, end = self.at(mutant["span"]["start"]), self.at(mutant["span"]["end"])
        node = self.tree.root_node.descendant_for_byte_range(start, end)
        if in_constant(node):
            return "in a constant"
        if mutant["genre"] == "FnValue" and "impl " in mutant["function"]["return_type"]:
            return "another type than what the function returns"
        on = b"%s(%d)" % (self.call, number)
        new = mutant["replacement"].encode()
        if mutant["genre"] == "FnValue":
            while node and node.type != "function_item":
                node = node.parent
            body = node and node.child_by_field_name("body")
            if not body:
                return "no body"
            place = body.start_byte + 1
            self.wrap(number, place, place, b" if %s { return %s; } " % (on, new), b"")
        elif mutant["genre"] in ("BinaryOperator", "UnaryOperator"):
            whole = node.parent
            if not whole or whole.type not in ("binary_expression", "compound_assignment_expr", "unary_expression"):
                return f"an operator in {whole and whole.type}"
            other = self.raw(whole.start_byte, start) + new + self.raw(end, whole.end_byte)
            # A comment of a line would swallow what follows it.
            before = b"(if %s { %s\n } else { " % (on, other)
            self.wrap(number, whole.start_byte, whole.end_byte, before, b"\n })")
        elif mutant["genre"] == "StructField":
            while node and node.type != "struct_expression":
                node = node.parent
            if not node:
                return "no struct"
            rest = self.raw(end, node.end_byte)
            other = self.raw(node.start_byte, start) + re.sub(rb"^\s*,", b"", rest)
            before = b"(if %s { %s\n } else { " % (on, other)
            self.wrap(number, node.start_byte, node.end_byte, before, b"\n })")
        else:
            while node and node.type != "match_arm":
                node = node.parent
            pattern = node and node.child_by_field_name("pattern")
            if not pattern:
                return "no arm"
            guard = pattern.child_by_field_name("condition")
            if guard and guard.type in ("let_condition", "let_chain"):
                return "a guard with let"
            way = {"true": b"%s || (", "false": b"!%s && ("}.get(mutant["replacement"], b"!%s && (") % on
            if guard:
                self.wrap(number, guard.start_byte, guard.end_byte, way, b")")
            else:
                self.wrap(number, pattern.end_byte, pattern.end_byte, b" if !%s " % on, b"")
        return None

    def changed(self):
        """The text with all mutants: outer parts begin before inner ones and end after them."""
        events = []
        for start, end, order, before, after in self.inserts:
            if start == end:
                events.append((start, 1, 0, order, before + after))
            else:
                events.append((start, 2, -end, order, before))
                events.append((end, 0, -start, -order, after))
        out, place = [], 0
        for at, _, _, _, text in sorted(events):
            out += [self.text[place:at], text]
            place = at
        return b"".join(out) + self.text[place:]


def in_constant(node):
    """Whether something is computed by the compiler, which knows no switches."""
    while node:
        if node.type in ("const_item", "static_item", "array_type", "const_block", "enum_variant", "const_parameter"):
            return True
        if node.type == "function_item":
            return any(child.type == "function_modifiers" and b"const" in child.text for child in node.children)
        if node.type == "array_expression" and any(child.type == ";" for child in node.children):
            return True
        node = node.parent
    return False


def put(path, text):
    """Writes a file only when it is another, so that cargo builds no more than it must."""
    if not path.exists() or path.read_bytes() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)


class Tree:
    """The copy of the tree in which all mutants are."""

    def __init__(self, state):
        self.folder = state / "tree"
        self.files = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT).decode().split("\0")[:-1]
        new = subprocess.check_output(["git", "ls-files", "-z", "-o", "--exclude-standard"], cwd=ROOT)
        self.files += new.decode().split("\0")[:-1]

    def write(self, numbered):
        """Copies the tree with these mutants; gives those that cannot be put in."""
        failed = {}
        by_file = collections.defaultdict(list)
        for number, mutant in numbered.items():
            by_file[mutant["file"]].append((number, mutant))
        for name in self.files:
            if not (ROOT / name).is_file():
                continue
            text = (ROOT / name).read_bytes()
            if name in by_file:
                source = Source(text, name)
                for number, mutant in by_file[name]:
                    reason = source.change(number, mutant)
                    if reason:
                        failed[number] = reason
                text = source.changed()
            if name == "crates/weald-core/src/lib.rs":
                text += SWITCH.encode()
            elif re.fullmatch(r"crates/[^/]*/Cargo\.toml", name) and not name.startswith(UNTOUCHED):
                before, heading, after = text.partition(b"\n[dependencies]\n")
                if b"\nweald-core" not in b"\n" + after.partition(b"\n[")[0]:
                    text = before + heading + b"weald-core = { workspace = true }\n" + after
            put(self.folder / name, text)
        gone = set(path for path in self.folder.rglob("*.rs") if "target" not in path.parts)
        for path in gone - {self.folder / name for name in self.files}:
            path.unlink()
        return failed

    def cargo(self, *arguments):
        """The messages of cargo."""
        command = ["cargo", *arguments, "--message-format", "json"]
        run = subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        return run.returncode, [json.loads(line) for line in run.stdout.splitlines() if line.startswith(b"{")], run.stderr

    def guilty(self, messages):
        """The mutants within which the compiler found errors."""
        found = {}
        for message in messages:
            message = message.get("message", {})
            if message.get("level") != "error" or not message.get("spans"):
                continue
            spans = sorted(message["spans"], key=lambda span: not span["is_primary"])
            blamed = next(filter(None, map(self.innermost, spans)), None)
            # What a mutant says of types may come out elsewhere in its function.
            for number in [blamed] if blamed else self.of_function(spans[0]):
                found[number] = message["message"]
        return found

    def of_function(self, span):
        """All mutants of the function with this part."""
        text = (self.folder / span["file_name"]).read_bytes()
        tree = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language())).parse(text)
        node = tree.root_node.descendant_for_byte_range(span["byte_start"], span["byte_end"])
        while node and node.type != "function_item":
            node = node.parent
        return [int(number) for number in re.findall(rb"/\*<(\d+)\*/", node.text)] if node else []

    def innermost(self, span):
        path = self.folder / span["file_name"]
        if not path.is_file():
            return None
        text, best = path.read_bytes(), None
        for begin in re.finditer(rb"/\*<(\d+)\*/", text):
            end = text.find(b"/*%s>*/" % begin[1])
            if begin.start() < span["byte_end"] and span["byte_start"] < end:
                best = min(best or (end - begin.start(), int(begin[1])), (end - begin.start(), int(begin[1])))
        return best and best[1]


def compiling(tree, crates, drawn, state):
    """Draws mutants until enough of each crate compile, and leaves the copy with just those."""
    # Some do not compile, so more are tried at first.
    numbered, number = {}, 0
    for name, count in drawn.items():
        for mutant in crates[name][: count * 8 // 5 + 8]:
            number += 1
            numbered[number] = mutant
    kept = state / "dropped.json"
    dropped = json.loads(kept.read_text()) if kept.exists() else {}
    numbered = {number: mutant for number, mutant in numbered.items() if mutant["key"] not in dropped}
    while True:
        failed = tree.write(numbered)
        if not failed:
            code, messages, errors = tree.cargo("check", "--workspace", "--lib", "--bins", "--keep-going")
            failed = tree.guilty(messages)
            if code == 0:
                break
            if not failed:
                sys.exit(f"mutants: the copy does not compile, and no mutant is to blame\n{errors.decode()}")
        for gone, reason in failed.items():
            dropped[numbered.pop(gone)["key"]] = reason
        kept.write_text(json.dumps(dropped, indent=1))
        print(f"{len(numbered)} mutants are left, {len(dropped)} do not compile", flush=True)
    chosen, counts = {}, collections.Counter()
    for number, mutant in numbered.items():
        counts[mutant["package"]] += 1
        if counts[mutant["package"]] <= drawn[mutant["package"]]:
            chosen[number] = mutant
    tree.write(chosen)
    return chosen


def tests_of(tree):
    """All tests: (crate, binary's name, test) and how each is run."""
    code, messages, errors = tree.cargo("test", "--workspace", "--lib", "--bins", "--tests", "--no-run")
    if code:
        sys.exit(f"mutants: the tests do not build\n{errors.decode()}")
    found = {}
    for message in messages:
        if message.get("reason") != "compiler-artifact" or not message.get("executable") or not message["profile"]["test"]:
            continue
        manifest = pathlib.Path(message["manifest_path"])
        crate, binary = manifest.parent.name, message["target"]["name"]
        environment = {"CARGO_MANIFEST_DIR": str(manifest.parent), "CARGO_PKG_NAME": crate}
        listing = subprocess.check_output([message["executable"], "--list", "--format", "terse"], cwd=manifest.parent)
        ignored = subprocess.check_output([message["executable"], "--list", "--format", "terse", "--ignored"], cwd=manifest.parent)
        for line in sorted(set(listing.decode().splitlines()) - set(ignored.decode().splitlines())):
            if line.endswith(": test"):
                test = line.removesuffix(": test")
                found[f"{crate} {binary} {test}"] = (message["executable"], test, manifest.parent, environment)
    return found


def run(how, extra, limit, scratch):
    """Runs one test alone: whether it passed, and its seconds."""
    executable, test, folder, environment = how
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    environment = os.environ | environment | extra | {"TMPDIR": str(scratch)}
    began = time.monotonic()
    process = subprocess.Popen(
        [executable, "--exact", test], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
    try:
        passed = process.wait(limit) == 0
    except subprocess.TimeoutExpired:
        passed = False
    # Children that a test has started end with it.
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()
    return passed, time.monotonic() - began


class Record:
    """A table that is kept in a file."""

    def __init__(self, path):
        self.path, self.lock = path, threading.Lock()
        self.table = json.loads(path.read_text()) if path.exists() else {}

    def set(self, key, value):
        with self.lock:
            self.table[key] = value
            self.path.with_suffix(".new").write_text(json.dumps(self.table, indent=0))
            self.path.with_suffix(".new").replace(self.path)


def reach(tests, state, changed=()):
    """What each test passes, and its seconds."""
    record = Record(state / "reach.json")
    record.table = {name: note for name, note in record.table.items() if not any(word in name for word in changed)}

    def note(name):
        scratch = state / f"scratch{threading.get_ident()}"
        folder = state / f"reached{threading.get_ident()}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        passed, seconds = run(tests[name], {"WEALD_REACHED": str(folder)}, SLOWEST, scratch)
        reached = sorted(int(entry.name) for entry in folder.iterdir())
        record.set(name, {"passed": passed, "seconds": round(seconds, 3), "reached": reached})

    # Unit tests first, which are many and quick, and last those that need a device.
    def order(name):
        crate, binary, _ = name.split(" ", 2)
        return binary != crate.replace("-", "_"), crate == "weald-gpu"

    new = sorted((name for name in tests if name not in record.table), key=order)
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        for done, _ in enumerate(pool.map(note, new), 1):
            if done % 100 == 0:
                print(f"{done} of {len(new)} tests have been run without a mutant", flush=True)
    failed = [name for name in tests if not record.table[name]["passed"]]
    print(f"{len(tests)} tests; left out, as they fail or take {SLOWEST} s or more without a mutant: {failed}", flush=True)
    return {name: record.table[name] for name in tests if record.table[name]["passed"]}


def module_of(file):
    """The path of a file's module, as tests of it begin."""
    parts = file.removesuffix(".rs").split("/")[3:]
    return "::".join(part for part in parts if part not in ("mod", "lib"))


def attempt(number, mutant, tests, noted, tried, state):
    """Tries a mutant with the tests that reach it and that it has not been tried with."""
    scratch = state / f"scratch{threading.get_ident()}"
    reaching = [name for name, note in noted.items() if number in note["reached"]]
    module = module_of(mutant["file"])

    def order(name):
        crate, _, test = name.split(" ", 2)
        return crate != mutant["package"], not (module and test.startswith(module)), noted[name]["seconds"]

    spent = collections.Counter()
    result = {"key": mutant["key"], "tried": list(tried), "left": 0}
    for name in sorted(set(reaching) - set(tried), key=order):
        own = name.split(" ")[0] == mutant["package"]
        seconds = noted[name]["seconds"]
        if spent[own] + seconds > PATIENCE:
            result["left"] += 1
            continue
        passed, took = run(tests[name], {"WEALD_MUTANT": str(number)}, 10 * seconds + 20, scratch)
        spent[own] += took
        if not passed:
            return result | {"by": name, "verdict": "own" if own else "other"}
        result["tried"].append(name)
    return result | {"verdict": "survived" if reaching else "unreached"}


def tally(chosen, results):
    """The table of all crates, and what no test has noticed."""
    verdicts = ("own", "other", "survived", "unreached")
    counts = collections.defaultdict(collections.Counter)
    for number, mutant in chosen.items():
        counts[mutant["package"]][results[str(number)]["verdict"]] += 1
    print("| crate | mutants | caught by its own tests | by those of others | survived | reached by no test |")
    print("|---|---|---|---|---|---|")
    total = sum(counts.values(), collections.Counter())
    for name, count in [*sorted(counts.items()), ("all", total)]:
        print(f"| {name} | {count.total()} | " + " | ".join(str(count[verdict]) for verdict in verdicts) + " |")
    for number, mutant in sorted(chosen.items(), key=lambda entry: entry[1]["name"]):
        result = results[str(number)]
        if result["verdict"] not in ("own", "other"):
            print(f"{number} {mutant['name']}: {result['verdict']}, {len(result['tried'])} tests, {result['left']} not tried")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=int, default=330)
    parser.add_argument("--crate")
    parser.add_argument("--state", type=pathlib.Path, default=ROOT / "target/mutants")
    parser.add_argument("--changed", metavar="WORD", action="append", default=[])
    asked = parser.parse_args()
    state = asked.state.resolve()
    state.mkdir(parents=True, exist_ok=True)
    tree, chosen_file = Tree(state), state / "chosen.json"
    if chosen_file.exists():
        chosen = {int(number): mutant for number, mutant in json.loads(chosen_file.read_text()).items()}
        moved = [mutant["key"] for mutant in chosen.values() if mutant["before"] != text_before(mutant)]
        if moved:
            sys.exit(f"mutants: the code down to these has changed; begin anew in another --state: {moved}")
        tree.write(chosen)
    else:
        crates = listed(asked.crate)
        drawn = shares(crates, asked.sample)
        print({name: f"{drawn[name]} of {len(crates[name])}" for name in crates}, flush=True)
        chosen = compiling(tree, crates, drawn, state)
        for mutant in chosen.values():
            mutant["before"] = text_before(mutant)
        chosen_file.write_text(json.dumps(chosen))
    tests = tests_of(tree)
    noted = reach(tests, state, asked.changed)
    record = Record(state / "results.json")
    for result in record.table.values():
        result["tried"] = [name for name in result["tried"] if not any(word in name for word in asked.changed)]

    def settle(number):
        before = record.table.get(str(number), {"verdict": "new", "tried": []})
        if before["verdict"] not in ("own", "other"):
            result = attempt(number, chosen[number], tests, noted, before["tried"], state)
            record.set(str(number), result)
            print(number, chosen[number]["name"], result["verdict"], result.get("by", ""), flush=True)

    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(settle, chosen))
    tally(chosen, record.table)


if __name__ == "__main__":
    main()
