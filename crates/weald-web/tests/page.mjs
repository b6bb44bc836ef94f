// Drives the page in real browsers as a person does: `node page.mjs FOLDER WEALD PICTURES [simulated|device|rays|firefox]`.
//
// FOLDER is the page, WEALD the program that serves it and with which heights are compared, PICTURES a folder for what was
// seen. Everything is found by its label, clicked and typed; the test ends with 0 when all of it was as it should be.
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import process from "node:process";

const [folder, weald, pictures, only] = process.argv.slice(2);
const puppeteer = createRequire(join(process.env.WEALD_CLIENTS ?? "target/clients", "browser/"))("puppeteer-core");
mkdirSync(pictures, { recursive: true });

const RECIPE = `weald = 1
[landscape]
size = 96
cell = 20.0
seed = 5
[[step]]
do = "diamond-square"
relief = 400.0
[[step]]
do = "hydraulic"
model = "mei"
iterations = 120
boundary = "open"
[[output]]
layer = "height"
file = "height.npy"
`;

// What grows has shaders of its own.
const GROWN = `weald = 1
[landscape]
size = 64
cell = 1.0
seed = 5
[[step]]
do = "fbm"
relief = 8.0
[[step]]
do = "flow"
[[step]]
do = "wetness"
[[step]]
do = "moisture"
[[step]]
do = "soil"
[[step]]
do = "sunlight"
[[step]]
do = "scatter"
plant = "fern"
count = 100
spacing = 1.0
into = "ferns"
[[step]]
do = "grass"
sets = 20.0
[[output]]
layer = "height"
file = "height.tif"
`;

