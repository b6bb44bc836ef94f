// Begins the studio: what the browser can do, what it has kept, the worker, the canvas.
import init, { Page, restore, all_changed } from "./weald_web.js";
import { LONGEST, landOf, linkOf } from "./links.js";
import { Store } from "./store.js";

// Longest file that is taken: it is held by the page and by its worker, which have 4 GB each.
const LONGEST_FILE = 512 * 2 ** 20;
const SHARED = "/home/shared";

const began = performance.now();
const asked = new URLSearchParams(location.search);
const notices = document.getElementById("notices");
const veil = document.getElementById("veil");
let page = null;

function notice(sentence) {
  const line = document.createElement("p");
  line.textContent = sentence;
  line.onclick = () => line.remove();
  notices.append(line);
}

function save(name, bytes) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

async function arrive(file) {
  if (file.size > LONGEST_FILE) {
    const megabytes = Math.round(file.size / 1e6);
    page.tell(
      `${file.name} has ${megabytes} MB; a page takes ${Math.round(LONGEST_FILE / 1e6)} MB: cut it, or open it in the program`,
    );
    return;
  }
  page.arrive(file.name, new Uint8Array(await file.arrayBuffer()));
}

function choose() {
  const input = document.createElement("input");
  input.type = "file";
  input.onchange = () => input.files[0] && arrive(input.files[0]);
  input.click();
}

async function share(recipe, script) {
  const link = await linkOf(recipe, script);
  if (link.length > LONGEST) {
    save("landscape.toml", recipe);
    if (script) save("landscape.edits.jsonl", script);
    page.tell("what was done is too long for a link: it is in two files that can be sent and dropped on the page");
    return;
  }
  history.replaceState(null, "", link);
  const copied = await navigator.clipboard?.writeText(link).then(
    () => true,
    () => false,
  );
  page.tell(copied ? "the link is copied, and in the address bar" : "the link is in the address bar");
}

// A device that can be asked for, or why there is none. Software that acts as one is used where the address says
// `?device`: to march rays and to simulate on the processor is sooner done.
async function device() {
  if (asked.has("rays") && !asked.has("device")) return { why: "the address says ?rays" };
  if (!navigator.gpu) return { why: "this browser has no WebGPU; Chrome, Edge, Firefox and Safari of 2025 or later have it" };
  try {
    const adapter = await navigator.gpu.requestAdapter();
    if (!adapter) return { why: "the browser finds no graphics device that it can use" };
    if (adapter.info?.isFallbackAdapter && !asked.has("device")) {
      return { why: "the only graphics device is software; ?device in the address uses it all the same" };
    }
    return { adapter };
  } catch (cause) {
    return { why: `the browser gives no graphics device: ${cause?.message ?? cause}` };
  }
}

// Where the worker simulates: on that device, unless the address says otherwise.
function simulating({ adapter, why }) {
  if (asked.has("processor")) return { why: "the address says ?processor" };
  return { name: adapter && nameOf(adapter), why, isDemanded: asked.has("device") };
}

// Browsers tell scripts more of an adapter than they tell the program.
function nameOf({ info }) {
  const parts = [info?.vendor, info?.architecture, info?.device, info?.description];
  return `${parts.filter(Boolean).join(" ") || "a graphics device"} (WebGPU)`;
}

function tellWithoutDevice(why) {
  notice(`Simulations run on the processor, and not on the device that the address asks for: ${why}.`);
}

// A device can be lost at any time: then nothing on the canvas can say so.
function watchDevices() {
  const request = GPUAdapter.prototype.requestDevice;
  GPUAdapter.prototype.requestDevice = async function (...how) {
    const made = await request.apply(this, how);
    window.weald.loseDevice = () => made.destroy();
    made.lost.then(({ message }) => {
      const rays = new URL(location.href);
      rays.searchParams.set("rays", "");
      rays.searchParams.delete("device");
      rays.hash = "";
      notice(
        `The graphics device was lost${message ? ` (${message})` : ""}. What you did is kept: load the page again, or go on without it: ${rays.href}`,
      );
    });
    return made;
  };
}

async function shared() {
  try {
    return await landOf(location.hash);
  } catch (cause) {
    notice(`The link is cut or damaged (${cause.message}): ask for it again. Here is another landscape.`);
    return null;
  }
}

async function open() {
  const compiled = fetch("weald_web_bg.wasm").then(async (answer) => {
    if (!answer.ok) throw new Error(`weald_web_bg.wasm: ${answer.status}`);
    return WebAssembly.compile(await answer.arrayBuffer());
  });
  const [module, found, store, land] = await Promise.all([compiled, device(), Store.open(notice), shared()]);
  const worker = new Worker("worker.js", { type: "module" });
  worker.addEventListener("message", ({ data }) => data.refused && tellWithoutDevice(data.refused));
  worker.postMessage({ module, device: simulating(found) });
  await init({ module_or_path: module });
  window.weald = { keep: (path, bytes) => store.keep(path, bytes), written: () => store.written(), choose, handOut: save, share, arrive };
  const draws = Boolean(found.adapter) && !asked.has("rays");
  if (draws) watchDevices();
  const kept = await store.all();
  for (const [path, bytes] of kept) restore(path, bytes);
  let what = asked.get("open") ?? undefined;
  if (land) {
    const text = new TextEncoder();
    restore(`${SHARED}/landscape.toml`, text.encode(land.recipe));
    if (land.script) restore(`${SHARED}/landscape.edits.jsonl`, text.encode(land.script));
    what = `${SHARED}/landscape.toml`;
  }
  all_changed();
  const isNew = kept.length === 0 && !what;
  if (!isNew) unveil();
  page = await Page.open(document.getElementById("land"), worker, draws, what, isNew);
  worker.onerror = (event) =>
    page.fail(`The simulation has ended by a fault of Weald (${event.message}); load the page again: what you did is kept.`);
  Object.assign(window.weald, { page, milliseconds: { ready: performance.now() - began }, device: draws });
  document.body.classList.add("ready");
}

function unveil() {
  veil.classList.add("away");
}

for (const kind of ["dragover", "drop"]) {
  addEventListener(
    kind,
    (event) => {
      event.preventDefault();
      event.stopPropagation();
      if (kind === "drop" && page && event.dataTransfer.files[0]) arrive(event.dataTransfer.files[0]);
    },
    true,
  );
}
document.getElementById("try").onclick = () => {
  unveil();
  page?.begin();
};
open().catch((cause) => {
  unveil();
  notice(`This browser cannot show Weald (${cause?.message ?? cause}). It needs WebAssembly with SIMD and WebGPU or WebGL 2: a Chrome, Edge, Firefox or Safari of 2023 or later has them.`);
});
