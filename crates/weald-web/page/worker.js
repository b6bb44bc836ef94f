// The worker: runs recipes and simulations, in turns between which messages of the page come in.
import init, { Server } from "./weald_web.js";
import { begin, canWait, waiting } from "./waiting.js";

let server = null;
// Works for a turn, and gives how long there is nothing to do, or a promise of it.
let work = null;
let isWorking = false;
let timer = null;
// What has come while nobody could take it.
const waits = [];
// A message to oneself comes sooner than the four milliseconds of a timer.
const again = new MessageChannel();
again.port1.onmessage = turn;
self.weald = waiting;

function schedule(rest) {
  clearTimeout(timer);
  timer = null;
  if (rest === 0) again.port2.postMessage(null);
  else if (rest > 0) timer = setTimeout(turn, rest);
}

// A turn that waits for a device leaves the program in the middle of its work: nobody may call it before it is done.
async function turn() {
  timer = null;
  if (isWorking || server.rest() < 0) return;
  isWorking = true;
  try {
    const rest = await work();
    isWorking = false;
    if (waits.length) waits.splice(0).forEach(take);
    else schedule(rest);
  } catch (cause) {
    // The page hears of what fails outside of promises.
    setTimeout(() => {
      throw cause;
    });
  }
}

function take({ text, arrays }) {
  server.take(text, arrays);
  schedule(server.rest());
}

// Where simulations run: on the device that the page may use, where the program can wait for one, or on the processor.
async function begun(exports, { name, isDemanded, why }) {
  try {
    if (!name) throw new Error(why);
    if (!canWait) throw new Error("this browser cannot wait for a device; Chrome and Edge of 2025 and Firefox of 2026 or later can");
    server = await Server.onDevice(name, isDemanded);
    const promising = WebAssembly.promising(exports.server_turn);
    work = () => promising(server.__wbg_ptr);
  } catch (cause) {
    const why = cause?.message ?? String(cause);
    if (isDemanded) postMessage({ refused: why });
    server = Server.onProcessor(why);
    work = () => server.turn();
  }
}

onmessage = async ({ data }) => {
  if (data.module) {
    await begun(await begin(init, data.module), data.device);
    waits.splice(0).forEach(take);
  } else if (server && !isWorking) take(data);
  else waits.push(data);
};