// What is simulated by WebGPU: software takes some seconds for a step of either.
const STEPS = 40;
const VALLEY = RECIPE.replace("iterations = 120", `iterations = ${STEPS}`);
// Flat ground under floods, on one grid: on steep ground they meet forks where the last digit decides.
const FLOOD = RECIPE.replace("relief = 400.0", "relief = 25.0").replace(
  /do = "hydraulic"[^[]*/,
  `do = "fluvial"
duration = 6_600.0
levels = 1
steps = ${STEPS}
mean_over = 1
boundary = "open"
`,
);

// Metres that a device may differ by from the processor in its worst cell, and on average, as in `engines_agree`.
const WORST = 1e-4;
const MEAN = 2e-6;

const failures = [];
function expect(holds, what) {
  console.log(`${holds ? "  ok  " : "FAILED"} ${what}`);
  if (!holds) failures.push(what);
}

// How many times longer than usual all may take.
const PATIENCE = 2;

async function until(what, test, seconds = 120, seen = () => "") {
  const end = Date.now() + 1000 * PATIENCE * seconds;
  for (;;) {
    const found = await test();
    if (found) return found;
    if (Date.now() > end) throw new Error(`${what} did not come within ${PATIENCE * seconds} s${seen()}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

// A page with what a person does on it.
class Visitor {
  constructor(page, name) {
    this.page = page;
    this.name = name;
    this.count = 0;
    page.on("pageerror", (error) => expect(false, `${name}: no error of the page: ${error.message}`));
    page.on("console", (message) => {
      if (message.type() === "error") console.log(`       ${name} console: ${message.text().slice(0, 300)}`);
      // What is wrong with a shader is a warning, and all that is said of it later hangs on it.
      if (message.text().includes("WGSL")) expect(false, `${name}: no word about a shader: ${message.text().slice(0, 300)}`);
    });
  }

  async state() {
    return JSON.parse((await this.page.evaluate(() => window.weald?.page?.state() ?? "null")) ?? "null");
  }

  is(what, test, seconds) {
    let last = null;
    const holds = async () => {
      last = await this.state();
      return last && test(last) ? last : null;
    };
    return until(`${this.name}: ${what}`, holds, seconds, () => `: ${JSON.stringify({ ...last, text: undefined })}`);
  }

  // What the page says above the studio.
  notice() {
    const read = () => this.page.$eval("#notices p", (line) => line.textContent).catch(() => null);
    return until(`${this.name}: a notice`, read, 240);
  }

  places(label) {
    return this.page.evaluate((label) => window.weald.page.find(label), label);
  }

  // The same once they lie where they lay two pictures before: what has just come moves what stands beside it.
  async settledPlaces(label) {
    let [before, since] = ["", 0];
    const look = (label) => [window.weald.page.find(label), JSON.parse(window.weald.page.state())?.frames ?? 0];
    return until(`${this.name}: "${label}"`, async () => {
      const [places, frames] = await this.page.evaluate(look, label);
      // They come in any order.
      places.sort((one, other) => one[1] - other[1] || one[0] - other[0]);
      const now = JSON.stringify(places);
      if (!places.length || now !== before) [before, since] = [now, frames];
      return places.length && frames >= since + 2 ? places : null;
    });
  }

  // The studio has seen what the hand did.
  async framed() {
    const { frames } = await this.is("a frame", (state) => state);
    await this.is("frames", (state) => state.frames >= frames + 2);
  }

  async click(label) {
    const [place] = await this.settledPlaces(label);
    await this.page.mouse.move((place[0] + place[2]) / 2, (place[1] + place[3]) / 2);
    await new Promise((resolve) => setTimeout(resolve, 120));
    await this.page.mouse.down();
    await new Promise((resolve) => setTimeout(resolve, 60));
    await this.page.mouse.up();
    await new Promise((resolve) => setTimeout(resolve, 120));
  }

  async drag(label, from, to) {
    const [place] = await this.settledPlaces(label);
    const at = ([x, y]) => [place[0] + x * (place[2] - place[0]), place[1] + y * (place[3] - place[1])];
    await this.page.mouse.move(...at(from));
    await this.page.mouse.down();
    await this.framed();
    for (let step = 1; step <= 8; step++) {
      await this.page.mouse.move(...at([0, 1].map((axis) => from[axis] + ((to[axis] - from[axis]) * step) / 8)));
      await new Promise((resolve) => setTimeout(resolve, 40));
    }
    await this.framed();
    await this.page.mouse.up();
  }

  drop(name, text, size) {
    return this.page.evaluate(
      (name, text, size) => {
        const file = new File([text], name);
        if (size) Object.defineProperty(file, "size", { value: size });
        return window.weald.arrive(file);
      },
      name,
      text,
      size ?? 0,
    );
  }

  // Bytes of the heights, as they lie in memory.
  async heights() {
    const letters = await this.page.evaluate(() => {
      const bytes = new Uint8Array(window.weald.page.heights().buffer);
      let letters = "";
      for (const byte of bytes) letters += String.fromCharCode(byte);
      return btoa(letters);
    });
    return Buffer.from(letters, "base64");
  }

  // Takes back what was done last, until so many moments are left.
  async undoTo(moments) {
    for (let left = (await this.state()).moments; left > moments; ) {
      await this.page.keyboard.down("Control");
      await this.page.keyboard.press("z");
      await this.page.keyboard.up("Control");
      ({ moments: left } = await this.is("less", (state) => state.moments < left && state.idle && state.whole));
    }
  }

  // Has the worker count what it asks its device to compute.
  async countPasses() {
    await this.page.workers()[0].evaluate(() => {
      const dispatch = GPUComputePassEncoder.prototype.dispatchWorkgroups;
      globalThis.passes = 0;
      GPUComputePassEncoder.prototype.dispatchWorkgroups = function (...how) {
        globalThis.passes += 1;
        return dispatch.apply(this, how);
      };
    });
  }

  passes() {
    return this.page.workers()[0].evaluate(() => globalThis.passes);
  }

  // Has the worker give up its device, which it uses just now.
  async loseSimulation() {
    await this.page.workers()[0].evaluate(
      () =>
        new Promise((resolve) => {
          const make = GPUDevice.prototype.createCommandEncoder;
          GPUDevice.prototype.createCommandEncoder = function (...how) {
            GPUDevice.prototype.createCommandEncoder = make;
            const encoder = make.apply(this, how);
            this.destroy();
            resolve();
            return encoder;
          };
        }),
    );
  }

  async picture(name) {
    this.count += 1;
    await this.page.screenshot({ path: join(pictures, `${this.name}-${this.count}-${name}.png`) });
  }
}

function served() {
  const server = spawn(weald, ["web", folder, "--serve", "0"], { stdio: ["ignore", "pipe", "inherit"] });
  return new Promise((resolve, reject) => {
    server.on("exit", (code) => reject(new Error(`the server ended with ${code}`)));
    server.stdout.once("data", (line) => resolve({ server, address: String(line).trim() }));
  });
}

// How heights differ: in how many cells, by how many metres at most, and on average.
function differences(heights, wanted) {
  const [one, other] = [heights, wanted].map((bytes) => new Float32Array(new Uint8Array(bytes).buffer));
  let [cells, most, sum] = [Math.abs(one.length - other.length), 0, 0];
  one.forEach((metres, cell) => {
    const metresBetween = Math.abs(metres - other[cell]);
    if (metresBetween !== 0) cells += 1;
    most = Math.max(most, metresBetween);
    sum += metresBetween;
  });
  return { cells, of: other.length, most, mean: sum / other.length };
}

function same(heights, wanted, what) {
  const { cells, of, most } = differences(heights, wanted);
  expect(cells === 0, what + (cells ? ` (${cells} of ${of} differ, by ${most} m at most)` : ""));
}

// Whether a device comes as near to the processor as devices do.
function near(heights, wanted, what) {
  const { cells, of, most, mean } = differences(heights, wanted);
  const isNear = heights.length === wanted.length && most < WORST && mean < MEAN;
  expect(isNear, `${what} (${cells} of ${of} differ, by ${most} m at most and ${mean} m on average)`);
}

// What the program makes of a recipe on the processor.
function native(text) {
  const out = mkdtempSync(join(tmpdir(), "weald-page-"));
  const recipe = join(out, "valley.toml");
  writeFileSync(recipe, text);
  execFileSync(weald, ["run", recipe, "--engine", "cpu", "--out", join(out, "out"), "--quiet"], { stdio: "inherit" });
  const file = readFileSync(join(out, "out", "height.npy"));
  rmSync(out, { recursive: true });
  return { file, heights: file.subarray(file.length - 4 * 96 * 96) };
}

const QUIET = ["--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const DEVICE = ["--enable-unsafe-webgpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--use-angle=swiftshader", "--use-webgpu-adapter=swiftshader"];

// A busy machine takes its time to start a browser, and to answer.
const SLOWLY = { timeout: 240_000, protocolTimeout: 900_000 };

const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";

function launched(kind, downloads) {
  if (kind === "firefox") return firefox(downloads);
  const drawing = kind === "device" ? DEVICE : ["--enable-unsafe-swiftshader"];
  return puppeteer.launch({
    ...SLOWLY,
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    ignoreDefaultArgs: ["--disable-gpu"],
    args: ["--no-sandbox", ...QUIET, ...drawing],
  });
}

// Without a window Firefox has no WebGL: it gets a display server without a screen.
async function firefox(downloads) {
  const server = spawn("Xvfb", ["-displayfd", "3", "-screen", "0", "1400x1000x24"], { stdio: ["ignore", "ignore", "ignore", "pipe"] });
  const [display] = await Promise.race([once(server.stdio[3], "data"), once(server, "error").then(([cause]) => Promise.reject(cause))]);
  const browser = await puppeteer.launch({
    ...SLOWLY,
    browser: "firefox",
    executablePath: FIREFOX,
    headless: false,
    env: { ...process.env, DISPLAY: `:${display.toString().trim()}` },
    extraPrefsFirefox: { "browser.download.folderList": 2, "browser.download.dir": downloads, "browser.download.alwaysOpenPanel": false },
  });
  browser.once("disconnected", () => server.kill());
  return browser;
}

// A new page: `query` is what the address asks for, `before` runs in the page before all else.
async function visit(context, address, name, { query = "", before, size = [1280, 800] } = {}) {
  const page = await context.newPage();
  // Another page that draws by software leaves this one little.
  page.setDefaultNavigationTimeout(240_000);
  await page.setViewport({ width: size[0], height: size[1] });
  if (before) await page.evaluateOnNewDocument(before);
  const visitor = new Visitor(page, name);
  await page.goto(address.replace(/\/(#|$)/, `/${query}$1`));
  return visitor;
}

// A small window, whose panels are those of a large one.
const SMALL = [1000, 560];

// What the address of a tour asks for.
const QUERIES = { device: "?device&processor" };

async function tour(kind, address, wanted) {
  console.log(`\n${kind}`);
  const downloads = mkdtempSync(join(tmpdir(), "weald-downloads-"));
  const browser = await launched(kind, downloads);
  try {
    const began = Date.now();
    const visitor = await visit(browser, address, kind, { query: QUERIES[kind] });
    await until("a first picture of the page", () => visitor.page.$("#try"));
    const first = Date.now() - began;
    await visitor.is("a landscape that is drawn", (state) => state.shown && state.steps > 0, 240);
    const land = Date.now() - began;
    const device = await visitor.page.evaluate(() => window.weald.device);
    expect(device === (kind === "device"), `draws ${device ? "on a device" : "by rays"}`);
    await visitor.picture("landing");
    const running = await visitor.is("steps of the simulation", (state) => state.plays && state.steps > 20, 120);
    const cells = running.columns ** 2;
    console.log(`       page after ${first} ms, a landscape that is carved after ${land} ms, ${((running.pace * cells) / 1e6).toFixed(1)} million cell-steps a second`);
    await visitor.page.click("#try");
    await new Promise((resolve) => setTimeout(resolve, 900));
    await visitor.click("Play or pause");
    await visitor.is("a simulation that stands still", (state) => !state.plays && state.idle);
    await visitor.picture("valley");

    if (device) {
      await visitor.drop("grown.toml", GROWN);
      await visitor.is("ferns and grass", (state) => state.columns === 64 && state.idle && state.whole && state.drawn, 240);
      await visitor.picture("grown");
    }
    await visitor.drop("valley.toml", RECIPE);
    await visitor.is("the recipe that was dropped", (state) => state.columns === 96 && state.steps === 0 && state.idle);
    await visitor.click("Play to the end");
    await visitor.is("the end of the simulation", (state) => state.steps === 120 && state.idle && state.whole);
    const { engine } = await visitor.state();
    expect(/^the processor: ./.test(engine), `simulated by ${engine}`);
    same(await visitor.heights(), wanted.heights, "heights equal those of the program to the bit");
    await visitor.picture("carved");

    if (kind !== "firefox") {
      const session = await visitor.page.createCDPSession();
      await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });
    }
    await visitor.click("Export");
    // The button of the question has the name of that of the toolbar: it is the last.
    await until("the question", async () => (await visitor.places("Export")).length > 1);
    const places = await visitor.settledPlaces("Export");
    await visitor.picture("question");
    const lowest = places.reduce((one, other) => (other[1] > one[1] ? other : one));
    await visitor.page.mouse.click((lowest[0] + lowest[2]) / 2, (lowest[1] + lowest[3]) / 2, { delay: 80 });
    const archive = await until("the export", async () => {
      const { error } = await visitor.state();
      if (error) throw new Error(error);
      const names = readdirSync(downloads).filter((name) => name.endsWith(".zip"));
      return names.length && statSync(join(downloads, names[0])).size ? join(downloads, names[0]) : null;
    });
    expect(readFileSync(archive).includes(wanted.file), "the export holds the file that the program writes");

    const before = await visitor.state();
    await visitor.page.keyboard.press("v");
    await visitor.drag("Viewport", [0.45, 0.5], [0.6, 0.55]);
    const painted = await visitor.is("a stroke", (state) => state.moments > before.moments && state.idle && state.whole);
    await visitor.picture("painted");
    await visitor.undoTo(before.moments);
    same(await visitor.heights(), wanted.heights, "heights after undo are as before the stroke");
    await visitor.page.keyboard.press("b");
    await visitor.drag("Viewport", [0.4, 0.5], [0.5, 0.6]);
    await visitor.is("another stroke", (state) => state.moments > before.moments);
    await visitor.is("the whole stroke, which is kept", (state) => state.idle && state.whole && state.kept);
    await visitor.page.evaluate(() => window.weald.written());
    const mine = await visitor.heights();
    expect(!mine.equals(wanted.heights), "the brush has raised the ground");

    await visitor.page.reload();
    await visitor.is("what was not saved", (state) => state.columns === 96 && state.steps === 120 && state.idle && state.whole, 240);
    same(await visitor.heights(), mine, "after a reload everything is as it was");
    await visitor.picture("reloaded");

    await visitor.click("Share");
    await until("the link", () => visitor.page.url().includes("#land="));
    const link = visitor.page.url();
    const other = await visit(await browser.createBrowserContext(), link, `${kind}-shared`, { query: QUERIES[kind] });
    await other.is("what was shared", (state) => state.columns === 96 && state.steps === 120 && state.idle && state.whole, 240);
    same(await other.heights(), mine, `a link of ${link.length} letters shows the same in a fresh profile`);
    await other.picture("shared");
    await other.page.close();

    await documented(visitor);
    await faults(kind, browser, address, visitor);
  } finally {
    await browser.close();
    rmSync(downloads, { recursive: true });
  }
}

// Simulations on a device, beside which rays are marched in a small window: software draws all else on the page, and as long
// as it does the simulation waits.
async function simulated(address, wanted) {
  console.log("\nsimulated on a device");
  const browser = await launched("device");
  try {
    const visitor = await visit(browser, address, "simulated", { query: "?rays&device", size: SMALL });
    await carvedOnDevice(visitor, wanted);
    await paintedOnDevice(visitor);
    await lostDevice(visitor);
    await visitor.page.close();

    const both = await visit(await browser.createBrowserContext(), address, "drawn-and-simulated", { query: "?device", size: SMALL });
    await both.is("a landscape that is drawn", (state) => state.shown && state.drawn, 240);
    const { engine } = await both.is("steps beside pictures", (state) => state.steps > 0, 240);
    expect(/swiftshader/i.test(engine), `a device draws and simulates: ${engine}`);
    await both.page.close();
  } finally {
    await browser.close();
  }
  await withoutDevice(address);
}

async function carvedOnDevice(visitor, wanted) {
  await visitor.is("a landscape", (state) => state.shown, 240);
  await visitor.page.click("#try");
  await visitor.countPasses();
  for (const [name, text, heights] of [
    ["a flood", FLOOD, wanted.flood],
    ["a valley", VALLEY, wanted.valley],
  ]) {
    await visitor.drop("valley.toml", text);
    await visitor.is(`${name} before`, (state) => state.columns === 96 && state.steps === 0 && state.idle && state.text === text);
    const before = await visitor.passes();
    await visitor.click("Play to the end");
    const { engine } = await visitor.is(`${name} after`, (state) => state.steps === STEPS && state.idle && state.whole, 300);
    const passes = (await visitor.passes()) - before;
    expect(/swiftshader.*WebGPU/i.test(engine) && passes > STEPS, `${name} is simulated by ${engine} in ${passes} passes`);
    near(await visitor.heights(), heights, `${name} is near that of the program on its processor`);
  }
  await visitor.picture("carved");
}

// A stroke, another one while it runs, and all of it taken back.
async function paintedOnDevice(visitor) {
  const [carved, before] = [await visitor.heights(), await visitor.state()];
  await visitor.page.keyboard.press("b");
  await visitor.drag("Viewport", [0.45, 0.5], [0.6, 0.55]);
  const painted = await visitor.is("a stroke", (state) => state.moments > before.moments && state.idle && state.whole);
  const raised = await visitor.heights();
  expect(!raised.equals(carved), `a stroke raises the ground by ${differences(raised, carved).most} m`);

  await visitor.click("Play or pause");
  await visitor.is("steps after the stroke", (state) => state.plays && state.steps > STEPS + 5);
  await visitor.drag("Viewport", [0.4, 0.5], [0.5, 0.6]);
  const { steps } = await visitor.is("a stroke while it runs", (state) => state.plays && state.moments > painted.moments + 1);
  await visitor.is("steps after that", (state) => state.plays && state.steps > steps + 5);
  await visitor.click("Play or pause");
  const { moments } = await visitor.is("a simulation that stands still", (state) => !state.plays && state.idle && state.whole);
  expect(moments > painted.moments + 1, `a stroke while it runs, after ${steps} steps`);
  await visitor.picture("painted");

  await visitor.undoTo(painted.moments);
  same(await visitor.heights(), raised, "heights are those after the first stroke when all later is undone");
  await visitor.undoTo(before.moments);
  same(await visitor.heights(), carved, "heights are those before it when that is undone");
}

async function lostDevice(visitor) {
  await visitor.is("what is kept", (state) => state.idle && state.whole && state.kept);
  await visitor.page.evaluate(() => window.weald.written());
  await visitor.click("Play or pause");
  await visitor.is("a simulation that runs", (state) => state.plays);
  await visitor.loseSimulation();
  const { error, steps } = await visitor.is("a device that is lost", (state) => state.error);
  expect(/lost.*load the page again.*kept/.test(error), `a device that is lost while it simulates: "${error}"`);
  await visitor.page.reload();
  const again = await visitor.is("what was kept", (state) => state.columns === 96 && state.idle && state.whole, 240);
  expect(again.steps >= STEPS && again.steps <= steps, `${again.steps} of ${steps} steps are there when the page is loaded again`);
}

// Who asks for a device where none can be had is told so, and simulates on the processor.
async function withoutDevice(address) {
  const browser = await launched("rays");
  const unable = () => delete Navigator.prototype.gpu;
  try {
    const visitor = await visit(browser, address, "demanded", { query: "?rays&device", before: unable });
    const notice = await visitor.notice();
    const { engine } = await visitor.is("a landscape on the processor", (state) => state.shown && state.engine, 240);
    expect(/on the processor.*WebGPU/.test(notice) && /^the processor: .*WebGPU/.test(engine), `no device that is demanded: "${notice}"`);
  } finally {
    await browser.close();
  }
}

// Scripts of the documentation do what they say; files that arrive come one after the other.
async function documented(visitor) {
  const text = readFileSync(new URL("../../../docs/browser.md", import.meta.url), "utf8");
  const scripts = [...text.matchAll(/```js\n([\s\S]*?)```/g)].map((found) => found[1]);
  expect(scripts.length === 2, "the documentation has two scripts");
  for (const script of scripts) await visitor.page.evaluate(`(async () => { ${script} })()`);
  await visitor.is("the recipe of the documentation", (state) => state.columns === 64 && state.idle && state.whole);
}

async function faults(kind, browser, address, visitor) {
  const told = async (what, words) => {
    const { message } = await visitor.is(what, (state) => words.every((word) => state.message?.includes(word)));
    expect(true, `${what}: "${message}"`);
  };
  await visitor.drop("letter.txt", "Dear Weald,");
  await told("a letter that was dropped", ["no recipe", ".tif"]);
  await visitor.drop("earth.tif", "II*", 1e9);
  await told("a file of 1 GB", ["1000 MB", "open it in the program"]);
  await visitor.drop("broken.tif", "II*\0 no picture");
  const { error } = await visitor.is("a broken GeoTIFF", (state) => state.error);
  expect(/broken\.tif/.test(error), `a broken GeoTIFF: "${error}"`);

  const noStore = () => Object.defineProperty(window, "indexedDB", { value: undefined });
  const forgetful = await visit(await browser.createBrowserContext(), address, `${kind}-no-store`, { query: QUERIES[kind], before: noStore });
  const notice = await forgetful.notice();
  await forgetful.is("a landscape without a store", (state) => state.shown, 240);
  expect(notice.includes("keeps nothing"), `without storage: "${notice}"`);
  await forgetful.page.close();

  const cut = await visit(await browser.createBrowserContext(), `${address}#land=abc`, `${kind}-cut-link`, { query: QUERIES[kind] });
  const sentence = await cut.notice();
  await cut.is("a landscape in its place", (state) => state.shown, 240);
  expect(sentence.includes("cut or damaged"), `a link that is cut: "${sentence}"`);
  await cut.page.close();

  if (kind === "device") {
    await visitor.page.evaluate(() => window.weald.loseDevice());
    const lost = await visitor.notice();
    expect(/load the page again/.test(lost), `a device that is lost: "${lost}"`);
  }
}

const { server, address } = await served();
const wanted = { ...native(RECIPE), flood: native(FLOOD).heights, valley: native(VALLEY).heights };
try {
  const kinds = ["simulated", "device", "rays"];
  if (existsSync(FIREFOX)) kinds.push("firefox");
  else console.log(`Firefox is left out: there is no ${FIREFOX}`);
  for (const kind of only ? [only] : kinds) {
    if (kind === "simulated") await simulated(address, wanted);
    else await tour(kind, address, wanted);
  }
} catch (cause) {
  expect(false, cause.message);
} finally {
  server.removeAllListeners("exit");
  server.kill();
}
console.log(failures.length ? `\n${failures.length} failed` : "\nthe page is as it should be");
process.exit(failures.length ? 1 : 0);
